"""Measured and fitted values side by side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .measurements import Measured
from .solve import Solution


@dataclass(frozen=True)
class Comparison:
    """One measurement and its values at the best parameters, ``(n,)`` each; n > 1 for a curve."""

    test: str
    measured: Measured
    fitted: np.ndarray
    uncertainty: np.ndarray
    """standard uncertainty of the difference: of the measurement and of the model"""

    @property
    def variable(self) -> str:
        """Its name in sentences, such as ``final spread``."""
        return self.measured.quantity.words

    @property
    def unit(self) -> str:
        return self.measured.quantity.unit

    @property
    def is_curve(self) -> bool:
        return self.measured.is_curve

    @property
    def off(self) -> np.ndarray:
        """Fitted minus measured values, ``(n,)``."""
        return self.fitted - self.measured.value

    @property
    def largest(self) -> float:
        """Largest difference."""
        return float(np.abs(self.off).max())

    @property
    def rms(self) -> float:
        """RMS difference."""
        return float(np.sqrt(np.mean(self.off**2)))

    @property
    def sentence(self) -> str:
        """The comparison in words, with units."""
        where = f"{self.test}, {self.variable}"
        if self.is_curve:
            rms, largest = (_quantity(value, self.unit, 2) for value in (self.rms, self.largest))
            return (
                f"{where}: {len(self.off)} measured values; the RMS difference of the fitted curve is {rms}, "
                f"the largest is {largest}"
            )
        fitted, measured = (_quantity(float(of[0]), self.unit) for of in (self.fitted, self.measured.value))
        uncertainty = _quantity(float(self.uncertainty[0]), self.unit, 2)
        return (
            f"{where}: fitted {fitted}, measured {measured} (standard uncertainty, model error included: "
            f"{uncertainty})"
        )

    def as_json(self) -> dict[str, Any]:
        """The entry in ``fit.json``."""
        named = {"test": self.test, "variable": self.variable, "unit": self.unit}
        if self.is_curve:
            return named | {
                "rows": len(self.off),
                "largest_difference": self.largest,
                "rms_difference": self.rms,
            }
        return named | {
            "measured": float(self.measured.value[0]),
            "uncertainty": float(self.uncertainty[0]),
            "fitted": float(self.fitted[0]),
        }


def comparisons(solution: Solution) -> list[Comparison]:
    """Every measurement of every test, in their order."""
    found, start, total = [], 0, solution.survey.likelihood.misfit.total
    for test in solution.runs.tests:
        for one in test.measured:
            rows = slice(start, start + len(one.value))
            start = rows.stop
            found.append(Comparison(test.name, one, solution.fitted[rows], total[rows]))
    return found


def _quantity(value: float, unit: str, digits: int = 4) -> str:
    return f"{value:.{digits}g} {'' if unit == '1' else unit}".rstrip()
