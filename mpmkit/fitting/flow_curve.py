"""The fitted flow curve with its band, over the shear rates that the tests reached."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..rheology.flow_curve import flow_curve
from ..study.members import Member
from .region import region
from .runs import Runs
from .solve import Solution

PLACES = 61
SHARE = (0.05, 0.95)
"""Quantiles of the flowing material between which shear rates count as reached."""
LEAST_RATE = 1e-3
"""1/s; slower material counts as at rest."""
ROWS = 200
"""Rows of the run whose particles are used."""


@dataclass(frozen=True)
class FlowCurve:
    """Shear stress, Pa, at shear rates, 1/s, all ``(p,)``, of one body."""

    body: int
    rate: np.ndarray
    stress: np.ndarray
    low: np.ndarray
    high: np.ndarray


def flow_curves(solution: Solution, level: float) -> list[FlowCurve]:
    """The flow curve of each body with a fitted parameter; left out if its law has no flow curve.

    Raises:
        Spent: the budget is too small for the run that gives the reached shear rates.
    """
    bodies = sorted(
        {int(path.split(".")[1]) for path in solution.coordinates.paths if _field(path) is not None}
    )
    if not bodies:
        return []
    reached = _reached(solution.runs, solution.values)
    if reached is None:
        return []
    rates = np.geomspace(*reached, PLACES)
    points = [solution.coordinates.values(u) for u in region(solution, level)]
    found = []
    for body in bodies:
        curves = [curve for point in points if (curve := _curve(solution, body, point, rates)) is not None]
        if curves:
            found.append(FlowCurve(body, rates, curves[0], np.min(curves, axis=0), np.max(curves, axis=0)))
    return found


def _field(path: str) -> str | None:
    """The parameter of a law at a path such as ``bodies.0.material.yield_stress``; None for other paths."""
    keys = path.split(".")
    return keys[3] if len(keys) == 4 and keys[0] == "bodies" and keys[2] == "material" else None


def _curve(solution: Solution, body: int, values: dict[str, float], rates: np.ndarray) -> np.ndarray | None:
    law = solution.runs.tests[0].stages[-1].case.bodies[body].material.constitutive_law
    own: dict[str, Any] = {
        str(_field(path)): value
        for path, value in values.items()
        if path.startswith(f"bodies.{body}.") and _field(path) in type(law).model_fields
    }
    return flow_curve(law.model_copy(update=own), rates)


def _reached(runs: Runs, values: dict[str, float]) -> tuple[float, float] | None:
    """Lowest and highest shear rate of the flow, 1/s, from the coarsest models at the best values."""
    members = []
    for test in runs.tests:
        stage = test.stage(0, runs.stages)
        more = {"output.particle_history": ["shear_rate", "yielded"]}
        members.append(stage.member(values | more | {"output.history_interval": stage.case.end / ROWS}))
    rates = [rate for member in members if (rate := _rates(runs, member)) is not None]
    return (min(low for low, _ in rates), max(high for _, high in rates)) if rates else None


def _rates(runs: Runs, member: Member) -> tuple[float, float] | None:
    runs.make([member])
    history = runs.history(member)
    if history is None or "shear_rate" not in history:
        return None
    rate = history.shear_rate.values
    flowing = rate[(history.yielded.values > 0) & (rate > LEAST_RATE)]
    if flowing.size == 0:
        return None
    low, high = np.quantile(flowing, SHARE)
    return (float(low), float(high)) if high > low else None
