"""Contract of an equation of state: pressure from the volume ratio."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from .base import Plugin


class EquationOfState(Plugin):
    """Pressure of a weakly compressible fluid with an artificial sound speed."""

    @abstractmethod
    def pressure(self, volume_ratio: np.ndarray, density: float, sound_speed: float) -> np.ndarray:
        """Pressure, Pa, positive in compression, at J ``(n,)``; density in kg/m³, sound speed in m/s."""

    @abstractmethod
    def energy(self, volume_ratio: np.ndarray, density: float, sound_speed: float) -> np.ndarray:
        """Compressive energy per initial volume, J/m³: minus the integral of p over J from 1."""
