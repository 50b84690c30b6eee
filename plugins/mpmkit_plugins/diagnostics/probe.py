"""A probe at a point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from mpmkit.contracts import Column, Diagnostic, Observed, Space, hookimpl, quantity

NEAREST = 0.5
"""Cells, along each axis, within which there must be a particle."""


class Probe(Diagnostic):
    """Pressure, velocity and shear rate at a point x, by a linear fit to the particles around it.

    f(x) = a with a, b of the least Σ V w (f_p - a - b·(x_p - x))², w = Π (1 - |x_p - x|/Δx)² along each axis
    up to a cell Δx. It is exact for fields that are linear in space. Not a number where no particle is within
    half a cell.
    """

    name = "probe"
    api_version = 2
    citation = "Lancaster & Salkauskas, Math. Comput. 37 (1981) 141-158"

    at: list[float] = quantity("m", "the point, a coordinate along each axis", min_length=2, max_length=3)

    def problem(self, space: Space, walls: Sequence[str]) -> str | None:
        if len(self.at) == space.dim:
            return None
        return f"at is {self.at}; the space {space.name} needs {space.dim} numbers ({', '.join(space.axes)})"

    def columns(self, space: Space) -> Sequence[Column]:
        place = f"at ({', '.join(f'{x:g}' for x in self.at)}) m"
        velocities = [Column(f"velocity_{a}", "m/s", f"velocity along {a} {place}") for a in space.axes]
        rate = Column("shear_rate", "1/s", f"shear rate {place}")
        return [Column("pressure", "Pa", f"pressure {place}"), *velocities, rate]

    def measure(self, scene: Observed) -> Mapping[str, float]:
        names = [column.name for column in self.columns(scene.space)]
        away = (scene.position - np.array(self.at)) / scene.cell_size
        around = (np.abs(away) < 1).all(axis=1)
        if not (np.abs(away[around]) <= NEAREST).all(axis=1).any():
            return dict.fromkeys(names, np.nan)
        fields = [scene.pressure, *scene.velocity.T, scene.shear_rate]
        values = np.stack([field[around] for field in fields], axis=1)
        return dict(zip(names, _at_middle(away[around], scene.volume[around], values), strict=True))


def _at_middle(away: np.ndarray, volume: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The fit at the point; the mean with the same weights where there are too few particles for slopes."""
    weight = np.sqrt(volume / volume.max()) * np.prod(1 - np.abs(away), axis=1)
    linear = np.column_stack([np.ones(len(away)), away]) * weight[:, None]
    fit, _, rank, _ = np.linalg.lstsq(linear, values * weight[:, None], rcond=1e-6)
    return fit[0] if rank == linear.shape[1] else np.average(values, axis=0, weights=weight**2)


@hookimpl
def mpmkit_diagnostics() -> list[type[Diagnostic]]:
    return [Probe]
