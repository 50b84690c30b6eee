"""A drain in the scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from mpmkit.contracts import Sink, Space, hookimpl, quantity


class Box(Sink):
    """Removes the material that enters a box, lower ≤ x ≤ upper along each axis."""

    name = "box"
    api_version = 2
    citation = "none: a definition"

    lower: list[float] = quantity("m", "lower corner", min_length=2, max_length=3)
    upper: list[float] = quantity("m", "upper corner", min_length=2, max_length=3)

    def problem(self, space: Space, faces: Mapping[str, Any]) -> str | None:
        for field in ("lower", "upper"):
            corner = getattr(self, field)
            if len(corner) != space.dim:
                needs = f"the space {space.name} needs {space.dim} numbers ({', '.join(space.axes)})"
                return f"{field} is {corner}; {needs}"
        if not all(low < high for low, high in zip(self.lower, self.upper, strict=True)):
            return (
                f"lower is {self.lower} and upper is {self.upper}; lower must be below upper along each axis"
            )
        return None

    def takes(self, x: np.ndarray, t: float, domain: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        return np.all((x >= self.lower) & (x <= self.upper), axis=1)


@hookimpl
def mpmkit_sinks() -> list[type[Sink]]:
    return [Box]
