"""``mpmkit init``."""

from __future__ import annotations

from pathlib import Path

import click

from . import options
from .command import with_examples
from .paths import PATH
from .printing import echo


@with_examples(
    "init",
    "mpmkit init vane --set yield_stress=50",
    "mpmkit run vane.json --until 0.02",
    "mpmkit init slump_test --fine --out my_slump.json",
)
@click.argument("name")
@click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="NAME=VALUE",
    help="New value of a parameter, such as yield_stress=50, or of any key of the case.",
)
@click.option("--fine", is_flag=True, help="Write the fine variant, which takes longer.")
@click.option("--out", type=PATH, metavar="FILE", help="The file to write; default: NAME.json.")
@options.overwrite_file
def command(name: str, overrides: tuple[str, ...], fine: bool, out: str | None, overwrite: bool) -> None:
    """Write the shipped case NAME, with its parameters at the top, to your own file."""
    from ..case import parse_case
    from ..case.load import name_from, read_json
    from ..case.overrides import apply_overrides
    from ..case.parameters import BLOCK, has_fine, parameters
    from ..case.parameters import fine as fine_variant
    from ..case.shipped import shipped_case
    from ..case.writing import case_text
    from ..errors import CaseError, OutputError
    from ..output.atomic import replacing

    data = read_json(shipped_case(name))
    if fine and not has_fine(data):
        raise CaseError(f"the case '{name}' has no fine variant; leave out --fine")
    if fine:
        data = fine_variant(data)
    data = apply_overrides(data, [_of_parameter(override, data.get(BLOCK, {})) for override in overrides])
    path = Path(out) if out is not None else Path(f"{name}.json")
    parse_case({"name": name_from(path)} | data, source=f"init {name}")
    if path.exists() and not overwrite:
        raise OutputError(f"{path} exists; give another file with --out, or --overwrite")
    with replacing(path) as partial:
        partial.write_text(case_text(data), encoding="utf-8")
    for parameter, entry in parameters(data).items():
        if entry.given:
            unit = "" if entry.unit == "1" else f" {entry.unit}"
            echo(f"{parameter:<22} {f'{entry.value:g}{unit}':<14} {entry.description}")
    echo(f"written to {path}; to run it: mpmkit run {path}")


def _of_parameter(override: str, block: dict) -> str:
    """``yield_stress=50`` as ``parameters.yield_stress=50``, if there is such a parameter.

    Raises:
        CaseError: it is neither a parameter nor a place of a case.
    """
    from ..case import Case
    from ..case.synonyms import nearest
    from ..errors import CaseError

    path, sign, value = override.partition("=")
    if path in block:
        return f"parameters.{path}{sign}{value}"
    if "." not in path and path not in Case.model_fields:
        near = nearest(path, list(block))
        hint = f"did you mean '{near}'?" if near else f"the parameters are {', '.join(block)}"
        raise CaseError(f"--set {override}: the case has no parameter '{path}'; {hint}")
    return override
