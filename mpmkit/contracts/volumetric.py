"""Contract of a volumetric treatment: where accuracy of nearly incompressible flow is won or lost."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from .base import Plugin
from .operations import Operations


class VolumetricTreatment(Plugin):
    """Acts on the volumetric rate that drives J and on the pressure that enters the internal force.

    Both go through the same operator A in the same step. Where V A is symmetric, as for an average over the
    grid, the power of the mapped pressure is then what the compressive energy loses,

        Σ V (A p) tr L = Σ V p (A tr L) = Σ p dV/dt,

    so that the treatment neither feeds energy in nor takes any out. Treating only one of them does.
    """

    @abstractmethod
    def average(self, ops: Operations, field: np.ndarray) -> np.ndarray:
        """The treated field A f, ``(n,)``; a new array, or ``field`` itself."""

    def relaxation_rate(self, ops: Operations) -> float:
        """Rate, 1/s, at which each particle's J is drawn to the average of those around it.

        The average is by initial volume. The rate should not depend on the step: J relaxes by
        1 - exp(-∫ rate dt) of the difference, whenever the integral has come to a twentieth.
        """
        return 0.0
