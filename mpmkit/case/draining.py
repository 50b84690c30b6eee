"""The columns that the sinks of a case add to its history."""

from __future__ import annotations

from ..output.variables import Variable
from .model import Case


def drain_columns(case: Case) -> list[Variable]:
    """Mass removed by all sinks, and mass and rate of each sink."""
    if not case.sinks:
        return []
    of_sinks = {"dimension": "sink", "labels": tuple(case.sinks)}
    return [
        Variable("mass_out", "kg", "mass that has left through all sinks"),
        Variable("sink_mass", "kg", "mass that has left through the sink", **of_sinks),  # type: ignore[arg-type]
        Variable("sink_rate", "kg/s", "rate at which mass leaves", **of_sinks),  # type: ignore[arg-type]
    ]
