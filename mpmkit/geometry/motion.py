"""Rigid motions: displacement along a line or a table, rotation, oscillation."""

from __future__ import annotations

import math
from abc import abstractmethod
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, model_validator

from ..contracts.base import quantity
from ..contracts.table import require_table
from ..spaces import Space
from . import turning

Hull = tuple[np.ndarray, float]
"""Points, m, (m, dim), and how far, m, a body reaches beyond their convex hull."""


TOO_FAST = 1e9
"""m/s, of a table: the square of a velocity must be a number."""


class Motion(BaseModel):
    """A rigid motion, x = point + Q(t) (X - point) + u(t); X is the initial position of a point of the body.

    By default it does not turn: Q is the unit matrix.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    turns: ClassVar[bool] = False
    """Whether points of the body have different velocities."""

    @abstractmethod
    def vectors(self) -> dict[str, list[float]]:
        """Its vectors, by the names of their fields; each has one component per axis of the space."""

    @abstractmethod
    def displacement(self, t: float) -> np.ndarray:
        """u, m, (dim,), at a time, s."""

    @abstractmethod
    def velocities(self, x: np.ndarray, t: float) -> np.ndarray:
        """Velocity, m/s, (k, dim), of the body's points that are at ``x``, m, (k, dim)."""

    @abstractmethod
    def fastest(self, t0: float, t1: float, hull: Hull) -> float:
        """Upper bound, m/s, of the velocity in a body with a ``hull`` between two times, see ``Solid``."""

    @abstractmethod
    def in_words(self, axes: tuple[str, ...]) -> str:
        """The motion in words that follow the name of a wall; ``axes`` are those of the space."""

    def problem(self, space: Space) -> str | None:
        """Why a space cannot have it, in words that follow "the motion's"; None if it can."""
        for field, vector in self.vectors().items():
            if len(vector) != space.dim:
                return (
                    f"{field} is {vector}, but the space {space.name} needs {space.dim} numbers "
                    f"({', '.join(space.axes)})"
                )
            if space.radial and vector[0] != 0:
                return (
                    f"{field} is {vector}, but in the space {space.name} it must be [0, z]: a wall moves "
                    "along the axis only"
                )
        return None

    def back(self, x: np.ndarray, t: float) -> np.ndarray:
        """X, m, (k, dim), of the points that are at ``x`` at a time."""
        return x - self.displacement(t)

    def turned(self, vectors: np.ndarray, t: float) -> np.ndarray:
        """Vectors of the body, (k, dim), rotated to their direction at a time."""
        return vectors


class Spell(Motion):
    """A motion with a start and an end; before and after it, the body is at rest."""

    start: float = quantity("s", "time at which it begins; default: 0", default=0.0)
    end: float | None = quantity("s", "time at which it ends; default: never", default=None)

    @model_validator(mode="after")
    def _ends_after_its_start(self) -> Spell:
        if self.end is not None and self.end <= self.start:
            raise ValueError(f"end is {self.end:g} s; it must be above start, {self.start:g} s")
        return self

    def _elapsed(self, t: float) -> float:
        """Time since the start of the motion, s, limited to its duration."""
        return max(0.0, min(t, math.inf if self.end is None else self.end) - self.start)

    def _when(self) -> str:
        """The time of the motion in words."""
        return f"from t = {self.start:g} s {'on' if self.end is None else f'to {self.end:g} s'}"

    def _moves(self, t0: float, t1: float) -> bool:
        """Whether it moves at some time of [t0, t1]."""
        return t1 >= self.start and (self.end is None or t0 < self.end)


class Uniform(Spell):
    """u = velocity (t - start), from start to end."""

    kind: Literal["velocity"]
    velocity: list[float] = quantity("m/s", "velocity along each axis", min_length=2, max_length=3)

    def vectors(self) -> dict[str, list[float]]:
        return {"velocity": self.velocity}

    def in_words(self, axes: tuple[str, ...]) -> str:
        return f"moves at {_along(self.velocity, 'm/s', axes)} {self._when()}"

    def displacement(self, t: float) -> np.ndarray:
        return self._elapsed(t) * np.array(self.velocity)

    def velocities(self, x: np.ndarray, t: float) -> np.ndarray:
        return np.tile(np.array(self.velocity) * self._moves(t, t), (len(x), 1))

    def fastest(self, t0: float, t1: float, hull: Hull) -> float:
        return math.hypot(*self.velocity) if self._moves(t0, t1) else 0.0


class Table(Motion):
    """Displacements at given times, linear between them; at rest before the first and after the last time."""

    kind: Literal["table"]
    times: list[float] = quantity("s", "rising times", min_length=2)
    positions: list[Annotated[list[float], Field(min_length=2, max_length=3)]] = quantity(
        "m", "displacement along each axis at each of the times", min_length=2
    )

    @model_validator(mode="after")
    def _is_a_table(self) -> Table:
        require_table("positions", self.positions, self.times)
        for (t0, t1), (x0, x1) in zip(pairwise(self.times), pairwise(self.positions), strict=True):
            if max(abs(b - a) for a, b in zip(x0, x1, strict=True)) > TOO_FAST * (t1 - t0):
                raise ValueError(f"positions go from {x0} to {x1} in {t1 - t0:g} s, which is too fast")
        return self

    def vectors(self) -> dict[str, list[float]]:
        return {f"positions.{number}": position for number, position in enumerate(self.positions)}

    def in_words(self, axes: tuple[str, ...]) -> str:
        first, last = self.times[0], self.times[-1]
        return f"moves by a table of {len(self.times)} places from t = {first:g} s to {last:g} s"

    def displacement(self, t: float) -> np.ndarray:
        return np.array([np.interp(t, self.times, along) for along in zip(*self.positions, strict=True)])

    def _rates(self) -> np.ndarray:
        """Velocity, m/s, (rows - 1, dim), between each time and the next."""
        return np.diff(np.array(self.positions), axis=0) / np.diff(np.array(self.times))[:, None]

    def velocities(self, x: np.ndarray, t: float) -> np.ndarray:
        row = int(np.searchsorted(self.times, t, side="right")) - 1
        moves = 0 <= row < len(self.times) - 1
        return np.tile(self._rates()[row] if moves else np.zeros(x.shape[1]), (len(x), 1))

    def fastest(self, t0: float, t1: float, hull: Hull) -> float:
        times = np.array(self.times)
        within = (times[:-1] <= t1) & (times[1:] > t0)
        return float(np.linalg.norm(self._rates()[within], axis=1).max(initial=0.0))


class Oscillation(Spell):
    """u = amplitude (sin(2π f (t - start) + phase) - sin(phase)), from start to end."""

    kind: Literal["oscillation"]
    amplitude: list[float] = quantity("m", "amplitude along each axis", min_length=2, max_length=3)
    frequency: float = quantity("Hz", "frequency f", gt=0)
    phase: float = quantity("rad", "phase at the start", default=0.0)

    def vectors(self) -> dict[str, list[float]]:
        return {"amplitude": self.amplitude}

    def in_words(self, axes: tuple[str, ...]) -> str:
        amplitude = _along(self.amplitude, "m", axes)
        return f"swings by {amplitude} at {self.frequency:g} Hz {self._when()}"

    def displacement(self, t: float) -> np.ndarray:
        angle = 2 * math.pi * self.frequency * self._elapsed(t) + self.phase
        return (math.sin(angle) - math.sin(self.phase)) * np.array(self.amplitude)

    def velocities(self, x: np.ndarray, t: float) -> np.ndarray:
        rate = 2 * math.pi * self.frequency * self._moves(t, t)
        factor = rate * math.cos(2 * math.pi * self.frequency * self._elapsed(t) + self.phase)
        return np.tile(factor * np.array(self.amplitude), (len(x), 1))

    def fastest(self, t0: float, t1: float, hull: Hull) -> float:
        return 2 * math.pi * self.frequency * math.hypot(*self.amplitude) if self._moves(t0, t1) else 0.0


class Rotation(Spell):
    """Q turns by rate (t - start) about an axis through ``point``, from start to end.

    In 3-D it turns by the right-hand rule about ``axis``. In plane strain the axis is out of the plane, and a
    positive rate turns x towards z.
    """

    turns = True

    kind: Literal["rotation"]
    point: list[float] = quantity("m", "a point of the axis", min_length=2, max_length=3)
    axis: list[float] | None = quantity(
        "1", "direction of the axis, only in 3d", default=None, min_length=3, max_length=3
    )
    rate: float = quantity("rad/s", "angular velocity")

    def vectors(self) -> dict[str, list[float]]:
        return {"point": self.point}

    def problem(self, space: Space) -> str | None:
        if space.radial:
            return f"kind is 'rotation', which the space {space.name} does not have"
        return turning.axis_problem(self.axis, space.dim, space.name) or super().problem(space)

    def in_words(self, axes: tuple[str, ...]) -> str:
        direction = "" if self.axis is None else f"the direction ({_numbers(self.axis)}) through "
        return f"turns at {self.rate:g} rad/s about {direction}({_numbers(self.point)}) m {self._when()}"

    def displacement(self, t: float) -> np.ndarray:
        return np.zeros(len(self.point))

    def back(self, x: np.ndarray, t: float) -> np.ndarray:
        return self.point + (x - self.point) @ self._turn(t)

    def turned(self, vectors: np.ndarray, t: float) -> np.ndarray:
        return vectors @ self._turn(t).T

    def velocities(self, x: np.ndarray, t: float) -> np.ndarray:
        return self.rate * self._moves(t, t) * (x - self.point) @ turning.generator(self.axis).T

    def fastest(self, t0: float, t1: float, hull: Hull) -> float:
        points, radius = hull
        arms = np.linalg.norm((points - self.point) @ turning.generator(self.axis).T, axis=1)
        return abs(self.rate) * float(arms.max() + radius) if self._moves(t0, t1) else 0.0

    def _turn(self, t: float) -> np.ndarray:
        """Q of the angle turned by so far."""
        return turning.rotation(self.axis, self.rate * self._elapsed(t))


def _numbers(values: list[float]) -> str:
    return ", ".join(f"{value:g}" for value in values)


def _along(vector: list[float], unit: str, axes: tuple[str, ...]) -> str:
    """A vector in words: "0.3 m/s along z", or with a component for each axis."""
    moving = [(value, axis) for value, axis in zip(vector, axes, strict=True) if value != 0]
    if len(moving) == 1:
        return f"{moving[0][0]:g} {unit} along {moving[0][1]}"
    return f"({_numbers(vector)}) {unit} along ({', '.join(axes)})"


def _motion_tag(value: Any) -> str:
    # Tags differ from all names of keys, so that the path of an error is clear.
    kind = value.get("kind") if isinstance(value, dict) else getattr(value, "kind", None)
    return f"by-{kind}"


AnyMotion = Annotated[
    Annotated[Uniform, Tag("by-velocity")]
    | Annotated[Table, Tag("by-table")]
    | Annotated[Rotation, Tag("by-rotation")]
    | Annotated[Oscillation, Tag("by-oscillation")],
    Discriminator(_motion_tag),
]
"""Any motion in a case file; its ``kind`` selects the class."""
