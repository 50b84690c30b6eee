"""Pressure linear in the density."""

import numpy as np

from mpmkit.contracts import EquationOfState, hookimpl


class Linear(EquationOfState):
    """p = c² (ρ - ρ0) = ρ0 c² (1/J - 1)."""

    name = "linear"
    api_version = 1
    citation = "Morris, Fox & Zhu, J. Comput. Phys. 136 (1997) 214-226"

    def pressure(self, volume_ratio: np.ndarray, density: float, sound_speed: float) -> np.ndarray:
        return density * sound_speed**2 * (1 / volume_ratio - 1)

    def energy(self, volume_ratio: np.ndarray, density: float, sound_speed: float) -> np.ndarray:
        return density * sound_speed**2 * (volume_ratio - 1 - np.log(volume_ratio))


@hookimpl
def mpmkit_equations_of_state():
    return [Linear]
