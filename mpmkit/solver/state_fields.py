"""The state variables of the laws as fields of the particles."""

from __future__ import annotations

import numpy as np

from ..case.state_variables import field_name
from .particles import Particles


def state_fields(p: Particles) -> dict[str, np.ndarray]:
    """State variables of all laws, ``(n,)`` or ``(n, k)``; NaN for particles of other laws."""
    found: dict[str, np.ndarray] = {}
    for group in p.groups:
        for name, array in group.state.items():
            flat = array.reshape(len(array), -1) if array.ndim > 1 else array
            field = field_name(name)
            if field not in found:
                found[field] = np.full((len(p), *flat.shape[1:]), np.nan)
            found[field][group.part] = flat
    return found
