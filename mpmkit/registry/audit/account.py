"""The operations that an order and a velocity update have called in a step, against a complete step."""

from __future__ import annotations

import math
from numbers import Real
from typing import Any

from ...contracts import UpdateOrder, VelocityUpdate
from ...errors import PluginFault

ROUNDING = 1e-9
"""Largest relative difference between the sum of the parts and the whole step."""


class Account:
    """Adds up the time, s, for which each operation of a step was called.

    Whatever the order of the operations, a step of ``dt`` moves the particles with the nodal velocity of the
    present forces for ``dt`` seconds in total, and updates their stress with the velocity gradient for ``dt``
    seconds in total, in one or several parts.
    """

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """A new step."""
        self._forces = 0
        self._solved = self._moved = self._stressed = 0.0
        self._gradient = False
        self._unready: str | None = None
        self.advanced = 0.0
        """s, by which the velocity update has advanced the particles in its present call"""

    def mapped(self, forces: bool) -> None:
        """Particles were mapped to nodes that had been cleared."""
        self._forces, self._solved = int(forces), 0.0

    def forced(self) -> None:
        """Forces were added to the nodes."""
        self._forces += 1

    def solved(self, dt: Any) -> None:
        """The nodal velocity was advanced."""
        self._solved += seconds(dt)

    def moves(self, dt: Any) -> None:
        """The nodes are about to be mapped back to the particles."""
        self._moved += seconds(dt)
        self.advanced = 0.0
        if self._unready is None and self._forces != 1:
            self._unready = f"moved particles with the forces mapped {self._forces} times; it must be once"
        elif self._unready is None and not _equal(self._solved, dt):
            self._unready = (
                f"moved particles by {dt:.4g} s with nodal velocities advanced by {self._solved:.4g} s"
            )

    def advances(self, dt: Any, graded: bool) -> None:
        """The velocity update advances the particles, and if ``graded`` updates their velocity gradient."""
        self.advanced += seconds(dt)
        self._gradient |= graded

    def graded(self) -> None:
        """The velocity gradient was updated."""
        self._gradient = True

    def stressed(self, dt: Any) -> None:
        """The stress was updated."""
        self._stressed += seconds(dt)
        if not self._gradient and self._unready is None:
            self._unready = "updated the stress without the velocity gradient of the step"

    def require_moved(self, author: VelocityUpdate, dt: float, by_itself: bool) -> None:
        """Raise PluginFault if a velocity update did not advance the particles by ``dt`` seconds.

        Args:
            by_itself: whether particles were moved, or may have been, without ``Operations.move_particles``.
        """
        if not _equal(self.advanced, dt) and (self.advanced or not by_itself):
            raise PluginFault(
                author, f"advanced the particles by {self.advanced:.4g} s in a step of {dt:.4g} s"
            )

    def require_whole(self, author: UpdateOrder, dt: float) -> None:
        """Raise PluginFault if an order did not advance the scene by ``dt`` seconds in total."""
        if self._unready is not None:
            raise PluginFault(author, self._unready)
        for what, done in (("moved the particles", self._moved), ("updated the stress", self._stressed)):
            if not _equal(done, dt):
                raise PluginFault(author, f"{what} by {done:.4g} s in a step of {dt:.4g} s")


def seconds(dt: Any) -> float:
    """A duration that a plug-in gave, s.

    Raises:
        PluginFault: it is not a finite number.
    """
    if not is_finite(dt):
        raise PluginFault(None, f"asked for a step of {dt!r} s; it must be a finite number")
    return float(dt)


def is_finite(value: Any) -> bool:
    """Whether a value that a plug-in gave is a finite real number."""
    return (type(value) is float or isinstance(value, Real)) and math.isfinite(value)


def _equal(done: float, dt: float) -> bool:
    return abs(done - dt) <= ROUNDING * dt
