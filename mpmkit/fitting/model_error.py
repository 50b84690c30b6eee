"""How far the finest model of a test is from the solution of its equations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import CaseError
from ..plan import expected_error
from .model import Fit
from .runs import Test

COARSEST_GUESS = 0.02
"""Error of a stage of which nothing is known, while a finer one follows it."""


@dataclass(frozen=True)
class ModelError:
    """Part of each value by which a test's model is off, and how that is known."""

    part: float
    source: str


def known_errors(fit: Fit, tests: list[Test]) -> list[ModelError | None]:
    """For each test the error that the fit file gives, or that the shipped study has of its finest model."""
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
    """The error of the finer of two models, from what both give at one point.

    An error of first order in the cells is the difference over h₁/h₂ − 1, with cells of h₁ and h₂.

    Args:
        test: whose last two stages they are.
        coarse: rows of the test, ``(m,)``, from the last stage but one.
        fine: from the last stage.
        scale: of the rows' errors, ``(m,)``.
    """
    h1, h2 = (stage.case.grid.cell_size for stage in test.stages[-2:])
    ratio = max(h1 / h2, 1.5)  # stages that differ in something else than cells
    known = np.isfinite(scale) & (scale > 0)
    parts = (fine - coarse)[known] / scale[known]
    part = float(np.sqrt(np.mean(parts**2))) / (ratio - 1) if known.any() else 0.0
    return ModelError(part, f"from cells of {1e3 * h1:.3g} and {1e3 * h2:.3g} mm")
