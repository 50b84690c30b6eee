"""Contract of a body force: an acceleration of all material, such as gravity that turns."""

from __future__ import annotations

import math
from abc import abstractmethod
from itertools import product
from typing import ClassVar

import numpy as np

from .base import Plugin
from .surface import Space

TIMES = 257
"""Number of times at which ``largest`` takes samples."""
PLACES = (0.0, 0.5, 1.0)
"""Places in the box along each axis at which ``largest`` takes samples, as parts of its side."""


class BodyForce(Plugin):
    """An acceleration field. Each particle gets the force of its mass times the acceleration at its place.

    In a case it stands at ``forces.<name>``, as ``{"kind": name, …parameters}``. Forces and gravity add up.
    Places, velocities and accelerations have a component for each axis of the space.
    """

    named_by: ClassVar[str] = "kind"

    uniform: ClassVar[bool] = False
    """Whether it is the same at all places and for all velocities. It is then asked for one place only."""
    constant: ClassVar[bool] = False
    """Whether it is uniform and the same at all times. It then counts as a part of ``gravity``, with a
    potential energy."""
    is_gravity: ClassVar[bool] = False
    """Whether it stands for gravity. A case with such a force has no other gravity by default."""
    of_velocity: ClassVar[bool] = False
    """Whether it depends on the velocity. It is then computed for the velocity in the middle of the step."""

    def problem(self, space: Space) -> str | None:
        """Why a space cannot have it, in one sentence that names the parameter; None if it can."""
        return None

    @abstractmethod
    def acceleration(self, x: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
        """Acceleration, m/s², ``(n, dim)``, at a time, s.

        Args:
            x: places, m, ``(n, dim)``, in the coordinates of the case; read-only.
            v: velocities of the material there, m/s, ``(n, dim)``; read-only.
        """

    def mean_acceleration(self, x: np.ndarray, v: np.ndarray, t0: float, t1: float) -> np.ndarray:
        """Mean acceleration over a step from t0 to t1, m/s², ``(n, dim)``; default: that in the middle.

        Override it with the exact mean, (∫ a dt) / (t1 - t0), if the acceleration has pulses: a pulse that is
        shorter than a step then still gives its whole impulse.
        """
        return self.acceleration(x, v, (t0 + t1) / 2)

    def largest(self, lower: np.ndarray, upper: np.ndarray, t0: float, t1: float) -> np.ndarray:
        """Upper bound of each component's magnitude, m/s², ``(dim,)``, in a box, for material at rest.

        Default: the largest of samples in the box and between the times.
        """
        x = lower + np.array(list(product(PLACES, repeat=len(lower)))) * (upper - lower)
        v = np.zeros_like(x)
        found = [np.abs(self.acceleration(x, v, t)).max(axis=0) for t in np.linspace(t0, t1, TIMES)]
        return np.max(found, axis=0)

    def settles(self) -> float:
        """Time, s, from which on the force is constant; default: never. A run does not end at rest before."""
        return -math.inf if self.constant else math.inf

    def shortest_period(self) -> float:
        """Shortest period, s, of its changes, which the time step resolves; default: infinite."""
        return math.inf
