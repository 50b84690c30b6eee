"""Volumetric treatments: they must not change the field that they average."""

from __future__ import annotations

import numpy as np

from ...contracts import VolumetricTreatment
from .fences import READ, Fenced, require_unchanged


class Rehearsed:
    """A copy of a particle field that is given to a treatment instead of the field itself."""

    def __init__(self, field: np.ndarray) -> None:
        self._field = field
        self._given = Fenced(field, READ)

    @property
    def field(self) -> np.ndarray:
        """The copy that the treatment is given."""
        return self._given.rows

    def result(self, author: VolumetricTreatment, treated: np.ndarray) -> np.ndarray:
        """The treated field; the field itself if the treatment returned its argument.

        Raises:
            PluginFault: it changed the field.
        """
        require_unchanged(author, {"field": self._given})
        return self._field if treated is self._given.rows else treated
