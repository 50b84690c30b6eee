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
TRUSTED = ("finished", "interrupted", "output-error")
"""Why a run may have ended without its last state being in doubt; any other reason is that of a guard."""


def trusted_to_the_end(stopped_because: str | None) -> bool:
    """Whether the last state of a run is one that the run arrived at, and not one that a guard refused."""
    return stopped_because in TRUSTED


def trusted_rows(history: xarray.Dataset, stopped_because: str | None) -> xarray.Dataset:
    """The rows of a history that can be believed: after a guard's stop, all but the last."""
    if trusted_to_the_end(stopped_because):
        return history
    return history.isel(time=slice(None, -1))


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

    A run that a guard stopped never came to its final shape, and the row of its stop may be that of a
    particle thrown out: it has no final lengths, and a T500 only from the rows before.

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
        rows = trusted_rows(history, stopped_because)
        t500 = first_crossing(rows["time"].values, rows["spread_diameter"].values, T500_DIAMETER)
    arrived = trusted_to_the_end(stopped_because)
    return {
        "t500": t500,
        "final_spread": _last(history, "spread_diameter") if arrived else None,
        "final_slump": _last(history, "slump") if arrived else None,
        "final_height": _last(history, "height") if arrived else None,
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
