"""Small histories of two-dimensional scenes."""

from __future__ import annotations

import numpy as np

from mpmkit.output import PARTICLE_VARIABLES, History, Variable

COLUMNS = [
    Variable("spread_diameter", "m", "spread diameter"),
    Variable("time_step", "s", "time step"),
    Variable("momentum", "kg m/s", "momentum", component=True),
]


def row(spread: float = 0.2) -> dict:
    return {"spread_diameter": spread, "time_step": 1e-5, "momentum": np.array([1.0, -2.0])}


def particle_fields(rng, count: int = 4, dim: int = 2) -> dict:
    shapes = {"position": (count, dim), "velocity": (count, dim), "stress": (count, 6)}
    return {name: rng.normal(size=shapes.get(name, (count,))) for name in PARTICLE_VARIABLES}


def small_history(spreads=(0.2, 0.3, 0.6)) -> History:
    history = History(COLUMNS, {"case": "{}"}, ("x", "z"))
    for index, spread in enumerate(spreads):
        history.record(0.1 * index, row(spread))
    return history
