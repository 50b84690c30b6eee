"""Contract of a sink: where material leaves the scene."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from .base import Plugin
from .surface import Space


class Sink(Plugin):
    """Takes particles out of the scene, which are then counted in ``mass_out`` and in the ledger.

    In a case it stands at ``sinks.<name>``, as ``{"kind": name, …parameters}``.
    """

    named_by: ClassVar[str] = "kind"

    def problem(self, space: Space, faces: Mapping[str, Any]) -> str | None:
        """Why a scene cannot have it, in one sentence that names the parameter; None if it can.

        ``faces`` are the faces of its grid by name, each as in a case: ``"open"``, ``"slip"``, ….
        """
        return None

    @abstractmethod
    def takes(self, x: np.ndarray, t: float, domain: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """Whether it takes what is at places ``x``, m, ``(n, dim)``, at a time, s: ``(n,)`` True or False.

        It is asked after every step. ``domain`` has the lower and the upper corner of the grid, m.
        """
