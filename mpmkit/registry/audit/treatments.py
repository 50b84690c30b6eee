"""Volumetric treatments: the field that they average is not theirs to change."""

from __future__ import annotations

import numpy as np

from ...contracts import VolumetricTreatment
from .fences import READ, Fenced, require_unchanged


class Rehearsed:
    """A copy of a particle field, to be given to a treatment in place of the field itself."""

    def __init__(self, field: np.ndarray) -> None:
        self._field = field
        self._given = Fenced(field, READ)

    @property
    def field(self) -> np.ndarray:
        """What the treatment is given."""
        return self._given.rows

    def result(self, author: VolumetricTreatment, treated: np.ndarray) -> np.ndarray:
        """What it made of the field; the field itself where it gave back what it was given.

        Raises:
            PluginFault: it changed the field.
        """
        require_unchanged(author, {"field": self._given})
        return self._field if treated is self._given.rows else treated
