"""Contract of a volumetric treatment: where accuracy of nearly incompressible flow is won or lost."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from .base import Plugin
from .operations import Operations


class VolumetricTreatment(Plugin):
    """Acts on the volumetric rate that drives J and on the pressure that enters the internal force.

    Both go through the same operator: treating only one of them is not self-adjoint and feeds energy in.
    """

    @abstractmethod
    def average(self, ops: Operations, field: np.ndarray) -> np.ndarray:
        """The treated field, ``(n,)``; it may be ``field`` itself."""
