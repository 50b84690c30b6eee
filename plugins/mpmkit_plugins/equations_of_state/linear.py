"""Pressure linear in the density."""

import numpy as np
from numba import prange

from mpmkit.contracts import EquationOfState, hookimpl
from mpmkit.kernels.compile import CHUNK, chunk_count, kernel


class Linear(EquationOfState):
    """p = c² (ρ - ρ0) = ρ0 c² (1/J - 1)."""

    name = "linear"
    api_version = 1
    citation = "Morris, Fox & Zhu, J. Comput. Phys. 136 (1997) 214-226"

    def pressure(self, volume_ratio: np.ndarray, density: float, sound_speed: float) -> np.ndarray:
        pressure = np.empty(len(volume_ratio))
        _pressure(volume_ratio, density * sound_speed**2, pressure)
        return pressure

    def energy(self, volume_ratio: np.ndarray, density: float, sound_speed: float) -> np.ndarray:
        return density * sound_speed**2 * (volume_ratio - 1 - np.log(volume_ratio))


@kernel()
def _pressure(volume_ratio, bulk_modulus, pressure):
    n = len(volume_ratio)
    for c in prange(chunk_count(n)):
        J = volume_ratio[c * CHUNK : min(n, (c + 1) * CHUNK)]
        p = pressure[c * CHUNK : min(n, (c + 1) * CHUNK)]
        for i in range(len(J)):
            p[i] = bulk_modulus * (1 / J[i] - 1)


@hookimpl
def mpmkit_equations_of_state():
    return [Linear]
