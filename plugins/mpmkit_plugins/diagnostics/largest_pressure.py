"""The largest pressure on a wall."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from mpmkit.contracts import Column, Diagnostic, Observed, Space, hookimpl, quantity


class LargestPressure(Diagnostic):
    """The largest pressure of the particles within half a cell of a wall, and their mean by volume.

    The wall is one of ``walls``, or a face of the grid. ``nan`` if no particle is that close.
    """

    name = "largest-pressure"
    api_version = 2
    citation = "none: a maximum"

    wall: str = quantity("1", "name of a wall, or of a face of the grid such as z_min")

    def problem(self, space: Space, walls: Sequence[str]) -> str | None:
        return None if self.wall in walls else f"wall is '{self.wall}'; it must be one of {', '.join(walls)}"

    def columns(self, space: Space) -> Sequence[Column]:
        return [
            Column("largest", "Pa", f"largest pressure on {self.wall}"),
            Column("mean", "Pa", f"mean pressure on {self.wall}"),
        ]

    def measure(self, scene: Observed) -> Mapping[str, float]:
        near = scene.wall_distance(self.wall) <= scene.cell_size / 2
        if not near.any():
            return {"largest": np.nan, "mean": np.nan}
        pressure = scene.pressure[near]
        mean = np.average(pressure, weights=scene.volume[near])
        return {"largest": float(pressure.max()), "mean": float(mean)}


@hookimpl
def mpmkit_diagnostics() -> list[type[Diagnostic]]:
    return [LargestPressure]
