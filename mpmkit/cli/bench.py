"""``mpmkit bench``."""

from __future__ import annotations

import click

from . import options
from .command import with_examples
from .printing import echo, echo_json

SECONDS = 5.0
"""For how long a scene is timed by default."""


@with_examples("bench", "mpmkit bench small-axisymmetric --seconds 1")
@click.argument("scenes", nargs=-1, metavar="[SCENE]...")
@options.threads
@click.option(
    "--seconds",
    type=click.FloatRange(min=0, min_open=True),
    default=SECONDS,
    show_default=True,
    help="Wall time for which each scene is timed, s.",
)
@options.as_json
def command(scenes: tuple[str, ...], threads: int | None, seconds: float, as_json: bool) -> None:
    """Measure the time of full steps in the standard scenes, kernel by kernel; default: all scenes."""
    from ..bench import SCENES, time_scene
    from ..errors import CaseError

    for name in scenes:
        if name not in SCENES:
            raise CaseError(f"scene is '{name}'; it must be one of {', '.join(SCENES)}")
    timings = []
    for name in scenes or SCENES:
        timing = time_scene(SCENES[name], threads, seconds)
        timings.append(timing.as_dict())
        if not as_json:
            echo(_table(SCENES[name].description, timings[-1]))
    if as_json:
        echo_json(timings)


def _table(description: str, timing: dict) -> str:
    total = sum(timing["kernels"].values())
    lines = [
        f"{timing['scene']}: {description}",
        f"  {timing['particles']:,} particles, threads: {timing['threads']}",
        f"  {timing['particle_steps_per_second'] / 1e6:.2f} million particle-steps/s",
        *(
            f"  {name:<20}{spent:8.1f} ns{100 * spent / total:6.0f} %"
            for name, spent in timing["kernels"].items()
        ),
    ]
    return "\n".join(lines)
