"""``mpmkit stability``."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from . import options
from .command import with_examples
from .paths import PATH, refuse_existing
from .printing import echo, echo_json

if TYPE_CHECKING:
    from ..stability.trial import Trace

SAID_EVERY = 10.0
"""Seconds between two lines about the trials of one combination."""


def _names(kind: str):
    return click.option(
        f"--{kind}",
        metavar="A,B,…",
        help=f"Names of the plug-ins of kind {kind} to try; default: the case's own.",
    )


@with_examples("stability", "mpmkit stability cases/vibrating_bar.json --order usl,usf --until 10")
@options.case_file
@_names("shape")
@_names("order")
@_names("velocity")
@_names("volumetric")
@_names("law")
@options.set_values
@options.until
@click.option(
    "--out", type=PATH, metavar="DIR", help="Directory of the map; default: runs/stability-<case name>."
)
@click.option("--overwrite", is_flag=True, help="Replace an earlier map there.")
@options.as_json
def command(
    case: str,
    shape: str | None,
    order: str | None,
    velocity: str | None,
    volumetric: str | None,
    law: str | None,
    overrides: tuple[str, ...],
    until: float | None,
    out: str | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Find the largest stable time step of CASE for every combination of the schemes named.

    A step is stable if it creates no energy and no momentum, and the particles stay close to a fine solution.
    """
    from dataclasses import asdict

    from ..case.load import read_case
    from ..case.overrides import apply_overrides
    from ..stability import combinations, critical_fraction
    from ..stability.figure import draw, picture_in
    from ..stability.page import write_page
    from ..stability.trials import Trials
    from .display import say

    data = apply_overrides(read_case(case), options.with_until(overrides, until))
    given = {"shape": shape, "order": order, "velocity": velocity, "volumetric": volumetric, "law": law}
    directory = Path(out) if out is not None else Path("runs") / f"stability-{data['name']}"
    refuse_existing(picture_in(directory), overwrite)  # before the search, which may take hours
    if isinstance(data.get("until"), dict):
        say("until has conditions: every combination is tried to until.at_most")
    chosen = {kind: names.split(",") for kind, names in given.items() if names}
    rows: list[dict] = []
    trials: list[Trials] = []
    for labels, combination in list(combinations(data, chosen)):
        kept = _Kept(", ".join(labels.values()) or str(data["name"]))
        found = critical_fraction(combination, keep=kept)
        trials.append(Trials.of(found, kept.traces))
        rows.append(labels | asdict(found))
        if not as_json:
            say(f"{kept.label}: {_stable(rows[-1])}")
    if as_json:
        finite = [{k: None if v == math.inf else v for k, v in row.items()} for row in rows]
        echo_json(finite)
    else:
        echo(_table(list(chosen), rows))
    path = draw(rows, list(chosen), str(data["name"]), directory)
    page = write_page(rows, list(chosen), str(data["name"]), directory, trials)
    if not as_json:
        echo(f"map in {path} and {page}")


class _Kept:
    """The traces of the trials of one combination, by their fractions; long searches report them."""

    def __init__(self, label: str) -> None:
        self.label = label
        self.traces: dict[float, Trace] = {}
        self._said = time.monotonic()

    def __call__(self, fraction: float, trace: Trace) -> None:
        from .display import say

        self.traces[fraction] = trace
        if time.monotonic() - self._said >= SAID_EVERY:
            self._said = time.monotonic()
            say(f"{self.label}: trial {len(self.traces)}, at {fraction:.3g} of the limit, has ended")


def _stable(row: dict) -> str:
    if row["unstable"] == math.inf:
        return f"stable up to {row['fraction']:.3g} of the {row['limit']} limit, the largest tried"
    if not row["fraction"]:
        return f"unstable at {row['unstable']:.3g} of the {row['limit']} limit, the smallest tried"
    return f"stable up to {row['fraction']:.3g} of the {row['limit']} limit; beyond: {row['broken']}"


def _table(kinds: list[str], rows: list[dict]) -> str:
    headings = [
        *kinds,
        "limit",
        "largest stable fraction",
        "smallest unstable",
        "what breaks",
        "schemes take at most",
    ]
    lines = [f"| {' | '.join(headings)} |", f"|{'---|' * len(headings)}"]
    for row in rows:
        beyond = "–" if row["unstable"] == math.inf else f"{row['unstable']:.3g}"
        cells = [
            *(row[kind] for kind in kinds),
            row["limit"],
            f"{row['fraction']:.3g}",
            beyond,
            row["broken"] or "–",
            f"{row['declared']:g}",
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)
