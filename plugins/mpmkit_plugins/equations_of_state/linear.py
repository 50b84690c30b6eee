"""Pressure linear in the density."""

import numpy as np
from numba import prange

from mpmkit.contracts import EquationOfState, hookimpl
from mpmkit.kernels.compile import CHUNK, chunk_count, kernel
from mpmkit.kernels.elementary import SMALLEST, log


class Linear(EquationOfState):
    """p = c² (ρ - ρ0) = ρ0 c² (1/J - 1)."""

    name = "linear"
    api_version = 2
    citation = "Morris, Fox & Zhu, J. Comput. Phys. 136 (1997) 214-226"

    def pressure(self, volume_ratio: np.ndarray, density: float, sound_speed: float) -> np.ndarray:
        pressure = np.empty(len(volume_ratio))
        _pressure(volume_ratio, density * sound_speed**2, pressure)
        return pressure

    def energy(self, volume_ratio: np.ndarray, density: float, sound_speed: float) -> np.ndarray:
        energy = np.empty(len(volume_ratio))
        _energy(volume_ratio, density * sound_speed**2, energy)
        return energy


@kernel()
def _pressure(volume_ratio, bulk_modulus, pressure):
    n = len(volume_ratio)
    for c in prange(chunk_count(n)):
        J = volume_ratio[c * CHUNK : min(n, (c + 1) * CHUNK)]
        p = pressure[c * CHUNK : min(n, (c + 1) * CHUNK)]
        for i in range(len(J)):
            p[i] = bulk_modulus * (1 / J[i] - 1)


@kernel()
def _energy(volume_ratio, bulk_modulus, energy):
    n = len(volume_ratio)
    for c in prange(chunk_count(n)):
        J = volume_ratio[c * CHUNK : min(n, (c + 1) * CHUNK)]
        e = energy[c * CHUNK : min(n, (c + 1) * CHUNK)]
        for i in range(len(J)):
            x = J[i] - 1
            # Where the two terms all but cancel, x - ln(1 + x) is x²/2 - x³/3 + x⁴/4 - …, to all digits.
            close = x * x * (0.5 + x * (-1 / 3 + x * (0.25 + x * (-0.2 + x * (1 / 6 - x / 7)))))
            e[i] = bulk_modulus * (close if abs(x) < 0.01 else x - log(max(J[i], SMALLEST)))


@hookimpl
def mpmkit_equations_of_state():
    return [Linear]
