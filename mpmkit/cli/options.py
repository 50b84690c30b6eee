"""Options with the same meaning in all commands that run something."""

from __future__ import annotations

import os

import click

from .paths import PATH

case_file = click.argument("case", type=PATH)
set_values = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="PATH=VALUE",
    help="Change one value of the case, such as scheme.order=usf or bodies.0.material.yield_stress=50.",
)
until = click.option("--until", type=float, metavar="T", help="Simulated time, s; default: that of the case.")
threads = click.option(
    "--threads",
    type=click.IntRange(min=1),
    metavar="N",
    help="Threads to use; default: as many as make the run faster.",
)
quiet = click.option("--quiet", is_flag=True, help="Print only errors.")
overwrite = click.option("--overwrite", is_flag=True, help="Replace an earlier run in the run directory.")
overwrite_file = click.option("--overwrite", is_flag=True, help="Replace the file if it exists.")
out = click.option("--out", type=PATH, metavar="DIR", help="Run directory; default: runs/<case name>.")
no_plugins = click.Option(
    ["--no-plugins"],
    is_flag=True,
    expose_value=False,
    callback=lambda context, option, asked: _leave_out_plugins() if asked else None,
    help="Load only the built-in plug-ins; MPMKIT_PLUGINS=NAME,… loads those of named distributions too.",
)
as_json = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


def _leave_out_plugins() -> None:
    """Leave out plug-ins in this process and its child processes, by an environment variable."""
    os.environ["MPMKIT_PLUGINS"] = ""


def with_until(overrides: tuple[str, ...], until: float | None) -> tuple[str, ...]:
    """The overrides, followed by that of the option ``--until``."""
    return overrides if until is None else (*overrides, f"until={until!r}")
