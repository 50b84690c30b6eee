"""Body shapes: their bounds and volumes."""

from __future__ import annotations

import math

import numpy as np

from ...contracts import BodyShape, Space
from ...errors import PluginFault
from .returned import described, require_array, require_number


def problem_of_shape(shape: BodyShape, space: Space) -> str | None:
    """Why a space cannot hold a shape, in one sentence; None if it can.

    Raises:
        PluginFault: it returned something else, or says that the space can hold it, but has no bounds or no
            volume there.
    """
    found = shape.problem(space)
    if found is None:
        _require_bounds(shape, space)
        return None
    if not isinstance(found, str):
        raise PluginFault(shape, f"returned {described(found)} from problem; it must be a sentence, or None")
    return found


def require_volume(shape: BodyShape, space: Space) -> None:
    """Raise PluginFault unless a shape that a space can hold has a volume there."""
    for what in ("volume", "size"):
        found = require_number(shape, what, getattr(shape, what)(space))
        if not 0 <= found < math.inf:
            raise PluginFault(shape, f"gave {found} as its {what}; it must be finite and not below 0")


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
