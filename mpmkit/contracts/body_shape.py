"""Contract of a body shape: a solid that a body fills, or from which a wall is made."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BeforeValidator, SerializeAsAny

from ..errors import PluginFault
from ..spaces import Space
from .base import Plugin
from .body_volume import size_between
from .solid import Found, Shell, Solid

STEP = 1e-6
"""Step of the central differences of a gradient, relative to the largest extent.

It is larger than the square root of the rounding error, and a surface is flat over this length.
"""


class BodyShape(Plugin):
    """A solid that can be a body, a mould or an obstacle.

    A plane-strain scene is its cross-section, 1 m thick. An axisymmetric scene turns its half cross-section,
    r ≥ 0, about r = 0. Points are in the coordinates of the case file; k of them at once.

    A new shape needs only ``bounds`` and ``signed_distance``. All other methods have a default that is
    computed from these two; a shape that can compute a result exactly overrides the method.

    In a case it stands at ``bodies.<n>.shape`` and at ``walls.<name>.surface.shape``, as
    ``{"kind": name, …parameters}``.
    """

    named_by: ClassVar[str] = "kind"

    tolerance: ClassVar[float] = 1e-9
    """Part of its largest extent by which a point may be outside and still count as on its surface. So
    lattice points on a face do not depend on rounding, and a symmetric body gets symmetric particles."""
    turned: ClassVar[bool] = False
    """Whether in 3-D it is a body of revolution about the vertical through ``middle``."""
    files: ClassVar[tuple[str, ...]] = ()
    """Parameters that name a file from which it is read."""
    shell_needs_an_end: ClassVar[bool] = False
    """Whether nothing is left of a shell if all its ``ends`` are open."""

    def problem(self, space: Space) -> str | None:
        """Why it cannot be used in a space, in one sentence that names the parameter; None if it can. It is
        called before any other method.
        """
        return None

    @abstractmethod
    def bounds(self, space: Space) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner, m, each ``(dim,)``, of the box around it; r ≥ 0 where it turns."""

    @abstractmethod
    def signed_distance(self, x: np.ndarray, space: Space) -> np.ndarray:
        """Distance of points, m, ``(k, dim)``, from its surface, m, ``(k,)``: above 0 outside.

        It must be exact near the surface; farther away its magnitude may be smaller than the distance, but
        never larger. In an axisymmetric scene r ≥ 0, and the axis r = 0 is not a surface.
        """

    def within(self, x: np.ndarray, space: Space, tolerance: float) -> np.ndarray:
        """Whether points, m, ``(k, dim)``, are inside or at most a tolerance, m, outside; bool, ``(k,)``."""
        return self.solid(space).distance(x)[0] <= tolerance

    def volume_between(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        """Volume of the part between two corners in its bounds, m, ``(dim,)``, as ``volume`` counts it, m³.

        Default: to about 5e-5 of it, see ``body_volume``.
        """
        return size_between(self.solid(space).distance, lower, upper, space, around=space.radial)

    def volume(self, space: Space) -> float:
        """Volume, m³: of the full circle if axisymmetric, of 1 m of thickness in plane strain."""
        return self.volume_between(*self.bounds(space), space)

    def size(self, space: Space) -> float:
        """Size in the coordinates of the space: m³ in 3-D, else m² of the (half) cross-section."""
        return size_between(self.solid(space).distance, *self.bounds(space), space)

    def solid(self, space: Space) -> Solid:
        """The shape in its space, as a solid with distances and their gradients for walls.

        Default: ``signed_distance`` with a gradient by central differences. A shape whose surface has inner
        edges returns a solid with ``parts``, so that a wall made of it holds material in them.
        """
        return DistanceSolid(self, space)

    def inner_edges(self, inside: bool) -> str | None:
        """Its name in the warning about a wall with inner edges and no ``parts``.

        ``inside`` says that the material is inside of it.
        """
        return None

    def ends(self, space: Space) -> tuple[str, ...]:
        """Names of the ends that a shell around it may leave open."""
        return ()

    def ends_left_open(self, space: Space) -> tuple[str, ...]:
        """The ends that a shell leaves open by default."""
        return ()

    def shell(self, space: Space, thickness: float, open_ends: Sequence[str]) -> Solid:
        """A shell of a thickness, m, around it, whose inner surface is the surface of the shape; open at some
        of ``ends``.
        """
        return Shell(self.solid(space), thickness)

    def middle(self, space: Space) -> tuple[float, float] | None:
        """Position of planes x = const and y = const that cut it into equal quarters in 3-D, m; else None."""
        return None

    def content(self, field: str) -> bytes:
        """A copy of the file in a parameter of ``files``: it gives exactly the same shape, and needs no other
        file."""
        raise NotImplementedError(f"{type(self).__name__} names no file in {field}")

    def content_name(self, field: str) -> str:
        """A file name made from that content; it does not depend on the place of the file."""
        raise NotImplementedError(f"{type(self).__name__} names no file in {field}")

    # For the framework, computed from the methods above.

    def contains(self, x: np.ndarray, space: Space) -> np.ndarray:
        """Whether each of points, m, ``(k, dim)``, is inside or on the surface; bool, ``(k,)``."""
        lower, upper = self.bounds(space)
        tolerance = self.tolerance * float((upper - lower).max())
        inside = self.within(x, space, tolerance)
        if not isinstance(inside, np.ndarray) or inside.shape != (len(x),) or inside.dtype != bool:
            raise PluginFault(self, f"must return an array of {len(x)} values True or False from within")
        return inside & (x[:, 0] >= -tolerance) if space.radial else inside

    def part(self, lower: np.ndarray, upper: np.ndarray, space: Space) -> float:
        """Volume, m³, of the part between any two corners, m, ``(dim,)``, as ``volume`` counts it."""
        least, most = self.bounds(space)
        low, high = np.maximum(lower, least), np.minimum(upper, most)
        if (low >= high).any():
            return 0.0
        if (low == least).all() and (high == most).all():
            return self.volume(space)
        return self.volume_between(low, high, space)


@dataclass(frozen=True)
class DistanceSolid(Solid):
    """A solid that knows the signed distance of a shape; the section of an axisymmetric one is mirrored."""

    shape: BodyShape
    space: Space

    def distance(self, x: np.ndarray) -> Found:
        lower, upper = self.shape.bounds(self.space)
        step = STEP * float((upper - lower).max())
        gradient = np.empty(x.shape)
        for axis in range(self.space.dim):
            ahead, behind = x.copy(), x.copy()
            ahead[:, axis] += step
            behind[:, axis] -= step
            gradient[:, axis] = self._signed(ahead) - self._signed(behind)
        length = np.linalg.norm(gradient, axis=1, keepdims=True)
        anywhere = np.eye(self.space.dim)[-1]  # in the middle of a solid, all directions are the same
        return self._signed(x), np.where(length > 0, gradient / np.where(length > 0, length, 1.0), anywhere)

    def _signed(self, x: np.ndarray) -> np.ndarray:
        if self.space.radial:
            x = np.column_stack([np.abs(x[:, 0]), x[:, 1]])
        found = self.shape.signed_distance(x, self.space)
        if not isinstance(found, np.ndarray) or found.shape != (len(x),) or found.dtype.kind not in "fiu":
            raise PluginFault(
                self.shape, f"must return an array of {len(x)} numbers from signed_distance, one for a point"
            )
        if not np.isfinite(found).all():
            place = ", ".join(f"{c:.4g}" for c in x[int(np.argmin(np.isfinite(found)))])
            raise PluginFault(self.shape, f"gave a signed distance that is not finite at ({place}) m")
        return found

    def hull(self) -> tuple[np.ndarray, float]:
        lower, upper = (np.asarray(corner, dtype=float).copy() for corner in self.shape.bounds(self.space))
        if self.space.radial:
            lower[0] = -upper[0]
        corners = np.stack(np.meshgrid(*zip(lower, upper, strict=True), indexing="ij"), axis=-1)
        return corners.reshape(-1, len(lower)), 0.0


def _kinds(of: type[BodyShape] = BodyShape) -> Iterator[tuple[str, type[BodyShape]]]:
    """Name and class of every shape that is loaded."""
    for shape in of.__subclasses__():
        if isinstance(getattr(shape, "name", None), str):
            yield shape.name, shape
        yield from _kinds(shape)


def _made(value: Any) -> Any:
    """The shape that a dictionary describes; its ``kind`` selects the class."""
    if not isinstance(value, dict):
        return value
    kinds = dict(_kinds())
    if value.get("kind") not in kinds:
        raise ValueError(f"kind is {value.get('kind')!r}; it must be one of {', '.join(sorted(kinds))}")
    return kinds[value["kind"]].model_validate(value)


AnyShape = Annotated[SerializeAsAny[BodyShape], BeforeValidator(_made)]
"""Annotation of a parameter, of a surface for example, that is a shape of any kind."""
