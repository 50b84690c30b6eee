"""Initial fields: the shape of their values, and the values that they return."""

from __future__ import annotations

import numpy as np

from ...contracts import Beginning, ConstitutiveLaw, InitialField, Space
from ...errors import PluginFault
from .returned import require_array

LAW = "law."
"""Before the name of a state variable."""


def shape_of(field: str, law: ConstitutiveLaw, space: Space) -> tuple[int, ...]:
    """Shape of a value of a field; KeyError if a law has no such state variable."""
    if field == "velocity":
        return (space.dim,)
    return (6,) if field == "stress" else law.state[field.removeprefix(LAW)].shape


def initial_values(field: InitialField, start: Beginning) -> np.ndarray:
    """The values of a field, ``(n, *shape)``.

    Raises:
        PluginFault: they are not an array of this shape, or not finite.
    """
    given = start.position.view()
    given.flags.writeable = False
    found = field.at(Beginning(**{**vars(start), "position": given}))
    require_array(field, "at", found, (len(given), *start.shape))
    if not np.isfinite(found).all():
        raise PluginFault(field, f"gave a {start.field} that is not finite")
    return found
