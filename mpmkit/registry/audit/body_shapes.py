"""Body shapes: their bounds and volumes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...contracts import BodyShape, Space
from ...errors import PluginFault
from .returned import described, require_array, require_number


def problem_of_shape(shape: BodyShape, space: Space) -> str | None:
    """Why a space cannot hold a shape, in one sentence; None if it can.

    Raises:
        PluginFault: it returned something else, or says that the space can hold it, but has no bounds
            there.
    """
    found = shape.problem(space)
    if found is None:
        _require_bounds(shape, space)
        return None
    if not isinstance(found, str):
        raise PluginFault(shape, f"returned {described(found)} from problem; it must be a sentence, or None")
    return found


def volume_of(shape: BodyShape, space: Space) -> float:
    """Volume of a shape that a space can hold, m³.

    Raises:
        PluginFault: it is not a finite number, or below 0.
    """
    return _sound(shape, "volume", shape.volume(space))


def size_of(shape: BodyShape, space: Space) -> float:
    """Size of a shape in the coordinates of a space that can hold it, m² or m³.

    Raises:
        PluginFault: it is not a finite number, or below 0.
    """
    return _sound(shape, "size", shape.size(space))


def _sound(shape: BodyShape, what: str, value: Any) -> float:
    found = require_number(shape, what, value)
    if not 0 <= found < math.inf:
        raise PluginFault(shape, f"gave {found} as its {what}; it must be finite and not below 0")
    return found


def _require_bounds(shape: BodyShape, space: Space) -> None:
    found = shape.bounds(space)
    if not isinstance(found, tuple) or len(found) != 2:
        raise PluginFault(shape, f"returned {described(found)} from bounds; it must be two corners")
    for corner in found:
        require_array(shape, "bounds", corner, (space.dim,))
    lower, upper = found
    if not (np.isfinite(lower).all() and np.isfinite(upper).all() and (lower <= upper).all()):
        raise PluginFault(
            shape,
            f"gave the bounds {lower.tolist()} and {upper.tolist()}; they must be finite, the first below "
            "the second",
        )
    if space.radial and lower[0] < 0:
        raise PluginFault(
            shape, f"gave the bound r = {lower[0]:g} m in the space {space.name}; r is at least 0"
        )
