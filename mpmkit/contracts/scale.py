"""The scales of a scene, from which a law may choose parameters that a case does not give."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

REST_SHEAR_RATE = 1e-12
"""Shear rate, 1/s, that stands for rest, so that a law written as in the paper divides by no zero."""


@dataclass(frozen=True)
class Scale:
    """The scale of a scene at its start.

    √e/h is the shear rate of a flow without viscosity. The scene cannot drive a stress above ρ e.
    """

    energy: float
    """e, J/kg: largest energy of a particle, of its speed and its height over the lowest one; g h at rest."""
    length: float
    """h, m: extent of all bodies along gravity."""

    @property
    def rate(self) -> float:
        """√e/h, 1/s; zero if nothing drives the scene."""
        return math.sqrt(self.energy) / self.length

    def flow(self, viscous_stress: Callable[[np.ndarray], np.ndarray], density: float) -> tuple[float, float]:
        """Shear rate, 1/s, and viscous stress, Pa, of a material in this scene; zeros if nothing flows.

        The rate is √e/h, or the rate with a viscous stress of ρ e if that is smaller.

        Args:
            viscous_stress: rising stress beyond the yield stress, Pa, at shear rates ``(m,)``, 1/s.
            density: ρ, kg/m³.
        """
        if not self.rate > 0:
            return 0.0, 0.0
        rates = np.maximum(self.rate * np.geomspace(1.0, 1e-12, 600), REST_SHEAR_RATE)
        with np.errstate(over="ignore"):  # a curve may be beyond any number at the first rates
            borne = np.flatnonzero(viscous_stress(rates) <= density * self.energy)
        if not len(borne):
            return 0.0, 0.0
        rate = rates[borne[:1]]
        return float(rate[0]), float(viscous_stress(rate)[0])
