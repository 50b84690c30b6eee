"""The result of a fit, as an object and as the content of ``fit.json``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import xarray

from ..version import __version__
from . import further, laws, unknowable
from .comparison import Comparison, comparisons
from .dataset import dataset
from .flow_curve import FlowCurve
from .model import Fit
from .profiles import Interval
from .solve import Solution
from .words import Names


@dataclass(frozen=True)
class Found:
    """A parameter with its interval."""

    path: str
    unit: str
    value: float
    low: float
    high: float
    level: float
    identifiable: bool
    """whether the measurements limit it on both sides within the bounds of the search"""


@dataclass(frozen=True)
class FitResult:
    """What ``mpmkit.fit`` returns."""

    fit: Fit
    solutions: Mapping[str, Solution]
    """the solution of each law, the law of the cases first"""
    curves: list[FlowCurve] = field(default_factory=list)

    @property
    def solution(self) -> Solution:
        return next(iter(self.solutions.values()))

    @cached_property
    def names(self) -> Names:
        return names_of(self.solution)

    @cached_property
    def parameters(self) -> dict[str, Found]:
        """Best values and intervals by path."""
        return found_in(self.solution, self.fit.level)

    @cached_property
    def correlation(self) -> np.ndarray:
        """Correlation of the parameters, ``(n, n)``, in the order of ``parameters``."""
        return unknowable.correlation(self.solution)

    @cached_property
    def comparisons(self) -> list[Comparison]:
        """Measured and fitted values of each measurement."""
        return comparisons(self.solution)

    @cached_property
    def dataset(self) -> xarray.Dataset:
        """All runs."""
        return dataset(self.fit, self.solutions)

    @cached_property
    def further(self) -> list[further.Further]:
        """Possible further measurements, the most useful first."""
        return further.further(self.solution)

    @cached_property
    def evidence(self) -> list[laws.Evidence]:
        """The comparison of the laws; empty if there is only one."""
        return laws.compare(dict(self.solutions)) if len(self.solutions) > 1 else []

    @cached_property
    def sentences(self) -> list[str]:
        """Remarks on the result, in plain words."""
        return [*self.unknown, self.advice, *self.remarks]

    @cached_property
    def unknown(self) -> list[str]:
        """What cannot be known from these measurements."""
        return unknowable.sentences(self.solution, self.names)

    @cached_property
    def advice(self) -> str:
        """Which further measurement would help most."""
        return further.sentence(self.further, self.names)

    @cached_property
    def remarks(self) -> list[str]:
        """How the result was found, and how far to trust it."""
        said = [*self.solution.said, *unknowable.remarks(self.solution)]
        for test, error in zip(self.solution.runs.tests, self.solution.errors, strict=True):
            if error is None:
                said.append(
                    f"The error of the model of test '{test.name}' is not known and counts as 0: give "
                    "model_error, or two stages."
                )
        if self.evidence:
            said.append(laws.sentence(self.evidence))
        return said

    @property
    def runs(self) -> int:
        """Number of runs behind the result, stored runs included."""
        slugs = {m.slug for s in self.solutions.values() for point in s.runs.points for m in point.members}
        return len(slugs)

    def as_json(self) -> dict[str, Any]:
        """The content of ``fit.json``."""
        solution, survey = self.solution, self.solution.survey
        misfit = survey.likelihood.misfit
        return {
            "name": self.fit.name,
            "description": self.fit.description,
            "parameters": {path: _entry(found) for path, found in self.parameters.items()},
            "correlation": {
                path: dict(zip(solution.coordinates.paths, row.tolist(), strict=True))
                for path, row in zip(solution.coordinates.paths, self.correlation, strict=True)
            },
            "runs": self.runs,
            "misfit": {
                "chi2": survey.chi2,
                "numbers": len(misfit),
                "widened_by": math.sqrt(survey.widened),
                "runs_agree": survey.agrees,
            },
            "model_error": {
                test.name: None if error is None else {"part": error.part, "source": error.source}
                for test, error in zip(solution.runs.tests, solution.errors, strict=True)
            },
            "measurements": [one.as_json() for one in self.comparisons],
            "sentences": self.sentences,
            "further": [vars(one) for one in self.further[:5]],
            "laws": [
                vars(one)
                | {
                    "parameters": {
                        path: _entry(found)
                        for path, found in found_in(self.solutions[one.law], self.fit.level).items()
                    }
                }
                for one in self.evidence
            ],
            "mpmkit": __version__,
        }


def names_of(solution: Solution) -> Names:
    """Names and units of the parameters of a solution."""
    stage = solution.runs.tests[0].stages[-1]
    return Names(solution.coordinates.paths, stage.case, stage.units)


def found_in(solution: Solution, level: float) -> dict[str, Found]:
    """Parameters of a solution with their intervals, by path."""
    names = names_of(solution)
    found = {}
    for index, (path, interval) in enumerate(
        zip(solution.coordinates.paths, solution.survey.intervals, strict=True)
    ):
        value, low, high = _values(solution, index, interval)
        found[path] = Found(path, names.unit(path), value, low, high, level, solution.survey.bounded[index])
    return found


def _values(solution: Solution, index: int, interval: Interval) -> tuple[float, float, float]:
    best, low, high = (
        solution.coordinates.value(index, u) for u in (interval.best, interval.low, interval.high)
    )
    return best, low, high


def _entry(found: Found) -> dict[str, Any]:
    return {key: value for key, value in vars(found).items() if key != "path"}
