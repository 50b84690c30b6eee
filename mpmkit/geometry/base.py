"""The interface of all shapes: their place, the points inside, and their size."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict

from ..errors import CaseError
from ..spaces import Space
from .distance import Shell, Solid

TOLERANCE = 1e-9
"""Points closer to the surface than this part of the largest extent count as on the surface."""


class Shape(BaseModel):
    """Base of the shapes; its public methods refuse a shape that the space cannot hold.

    A shape is a solid. A plane-strain scene is its cross-section through its axis, 1 m thick: an upright
    cylinder becomes a rectangle of width 2 R, a sphere a disc. An axisymmetric scene turns its half
    cross-section about r = 0. A point on the surface, to 1e-9 of the largest extent, is inside. So
    lattice points on a face do not depend on rounding, and a symmetric body on a symmetric lattice gets
    symmetric particles.

    A new shape implements ``_problem``, ``_bounds``, ``_contains``, ``_size``, ``_volume``,
    ``_volume_between`` and ``_solid``; a shape with ends that a shell may leave open implements ``ends`` and
    ``_shell``, and a shape read from a file ``files``, ``content`` and ``content_name``.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    turned: ClassVar[bool] = False
    """Whether in 3-D it is a body of revolution about the vertical through ``middle``."""
    tolerance: ClassVar[float] = TOLERANCE
    """Part of its largest extent by which a point may miss its surface and still be on it."""
    files: ClassVar[tuple[str, ...]] = ()
    """Fields that name a file from which it is read."""

    def check(self, space: Space) -> None:
        """Refuse a space that cannot hold the shape; for use within pydantic's validators.

        Raises:
            ValueError: one sentence with the field, its value and what is allowed.
        """
        if problem := self._problem(space):
            raise ValueError(problem)

    def bounds(self, space: Space) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner, m, each (dim,), of the box around the shape; r ≥ 0 if axisymmetric.

        Raises:
            CaseError: the space cannot hold the shape.
        """
        self._require(space)
        lower, upper = self._bounds(space)
        return np.array(lower, dtype=float), np.array(upper, dtype=float)

    def contains(self, points: np.ndarray, space: Space) -> np.ndarray:
        """Whether each of ``points``, m, (n, dim), is inside or on the surface; bool, (n,).

        Raises:
            CaseError: the space cannot hold the shape.
        """
        self._require(space)
        points = np.asarray(points, dtype=float)
        lower, upper = self._bounds(space)
        tolerance = self.tolerance * max(top - bottom for bottom, top in zip(lower, upper, strict=True))
        inside = self._contains(points, space, tolerance)
        return inside & (points[:, 0] >= -tolerance) if space.radial else inside

    def size(self, space: Space) -> float:
        """Size in the coordinates of the space: m³ in 3-D, else m² of the (half) cross-section.

        Raises:
            CaseError: the space cannot hold the shape.
        """
        self._require(space)
        return float(self._size(space))

    def volume(self, space: Space) -> float:
        """Exact volume, m³: of the full circle if axisymmetric, of 1 m of thickness in plane strain.

        Raises:
            CaseError: the space cannot hold the shape.
        """
        self._require(space)
        return float(self._volume(space))

    def volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        """Volume, m³, of the part between two corners, m, each (dim,), as :meth:`volume` counts it.

        It is exact to rounding for boxes and meshes, and to about 1e-10 of the volume for round shapes.

        Raises:
            CaseError: the space cannot hold the shape.
        """
        least, most = self.bounds(space)
        low, high = np.maximum(lower, least), np.minimum(upper, most)
        if (low >= high).any():
            return 0.0
        if (low == least).all() and (high == most).all():
            return self.volume(space)
        return float(self._volume_between(low, high, space))

    def middle(self, space: Space) -> tuple[float, float] | None:
        """Position of planes x = const and y = const that cut it into equal quarters in 3-D, m; else None.

        Raises:
            CaseError: the space cannot hold the shape.
        """
        self._require(space)
        return self._middle() if space.dim == 3 else None

    def solid(self, space: Space) -> Solid:
        """The shape in its space, as a solid with signed distances; exact also near edges and corners.

        Raises:
            CaseError: the space cannot hold the shape.
        """
        self._require(space)
        return self._solid(space)

    def ends(self, space: Space) -> tuple[str, ...]:
        """Names of the ends that a shell around the shape may leave open."""
        return ()

    def ends_left_open(self, space: Space) -> tuple[str, ...]:
        """The ends that it leaves open by default."""
        return ()

    def shell(self, space: Space, thickness: float, open_ends: Sequence[str] | None = None) -> Solid:
        """A shell around the shape, whose inner surface is that of the shape.

        Args:
            space: the space of the scene.
            thickness: m, outwards.
            open_ends: of ``ends``; default: ``ends_left_open``.

        Raises:
            CaseError: the space cannot hold the shape.
        """
        self._require(space)
        return self._shell(space, thickness, self.ends_left_open(space) if open_ends is None else open_ends)

    def content(self, field: str) -> bytes:
        """A copy of the file in ``field``: it gives exactly the same shape, and needs no other file.

        Raises:
            CaseError: the file cannot be read.
        """
        raise NotImplementedError(f"{type(self).__name__} names no file in {field}")

    def content_name(self, field: str) -> str:
        """``name_by_content`` of ``content``, computed from memory; it does not depend on the place of the
        file.

        Raises:
            CaseError: the file cannot be read.
        """
        raise NotImplementedError(f"{type(self).__name__} names no file in {field}")

    def _middle(self) -> tuple[float, float] | None:
        return None

    def _require(self, space: Space) -> None:
        if problem := self._problem(space):
            raise CaseError(problem)

    def _wrong_length(self, field: str, value: list[float], space: Space) -> str | None:
        if len(value) == space.dim:
            return None
        return (
            f"the {self.kind}'s {field} is {value}, but the space {space.name} needs "  # type: ignore[attr-defined]
            f"{space.dim} numbers ({', '.join(space.axes)})"
        )

    def _off_axis(self, field: str, value: list[float], space: Space) -> str | None:
        if not space.radial or value[0] == 0:
            return None
        return (
            f"the {self.kind}'s {field} is {value}, but in the space {space.name} it must be "  # type: ignore[attr-defined]
            "[0, z]: the body turns about r = 0"
        )

    @abstractmethod
    def _solid(self, space: Space) -> Solid: ...

    def _shell(self, space: Space, thickness: float, open_ends: Sequence[str]) -> Solid:
        return Shell(self._solid(space), thickness)

    @abstractmethod
    def _problem(self, space: Space) -> str | None:
        """Why ``space`` cannot hold the shape, in one sentence, or None."""

    @abstractmethod
    def _bounds(self, space: Space) -> tuple[list[float], list[float]]: ...

    @abstractmethod
    def _contains(self, points: np.ndarray, space: Space, tolerance: float) -> np.ndarray: ...

    @abstractmethod
    def _size(self, space: Space) -> float: ...

    @abstractmethod
    def _volume(self, space: Space) -> float: ...

    @abstractmethod
    def _volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float: ...


def squared_distance(points: np.ndarray, centre: list[float]) -> np.ndarray:
    """Σ (x_a − c_a)² over the axes that ``centre`` has, (n,); one axis at a time keeps temporaries small."""
    total = np.zeros(len(points))
    for axis, middle in enumerate(centre):
        offset = points[:, axis] - middle
        offset *= offset
        total += offset
    return total


def disc_area(radius: float) -> float:
    """π R², m²."""
    return math.pi * radius**2
