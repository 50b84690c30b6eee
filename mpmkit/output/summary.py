"""The summary of a run: its main results."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray

T500_DIAMETER = 0.5
"""Spread diameter, m, at which T500 is taken."""
PASSED = ("mass_in", "mass_out")
"""Variables of a history with sources or sinks whose last values are in the summary."""
LEAST_RATE = 1e-5
"""m/s; slower growth does not count as spreading, even if the material moves."""
UNITS = {
    "t500": "s",
    "t500_from_lift": "s",
    "final_spread": "m",
    "final_slump": "m",
    "final_height": "m",
    "final_spread_rate": "m/s",
    "at_rest_since": "s",
    "simulated_time": "s",
    "particles": "1",
    "steps": "1",
    "wall_time": "s",
    "particle_steps_per_second": "1/s",
}
"""Units of the numbers of a summary."""
FINISHED, AT_REST, CONDITION = "finished", "at-rest", "condition"
ENDED = (FINISHED, AT_REST, CONDITION)
"""Reasons for a regular end: its time is over, the material is at rest, or a variable reached its bound."""
TRUSTED = (*ENDED, "interrupted", "output-error")
"""Reasons for an end with a valid last state; any other reason is the name of a guard."""


def trusted_to_the_end(stopped_because: str | None) -> bool:
    """Whether the last state of a run is valid, i.e. not refused by a guard."""
    return stopped_because in TRUSTED


def trusted_rows(history: xarray.Dataset, stopped_because: str | None) -> xarray.Dataset:
    """The valid rows of a history: after a stop by a guard, all except the last."""
    if trusted_to_the_end(stopped_because):
        return history
    return history.isel(time=slice(None, -1))


def summarise(
    history: xarray.Dataset,
    *,
    t500: float | None,
    at_rest_since: float | None,
    spread_rate: float | None,
    particles: int,
    particle_steps: int,
    steps: int,
    wall_time: float,
    stopped_because: str,
    plugins: Any,
    t500_from_lift: float | None = None,
    ended_by: str | None = None,
    measured: Mapping[str, str] = {},
) -> dict[str, Any]:
    """The content of ``summary.json``; None for events that did not occur or were not recorded.

    A run stopped by a guard has no final shape, and its last row may contain an ejected particle: it has no
    final lengths, and it did not come to rest.

    Args:
        history: dataset of a ``History``; its last row is the last state of the run.
        t500: time to a spread of 500 mm, s.
        at_rest_since: time since which the material has been at rest, s.
        spread_rate: rate at which the spread diameter grows at the end, m/s.
        particles: number of particles at the end.
        particle_steps: sum of their number over all steps.
        steps: number of steps done.
        wall_time: s.
        stopped_because: why the run ended.
        ended_by: the condition of the case that ended it, as a sentence.
        plugins: the plug-ins and their versions.
        t500_from_lift: time from the start of the lift of a mould to a spread of 500 mm, s.
        measured: units of the measurements of the case, by the name of the variable.
    """
    arrived = trusted_to_the_end(stopped_because)
    return {
        "t500": t500,
        "t500_from_lift": t500_from_lift,
        "final_spread": _last(history, "spread_diameter") if arrived else None,
        "final_slump": _last(history, "slump") if arrived else None,
        "final_height": _last(history, "height") if arrived else None,
        "final_spread_rate": spread_rate if arrived else None,
        "at_rest_since": at_rest_since if arrived else None,
        "simulated_time": _last(history, "time"),
        "particles": particles,
        "steps": steps,
        "wall_time": wall_time,
        "particle_steps_per_second": particle_steps / wall_time if wall_time > 0 else None,
        "stopped_because": stopped_because,
        "ended_by": ended_by,
        "plugins": plugins,
        **_passed(history),
        **{name: _last(history, name) if arrived else None for name in measured},
        "units": {**UNITS, **{name: "kg" for name in PASSED if name in history.variables}, **measured},
    }


def _passed(history: xarray.Dataset) -> dict[str, Any]:
    """Mass that has come in and gone out, kg, in all and by the names of sources and sinks."""
    found: dict[str, Any] = {name: _last(history, name) for name in PASSED if name in history.variables}
    for kind in ("source", "sink"):
        name = f"{kind}_mass"
        if name in history.variables and history.sizes["time"]:
            last = history[name].values[-1]
            found[name] = dict(zip(map(str, history[kind].values), map(float, last), strict=True))
    return found


def numbers(summary: Mapping[str, Any]) -> dict[str, float]:
    """The numbers of a summary by name, as attributes of a dataset; NaN for events that did not occur."""
    return {name: math.nan if summary[name] is None else summary[name] for name in summary["units"]}


def lifted_later(summary: Mapping[str, Any]) -> bool:
    """Whether T500 from the start of the lift differs from T500 from the start of the run."""
    return summary.get("t500_from_lift") not in (None, summary.get("t500"))


def state_at_end(summary: Mapping[str, Any]) -> str | None:
    """Whether the material still moves, in words; None if the last state is not valid."""
    if not trusted_to_the_end(summary["stopped_because"]):
        return None
    since, rate = summary.get("at_rest_since"), summary.get("final_spread_rate")
    if since is not None:
        return f"at rest since t = {since:.3g} s"
    if rate is not None and rate > LEAST_RATE:
        return f"still spreading, {rate * 1e3:.3g} mm/s"
    return "still moving"


def _last(history: xarray.Dataset, name: str) -> float | None:
    if name not in history.variables or not history.sizes["time"]:
        return None
    value = float(history[name].values[-1])
    return value if math.isfinite(value) else None
