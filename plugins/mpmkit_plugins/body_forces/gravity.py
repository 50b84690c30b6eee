"""Constant gravity."""

from __future__ import annotations

import numpy as np

from mpmkit.contracts import BodyForce, Space, hookimpl, quantity

from .vectors import wrong_length


class Gravity(BodyForce):
    """Constant gravity, the long form of the key ``gravity`` of a case."""

    name = "gravity"
    api_version = 2
    citation = "none: a definition"
    uniform = constant = is_gravity = True

    vector: list[float] = quantity("m/s^2", "acceleration along each axis", min_length=2, max_length=3)

    def problem(self, space: Space) -> str | None:
        return wrong_length("vector", self.vector, space)

    def acceleration(self, x: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
        return np.tile(np.array(self.vector), (len(x), 1))


@hookimpl
def mpmkit_body_forces() -> list[type[BodyForce]]:
    return [Gravity]
