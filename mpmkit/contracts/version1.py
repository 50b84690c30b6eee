"""What version 1 of the contracts called otherwise, kept for the plug-ins that were written for it."""

from __future__ import annotations

from typing import Any

import numpy as np

from .law import Kinematics
from .operations import Operations, Weighting

Motion = Kinematics
"""``Kinematics``, as version 1 called it."""


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
