"""``mpmkit plan``."""

from __future__ import annotations

import shlex

from . import options
from .command import with_examples
from .duration import duration
from .printing import echo, echo_json

MOST_COUNTED = 10**15
"""Larger numbers are shown with an exponent."""


@with_examples(
    "plan",
    "mpmkit plan cases/slump_fast.json",
    "mpmkit plan cases/slump.json --set grid.cell_size=0.01 --json",
)
@options.case_file
@options.set_values
@options.until
@options.threads
@options.as_json
def command(
    case: str, overrides: tuple[str, ...], until: float | None, threads: int | None, as_json: bool
) -> None:
    """Compute what a run of CASE will cost: particles, nodes, steps, memory and time."""
    from ..case import load_case

    loaded = load_case(case, options.with_until(overrides, until))

    from ..plan import plan

    cost = plan(loaded, threads)
    if as_json:
        echo_json(cost)
        return
    speeds = [speed for speed in cost["sound_speed"] if speed is not None]
    lines = [
        f"particles      {cost['particles']:,}{_at_end(cost)}",
        f"nodes          {' × '.join(f'{n:,}' for n in cost['nodes'])}",
        f"time step      {cost['time_step']:.4g} s, set by the {cost['limited_by']} limit",
        *(f"  {name:<12} {limit:.4g} s" for name, limit in cost["limits"].items() if limit is not None),
        *(f"sound speed    {speed:.4g} m/s" for speed in speeds),
        f"steps          {_counted(cost['steps'])}",
        f"memory         {_mebibytes(cost['memory_bytes'])}, "
        f"and {_mebibytes(cost['checkpoint_bytes'])} more while a checkpoint is written",
        f"expected time  {duration(max(1.0, cost['expected_seconds']))} on this machine",
        *cost["remarks"],
        *(f"warning: {sentence}" for sentence in cost["warnings"]),
    ]
    asked = [f"--set {shlex.quote(override)}" for override in overrides]
    asked += [] if until is None else [f"--until {until!r}"]
    echo("\n".join([*lines, *_advice(" ".join([shlex.quote(case), *asked]), cost)]))


def _advice(asked: str, cost: dict) -> list[str]:
    """A table of the case and of cheaper models, and the commands that run them.

    ``asked`` is the case with its options; the options of a model follow them, so that they take precedence.
    """
    if not cost["cheaper"]:
        return []
    models = [{"name": "this case"} | cost, *cost["cheaper"]]
    width = max(len(model["name"]) for model in models)
    lines = ["", f"{'model':{width}}  {'particles':>10}  {'steps':>10}  {'time':>8}  error of the spread*"]
    for model in models:
        error = model["expected_error"]
        lines.append(
            f"{model['name']:{width}}  {model['particles']:>10,}  {_counted(model['steps']):>10}  "
            f"{duration(max(1.0, model['expected_seconds'])):>8}  "
            f"{'not known' if error is None else f'{100 * error:.2g} %'}"
        )
    lines += [
        "* in the first 1.5 s; known only for cases like the slump test of the shipped study",
        "",
    ]
    for model in cost["cheaper"]:
        options = " ".join(f"--set {shlex.quote(option)}" for option in model["options"])
        lines += [f"{model['name']}: {model['why']}", f"    mpmkit run {asked} {options}"]
    return lines


def _at_end(cost: dict) -> str:
    more = cost["particles_at_end"]
    return f", about {more:,} at the end" if more > cost["particles"] else ""


def _mebibytes(size: int) -> str:
    return f"{max(1, round(size / 2**20)):,} MiB"


def _counted(number: int) -> str:
    return f"{number:,}" if number < MOST_COUNTED else f"{number:.3g}"
