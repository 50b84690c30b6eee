"""Points of the parameters that fit the measurements, for bands of dependent quantities."""

from __future__ import annotations

import numpy as np

from .profiles import critical
from .solve import Solution

TRIED = 4000
SEED = 17


def region(solution: Solution, level: float) -> np.ndarray:
    """Points with Δχ² below the critical value of one number, ``(k, n)``, the best one first.

    The least and the largest value of a quantity over these points are its interval by the profile
    likelihood. Half of the tried points follow the covariance around the best, half cover the intervals.
    """
    survey = solution.survey
    n, random = len(survey.best), np.random.default_rng(SEED)
    covariance = survey.likelihood.covariance(survey.best) * survey.widened
    near = random.multivariate_normal(survey.best, 2 * covariance, TRIED // 2, method="cholesky")
    low, high = (np.array([getattr(i, end) for i in survey.intervals]) for end in ("low", "high"))
    over = low + (high - low) * random.random((TRIED - TRIED // 2, n))
    ends = [end for i in survey.intervals for end in (i.low_at, i.high_at)]
    tried = np.clip(np.vstack([survey.best[None], np.array(ends), near, over]), 0, 1)
    chi2 = survey.likelihood.chi2(tried)
    return tried[chi2 - chi2[0] <= critical(level) * survey.widened * (1 + 1e-6)]
