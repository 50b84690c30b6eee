"""Contract of a volumetric treatment, which decides the accuracy of nearly incompressible flow."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from .base import Plugin
from .operations import Operations


class VolumetricTreatment(Plugin):
    """Acts on the volumetric rate that drives J and on the pressure that enters the internal force.

    Both go through the same operator A in the same step. Where V A is symmetric, as for an average over the
    grid, the power of the mapped pressure equals the loss of compressive energy,

        Σ V (A p) tr L = Σ V p (A tr L) = Σ p dV/dt,

    so the treatment neither creates nor dissipates energy. To treat only one of them would.
    """

    @abstractmethod
    def average(self, ops: Operations, field: np.ndarray) -> np.ndarray:
        """The treated field A f, ``(n,)``; a new array, or ``field`` itself."""

    def relaxation_rate(self, ops: Operations) -> float:
        """Rate, 1/s, at which J of each particle tends to the average around it; default: 0.

        The average is by initial volume. The rate should not depend on the step: J relaxes by
        1 - exp(-∫ rate dt) of the difference, each time the integral has reached 0.05.
        """
        return 0.0
