"""The fitted flow curve with its band, over the shear rates that the tests reached."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..case.parameters import BLOCK
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
    fields = _fields(solution)
    bodies = sorted({body for body, _ in fields})
    if not bodies:
        return []
    reached = _reached(solution.runs, solution.values)
    if reached is None:
        return []
    rates = np.geomspace(*reached, PLACES)
    points = [solution.coordinates.values(u) for u in region(solution, level)]
    found = []
    for body in bodies:
        own = {field: path for (of, field), path in fields.items() if of == body}
        law = solution.runs.tests[0].stages[-1].case.bodies[body].material.constitutive_law
        laws = [law.model_copy(update={f: point[path] for f, path in own.items()}) for point in points]
        curves = [curve for one in laws if (curve := flow_curve(one, rates)) is not None]
        if curves:
            found.append(FlowCurve(body, rates, curves[0], np.min(curves, axis=0), np.max(curves, axis=0)))
    return found


def _fields(solution: Solution) -> dict[tuple[int, str], str]:
    """The path that gives each fitted parameter of a law, by the number of its body and its name.

    A path leads to it directly, as ``bodies.0.material.yield_stress``, or by a parameter at the top of the
    case with the same value.
    """
    stage, values, found = solution.runs.tests[0].stages[-1], solution.values, {}
    for path in solution.coordinates.paths:
        keys = path.split(".")
        if len(keys) == 4 and keys[0] == "bodies" and keys[2] == "material":
            found[int(keys[1]), keys[3]] = path
        elif keys[0] == BLOCK:
            for body, entry in enumerate(stage.member(values).case.bodies):
                for field, value in entry.material.constitutive_law.model_dump().items():
                    if value == values[path]:
                        found[body, field] = path
    laws = [body.material.constitutive_law for body in stage.case.bodies]
    return {place: path for place, path in found.items() if place[1] in type(laws[place[0]]).model_fields}


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
