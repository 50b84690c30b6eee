"""The misfit over its uncertainty, of measurements with independent errors and a model with correlated
ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import block_diag, cho_factor, solve_triangular

from .measurements import Measured


class Misfit:
    """Residuals r = L⁻¹ (y(x) − d), with L Lᵀ = C, so that r·r = χ².

    C = diag(σ²) + e eᵀ ∘ K: σ is the uncertainty of the measurements d, whose errors are independent. e is
    the error of the model, which is correlated along a curve: K = exp(−|Δt|/T) within a measurement, and 0
    between two measurements. Independent model errors would average out over a curve with many rows.

    Args:
        measured: the measurements of all tests.
        model_error: e, ``(m,)``, in the units of the rows.
    """

    def __init__(self, measured: Sequence[Measured], model_error: np.ndarray) -> None:
        self.value = np.concatenate([one.value for one in measured])
        self.uncertainty = np.concatenate([one.uncertainty for one in measured])
        self.model_error = model_error
        correlation = block_diag(*[one.correlation() for one in measured])
        self.covariance = np.diag(self.uncertainty**2) + np.outer(model_error, model_error) * correlation
        self._factor = cho_factor(self.covariance, lower=True)[0]

    def __len__(self) -> int:
        return len(self.value)

    @property
    def total(self) -> np.ndarray:
        """Standard uncertainty of each row with the model's error, ``(m,)``."""
        return np.sqrt(np.diag(self.covariance))

    def whitened(self, difference: np.ndarray) -> np.ndarray:
        """L⁻¹ times a difference ``(m,)``, or several, ``(m, k)``."""
        return solve_triangular(self._factor, difference, lower=True)

    def residuals(self, predicted: np.ndarray) -> np.ndarray:
        """r, ``(m,)``."""
        return self.whitened(predicted - self.value)
