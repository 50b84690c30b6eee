"""All runs of a fit in one dataset."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray

from ..study.histories import ROWS, number_or_nan, scalars_at
from ..study.quantities import COSTS, FIGURES
from ..version import __version__
from .model import Fit
from .solve import Solution


def dataset(fit: Fit, solutions: Mapping[str, Solution]) -> xarray.Dataset:
    """One dataset with a dimension for the runs, and time.

    For each run it contains the law, the test and the stage, the values of the parameters by path, the
    results in the summary, the cost, χ² of all tests at that point, and the histories at common times. Values
    that a run does not have are NaN.
    """
    rows = [
        (law, solution, point, number)
        for law, solution in solutions.items()
        for point in solution.runs.points
        for number in range(len(solution.runs.tests))
    ]
    until = max(test.stages[-1].case.end for s in solutions.values() for test in s.runs.tests)
    time = np.linspace(0.0, until, ROWS)
    paths = list(dict.fromkeys(path for s in solutions.values() for path in s.coordinates.paths))
    fields: dict[str, Any] = {
        path: ("run", [point.values.get(path, math.nan) for _, _, point, _ in rows]) for path in paths
    }
    records = [solution.runs.record(point.members[number]) for _, solution, point, number in rows]
    for kind, known in (("summary", FIGURES), ("cost", COSTS)):
        for name, (units, text) in known.items():
            values = [number_or_nan(record.get(kind, {}).get(name)) for record in records]
            fields[name] = ("run", values, {"units": units, "long_name": text})
    fields["chi2"] = (
        "run",
        [_chi2(solution, point) for _, solution, point, _ in rows],
        {"units": "1", "long_name": "squared misfit of all tests, relative to its uncertainty"},
    )
    fields["fate"] = ("run", np.array([record.get("fate", "") for record in records], dtype=object))
    for index, (_, solution, point, number) in enumerate(rows):
        history = solution.runs.history(point.members[number])
        if history is None:
            continue
        for name, series, attributes in scalars_at(history, time):
            if name not in fields:
                fields[name] = (("run", "time"), np.full((len(rows), ROWS), np.nan), attributes)
            fields[name][1][index] = series
    coordinates: dict[str, Any] = {
        "law": ("run", np.array([law for law, *_ in rows], dtype=object)),
        "test": ("run", np.array([s.runs.tests[n].name for _, s, _, n in rows], dtype=object)),
        "stage": ("run", [point.stage for _, _, point, _ in rows]),
        "time": ("time", time, {"units": "s"}),
    }
    found = xarray.Dataset(fields, coordinates)
    found.attrs = {
        "title": fit.name,
        "description": fit.description,
        "fit": json.dumps(fit.model_dump(mode="json")),
        "mpmkit": __version__,
    }
    return found


def _chi2(solution: Solution, point: Any) -> float:
    if point.predicted is None:
        return math.nan
    return float(np.sum(solution.survey.likelihood.misfit.residuals(point.predicted.value) ** 2))
