"""Running a simulation to a time, exactly."""

from __future__ import annotations

from collections.abc import Iterator

import mpmkit


def advance_to(simulation: mpmkit.Simulation, time: float) -> None:
    """Step until this time, the last step shortened to meet it."""
    while simulation.time < time * (1 - 1e-12):
        simulation.advance(at_most=time - simulation.time)


def at(simulation: mpmkit.Simulation, times) -> Iterator[float]:
    """Stop at each of these times in turn."""
    for time in times:
        advance_to(simulation, time)
        yield float(time)
