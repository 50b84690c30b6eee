"""Comparison of laws by Akaike's criterion for few data (AICc)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .solve import Solution

STRONG, WEAK = 10.0, 2.0
"""Differences of AICc: above the first, one law is far better; below the second, both are equally good."""


@dataclass(frozen=True)
class Evidence:
    """How well a law describes the measurements for the number of its parameters."""

    law: str
    unknowns: int
    rows: int
    chi2: float
    aicc: float
    """NaN if there are too few rows for this number of parameters"""
    difference: float
    """difference from the AICc of the best law"""


def compare(solutions: dict[str, Solution]) -> list[Evidence]:
    """AICc = χ² + 2 k + 2 k (k + 1)/(m − k − 1) of each, with k parameters and m measured numbers.

    χ² is that of the measurements: −2 ln(likelihood) up to a constant that all laws share, because all use
    the same covariance, that of the first law. Hurvich & Tsai, Biometrika 76 (1989) 297.
    """
    first = next(iter(solutions.values()))
    misfit = first.survey.likelihood.misfit
    rows, found = len(misfit), []
    for name, solution in solutions.items():
        k = len(solution.coordinates)
        chi2 = float(np.sum(misfit.residuals(solution.fitted) ** 2))
        aicc = chi2 + 2 * k + 2 * k * (k + 1) / (rows - k - 1) if rows - k - 1 > 0 else math.nan
        found.append((name, k, chi2, aicc))
    best = min((aicc for *_, aicc in found if math.isfinite(aicc)), default=math.nan)
    return [Evidence(name, k, rows, chi2, aicc, aicc - best) for name, k, chi2, aicc in found]


def sentence(evidence: list[Evidence]) -> str:
    """A sentence about the comparison."""
    if any(not math.isfinite(one.aicc) for one in evidence):
        return (
            f"The measurements are {evidence[0].rows} numbers, too few to compare laws by Akaike's "
            "criterion; it needs at least two numbers more than a law has parameters."
        )
    best, *others = sorted(evidence, key=lambda one: one.difference)
    told = []
    for other in others:
        ratio = math.exp(min(other.difference / 2, 700.0))
        if other.difference < WEAK:
            told.append(f"'{best.law}' and '{other.law}' describe the measurements equally well")
        else:
            much = "far better than" if other.difference > STRONG else "better than"
            told.append(
                f"'{best.law}' describes the measurements {much} '{other.law}', with an evidence ratio "
                f"of {ratio:.3g} to 1"
            )
    numbers = ", ".join(f"'{one.law}' {one.aicc:.4g}" for one in evidence)
    return f"By Akaike's criterion for few data {'; '.join(told)} (AICc: {numbers})."
