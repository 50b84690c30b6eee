"""The summary of a run: the few numbers that the run was made for."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    import xarray

T500_DIAMETER = 0.5
"""Spread diameter, m, at which T500 is taken."""


def first_crossing(time: ArrayLike, values: ArrayLike, level: float) -> float | None:
    """Time at which ``values`` first rise to ``level``, linear between rows; None if they never do.

    Values that start at the level or above have not risen to it: a body that is wide from the start has
    no T500, rather than one of zero.
    """
    times, levels = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    rises = np.flatnonzero((levels[:-1] < level) & (levels[1:] >= level))
    if not len(rises):
        return None
    before, after = rises[0], rises[0] + 1
    part = (level - levels[before]) / (levels[after] - levels[before])
    return float(times[before] + part * (times[after] - times[before]))


def summarise(
    history: xarray.Dataset,
    *,
    particles: int,
    particle_steps: int,
    steps: int,
    wall_time: float,
    stopped_because: str,
    plugins: Any,
) -> dict[str, Any]:
    """The content of ``summary.json``; what never happened, or was not recorded, is None.

    Args:
        history: dataset of a ``History``.
        particles: number of particles at the end.
        particle_steps: sum of their number over all steps.
        steps: number of steps done.
        wall_time: s.
        stopped_because: why the run ended.
        plugins: the plug-ins and their versions.
    """
    t500 = None
    if "spread_diameter" in history:
        t500 = first_crossing(history["time"].values, history["spread_diameter"].values, T500_DIAMETER)
    return {
        "t500": t500,
        "final_spread": _last(history, "spread_diameter"),
        "final_slump": _last(history, "slump"),
        "final_height": _last(history, "height"),
        "simulated_time": _last(history, "time"),
        "particles": particles,
        "steps": steps,
        "wall_time": wall_time,
        "particle_steps_per_second": particle_steps / wall_time if wall_time > 0 else None,
        "stopped_because": stopped_because,
        "plugins": plugins,
    }


def _last(history: xarray.Dataset, name: str) -> float | None:
    if name not in history.variables or not history.sizes["time"]:
        return None
    value = float(history[name].values[-1])
    return value if math.isfinite(value) else None
