"""The names of version 1 of the contracts, for the plug-ins that were written for it.

All that is deprecated is in this file.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .base import API_VERSION, Plugin
from .law import Kinematics
from .operations import Operations, Weighting

Motion = Kinematics
"""``Kinematics``, as version 1 called it."""


CHANGES = (
    "'Motion' is now 'Kinematics', 'ops.advance' is 'ops.move_particles', "
    "and the argument 'measure' of averages is 'weighting'"
)
"""What must be written otherwise in version 2."""


def deprecation(plugin: type[Plugin] | Plugin) -> str | None:
    """What the author of a plug-in of an older version should change; None for one of the present version."""
    if plugin.api_version == API_VERSION:
        return None
    return (
        f"plug-in '{plugin.name}' is written for version {plugin.api_version} of the plug-in contracts, "
        f"which a later mpmkit will not support; its author should write api_version = {API_VERSION}, "
        f"and: {CHANGES} (docs/plugins.md#versions)"
    )


def operations_for(plugin: Plugin, operations: Operations) -> Operations:
    """The operations under the names that a plug-in knows."""
    return Version1Operations(operations) if plugin.api_version == 1 else operations  # type: ignore[return-value]


class Version1Operations:
    """The operations of a step under the names of version 1; all others are those of today."""

    def __init__(self, operations: Operations) -> None:
        self._operations = operations

    def __getattr__(self, name: str) -> Any:
        return getattr(self._operations, name)

    def advance(self, dt: float, *, flip: float, affine: bool = False) -> None:
        """``move_particles``."""
        self._operations.move_particles(dt, flip=flip, affine=affine)

    def average(self, values: np.ndarray, measure: Weighting = "volume") -> np.ndarray:
        """``average``, whose ``weighting`` was called ``measure``."""
        return self._operations.average(values, measure)

    def particles_to_nodes(self, values: np.ndarray, measure: Weighting = "volume") -> np.ndarray:
        """``particles_to_nodes``, whose ``weighting`` was called ``measure``."""
        return self._operations.particles_to_nodes(values, measure)
