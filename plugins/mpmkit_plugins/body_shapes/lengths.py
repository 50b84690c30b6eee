"""Functions for several shapes: sentences about wrong coordinates, and distances."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mpmkit.contracts import BodyShape, Space


def wrong_length(shape: BodyShape, field: str, value: list[float], space: Space) -> str | None:
    """A sentence if a point does not have one coordinate for each axis."""
    if len(value) == space.dim:
        return None
    return (
        f"the {shape.name}'s {field} is {value}, but the space {space.name} needs {space.dim} numbers "
        f"({', '.join(space.axes)})"
    )


def off_axis(shape: BodyShape, field: str, value: list[float], space: Space) -> str | None:
    """A sentence if the middle of a round shape is not on the axis of an axisymmetric scene."""
    if not space.radial or value[0] == 0:
        return None
    return (
        f"the {shape.name}'s {field} is {value}, but in the space {space.name} it must be [0, z]: the body "
        "turns about r = 0"
    )


def squared_distance(x: np.ndarray, centre: Sequence[float]) -> np.ndarray:
    """Σ (x_a - c_a)² over the axes that ``centre`` has, (n,); one axis at a time keeps temporaries small."""
    total = np.zeros(len(x))
    for axis, middle in enumerate(centre):
        offset = x[:, axis] - middle
        offset *= offset
        total += offset
    return total
