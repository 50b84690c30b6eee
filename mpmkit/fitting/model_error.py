"""How far the finest model of a test is from the solution of its equations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import CaseError
from ..plan import expected_error
from .model import Fit
from .runs import Test

COARSEST_GUESS = 0.02
"""Assumed error of a stage with unknown error, if a finer stage follows."""


@dataclass(frozen=True)
class ModelError:
    """Relative error of the values of a test's model, and its source."""

    part: float
    source: str


def known_errors(fit: Fit, tests: list[Test]) -> list[ModelError | None]:
    """For each test the error of its finest model, from the fit file or from the shipped study."""
    found: list[ModelError | None] = []
    for test in tests:
        given = fit.tests[test.name].model_error
        if given is not None:
            found.append(ModelError(given, "as the fit file says"))
            continue
        try:
            error = expected_error(test.stages[-1].case)
        except CaseError:
            error = None
        found.append(None if error is None else ModelError(error, "from the study of plan"))
    return found


def from_coarser(test: Test, coarse: np.ndarray, fine: np.ndarray, scale: np.ndarray) -> ModelError:
    """The error of the finer of two models, from the results of both at one point.

    If the error is of first order in the cell size h, it is (difference of the results) / (h₁/h₂ − 1).

    Args:
        test: the test; the models are its last two stages.
        coarse: rows of the test, ``(m,)``, from the last stage but one.
        fine: from the last stage.
        scale: of the rows' errors, ``(m,)``.
    """
    h1, h2 = (stage.case.grid.cell_size for stage in test.stages[-2:])
    ratio = max(h1 / h2, 1.5)  # for stages that differ in something other than cells
    known = np.isfinite(scale) & (scale > 0)
    parts = (fine - coarse)[known] / scale[known]
    part = float(np.sqrt(np.mean(parts**2))) / (ratio - 1) if known.any() else 0.0
    return ModelError(part, f"from cells of {1e3 * h1:.3g} and {1e3 * h2:.3g} mm")
