"""The flux through a plane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from mpmkit.contracts import Column, Diagnostic, Observed, Space, hookimpl, quantity


class Flux(Diagnostic):
    """Mass and volume that pass a plane per time, positive along its axis: Σ m v_n part/Δx, and Σ V v_n
    part/Δx.

    The part of a particle's box counts that lies within half a cell Δx of the plane. So boxes that fill the
    room and move alike give ρ A v to rounding. Along r the plane is a cylinder around the axis.
    """

    name = "flux"
    api_version = 2
    citation = "none: the definition of a flux"

    axis: str = quantity("1", "axis to which the plane is normal, such as z")
    at: float = quantity("m", "place of the plane on the axis")

    def problem(self, space: Space, walls: Sequence[str]) -> str | None:
        if self.axis in space.axes:
            return None
        return f"axis is '{self.axis}'; the space {space.name} has the axes {', '.join(space.axes)}"

    def columns(self, space: Space) -> Sequence[Column]:
        through = f"through {self.axis} = {self.at:g} m"
        return [
            Column("mass_flux", "kg/s", f"mass flux {through}"),
            Column("volume_flux", "m^3/s", f"volume flux {through}"),
        ]

    def measure(self, scene: Observed) -> Mapping[str, float]:
        axis, half = scene.space.axes.index(self.axis), scene.cell_size / 2
        x, size = scene.position[:, axis], scene.half_size[:, axis]
        low, high = np.maximum(x - size, self.at - half), np.minimum(x + size, self.at + half)
        rate = np.maximum(high - low, 0) / (2 * size) * scene.velocity[:, axis] / scene.cell_size
        return {
            "mass_flux": float(np.sum(scene.mass * rate)),
            "volume_flux": float(np.sum(scene.volume * rate)),
        }


@hookimpl
def mpmkit_diagnostics() -> list[type[Diagnostic]]:
    return [Flux]
