"""Parameters as coordinates along their scale: 0 is the lower bound, 1 the upper bound."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from .model import Parameter

DIGITS = 6
"""Digits of the values in a run: points that agree in these digits share one run."""
FACTOR = 0.1
"""Relative change of a parameter for derivatives; its effect is larger than the noise of a run."""
LARGEST_STEP = 0.1
"""Largest such change along the coordinate."""


class Coordinates:
    """The box of the parameters.

    Args:
        parameters: by path.
    """

    def __init__(self, parameters: Mapping[str, Parameter]) -> None:
        self.paths = list(parameters)
        self.parameters = list(parameters.values())

    @property
    def have_priors(self) -> bool:
        return any(parameter.prior is not None for parameter in self.parameters)

    def without_priors(self) -> Coordinates:
        """The same box without priors."""
        free = [parameter.model_copy(update={"prior": None}) for parameter in self.parameters]
        return Coordinates(dict(zip(self.paths, free, strict=True)))

    def __len__(self) -> int:
        return len(self.paths)

    def value(self, index: int, u: float) -> float:
        """Value of a parameter at its coordinate, in its unit."""
        p = self.parameters[index]
        if p.scale == "log":
            return float(p.low * (p.high / p.low) ** u)
        return float(p.low + (p.high - p.low) * u)

    def coordinate(self, index: int, value: float) -> float:
        """Coordinate of a value; beyond the bounds it is below 0 or above 1."""
        p = self.parameters[index]
        if p.scale == "log":
            return math.log(value / p.low) / math.log(p.high / p.low)
        return (value - p.low) / (p.high - p.low)

    def values(self, u: np.ndarray) -> dict[str, float]:
        """Values by path at a point, rounded to ``DIGITS`` digits, and within the bounds."""
        found = {}
        for index, (path, p) in enumerate(zip(self.paths, self.parameters, strict=True)):
            rounded = float(f"{self.value(index, float(u[index])):.{DIGITS}g}")
            found[path] = min(max(rounded, p.low), p.high)
        return found

    def steps(self, u: np.ndarray) -> np.ndarray:
        """Steps of finite differences at a point, each towards the middle of the box."""
        steps = []
        for index, p in enumerate(self.parameters):
            if p.scale == "log":
                step = math.log(1 + FACTOR) / math.log(p.high / p.low)
            else:
                step = FACTOR * abs(self.value(index, float(u[index]))) / (p.high - p.low)
            step = min(max(step, LARGEST_STEP / 10), LARGEST_STEP)
            steps.append(step if u[index] <= 0.5 else -step)
        return np.array(steps)

    def prior_residuals(self, u: np.ndarray) -> np.ndarray:
        """Differences from the priors over their deviations, ``(…, p)``, of the parameters that have a prior.

        On a logarithmic scale, the deviation of the logarithm is used: deviation/value.
        """
        found = []
        for index, p in enumerate(self.parameters):
            if p.prior is not None:
                mean, deviation = self.coordinate(index, p.prior.value), p.prior.deviation
                if p.scale == "log":
                    width = deviation / p.prior.value / math.log(p.high / p.low)
                else:
                    width = deviation / (p.high - p.low)
                found.append((u[..., index] - mean) / width)
        return np.stack(found, axis=-1) if found else np.zeros((*u.shape[:-1], 0))
