"""An open face of the grid through which material leaves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from mpmkit.contracts import Sink, Space, hookimpl, quantity


class Face(Sink):
    """Removes the material that has left through an open face of the grid."""

    name = "face"
    api_version = 2
    citation = "none: a definition"

    face: str = quantity("1", "name of the face, such as x_max; it must be open")

    def problem(self, space: Space, faces: Mapping[str, Any]) -> str | None:
        radial_axis = space.radial and self.face == "r_min"
        if self.face not in faces or radial_axis:
            known = ", ".join(name for name in faces if not (space.radial and name == "r_min"))
            return f"face is '{self.face}'; it must be one of {known}"
        if faces[self.face] != "open":
            return f"face is '{self.face}', which is closed; only an open face lets material out"
        return None

    def takes(self, x: np.ndarray, t: float, domain: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        lower, upper = domain
        letter, _, side = self.face.partition("_")
        axis = {"x": 0, "r": 0, "y": 1, "z": -1}[letter]
        return x[:, axis] < lower[axis] if side == "min" else x[:, axis] > upper[axis]


@hookimpl
def mpmkit_sinks() -> list[type[Sink]]:
    return [Face]
