"""Rotations about an axis: their generator and their matrix."""

from __future__ import annotations

import math

import numpy as np


def generator(axis: list[float] | None) -> np.ndarray:
    """K with K r = axis × r, (dim, dim), for the axis of length 1.

    Without an axis it is that of a plane, whose axis is out of it: K turns axis 0 towards axis 1.
    """
    if axis is None:
        return np.array([[0.0, -1.0], [1.0, 0.0]])
    direction = np.array(axis) / np.abs(axis).max()  # avoids overflow of its square
    x, y, z = direction / np.linalg.norm(direction)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def rotation(axis: list[float] | None, angle: float) -> np.ndarray:
    """Q = I + sin(α) K + (1 - cos(α)) K², after Rodrigues, (dim, dim), for an angle α, rad."""
    K = generator(axis)
    return np.eye(len(K)) + math.sin(angle) * K + (1 - math.cos(angle)) * (K @ K)


def axis_problem(axis: list[float] | None, dim: int, space: str) -> str | None:
    """Why a space with so many axes cannot have this axis of rotation, in a sentence; None if it can."""
    if dim == 3 and (axis is None or not any(axis)):
        what = "missing" if axis is None else axis
        return f"axis is {what}; in the space {space} it must be a direction, such as [0, 0, 1]"
    if dim == 2 and axis is not None:
        return f"axis is {axis}, but in the space {space} it is out of the plane: leave it out"
    return None
