"""How the volumes of the particles follow the flow."""

from __future__ import annotations

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, kernel

FEW = 20_000
"""Up to this number of particles a copy takes less time than the start of several threads."""


@kernel()
def stretch(rate, dt, initial_volume, volume_ratio, volume):
    """J ← J (1 + Δt tr L) and V = V0 J, from the volumetric rate tr L, 1/s; all ``(n,)``."""
    n = len(rate)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            volume_ratio[p] *= 1 + dt * rate[p]
            volume[p] = initial_volume[p] * volume_ratio[p]


@kernel()
def stretch_and_expand(rate, dt, expansion, shear, pressure, initial_volume, volume_ratio, volume, energy):
    """As ``stretch``, with the factor 1 + e Δγ of J for the expansion e = d ln J/dγ and the shear Δγ.

    Args:
        expansion: ``(n,)``, d ln J/dγ, 1.
        shear: Δγ of the step, 1.
        pressure: ``(n,)``, Pa, at the volume ratio before the step.
        energy: J, an entry a chunk: -Σ p V0 ΔJ, the energy stored by the expansion (out).
    """
    n = len(rate)
    for c in prange(chunk_count(n)):
        stored = 0.0
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            strained = volume_ratio[p] * (1 + dt * rate[p])
            change = strained * expansion[p] * shear
            stored -= pressure[p] * initial_volume[p] * change
            volume_ratio[p] = strained + change
            volume[p] = initial_volume[p] * volume_ratio[p]
        energy[c] = stored


def assign(field: np.ndarray, values: np.ndarray) -> None:
    """``field[:] = values``, ``(n,)``, with all threads if that is faster.

    Raises:
        ValueError: the values have another shape.
    """
    if values.shape != field.shape:
        raise ValueError(f"an array of shape {field.shape} was needed, not one of {values.shape}")
    if len(field) < FEW:
        field[:] = values
    else:
        _assign(field, values)


@kernel()
def _assign(field, values):
    n = len(field)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            field[p] = values[p]


@kernel()
def draw(volume_ratio, mean, part):
    """J ← J + part (mean J - J)."""
    n = len(volume_ratio)
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            volume_ratio[p] += part * (mean[p] - volume_ratio[p])
