"""The distance of a ball, or of a disc, which may be hollow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...contracts.solid import Found, Solid


@dataclass(frozen=True)
class Ball(Solid):
    """φ = max(|x - centre| - radius, inner - |x - centre|), m."""

    centre: np.ndarray
    radius: float
    inner: float = 0.0

    def distance(self, x: np.ndarray) -> Found:
        offset, length = unit(x - self.centre)
        beyond, within = length - self.radius, self.inner - length
        from_within = (within > beyond) & (self.inner > 0)
        return np.where(from_within, within, beyond), np.where(from_within[:, None], -offset, offset)

    def hull(self) -> tuple[np.ndarray, float]:
        return self.centre[None], self.radius


def unit(vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vectors (k, dim) with the length 1, and their lengths, (k,); the first axis for a vector of zero."""
    length = np.linalg.norm(vectors, axis=1)
    units = vectors / np.where(length > 0, length, 1.0)[:, None]
    units[length == 0, 0] = 1.0
    return units, length
