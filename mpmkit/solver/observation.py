"""Read-only view of a scene for diagnostics and particle fields."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..case.state_variables import field_name
from ..errors import PluginFault
from ..kernels.tensors import shear_rate
from ..registry import audit
from ..spaces import Space
from .particles import Particles
from .state_fields import state_fields
from .stresses import cauchy_stress, mean_pressure, shear_stress
from .view import SceneView


class Observation:
    """``contracts.Observed`` of the present step; values are computed when they are needed."""

    def __init__(self, scene: SceneView) -> None:
        self._scene = scene
        self.space: Space = scene.case.space_
        self.time = scene.time
        self.cell_size = scene.grid.cell_size

    @property
    def _p(self) -> Particles:
        return self._scene.particles

    @cached_property
    def number(self) -> np.ndarray:
        return _read_only(self._p.number)

    @cached_property
    def body(self) -> np.ndarray:
        return _read_only(self._p.body)

    @cached_property
    def position(self) -> np.ndarray:
        return _read_only(self._p.position + self._scene.grid.lower)

    @cached_property
    def velocity(self) -> np.ndarray:
        return _read_only(self._p.velocity)

    @cached_property
    def half_size(self) -> np.ndarray:
        return _read_only(self._p.box)

    @cached_property
    def mass(self) -> np.ndarray:
        return _read_only(self._p.mass)

    @cached_property
    def volume(self) -> np.ndarray:
        return _read_only(self._p.volume)

    @cached_property
    def pressure(self) -> np.ndarray:
        return _read_only(mean_pressure(self._p))

    @cached_property
    def stress(self) -> np.ndarray:
        return _read_only(cauchy_stress(self._p))

    @cached_property
    def shear_stress(self) -> np.ndarray:
        return _read_only(shear_stress(self._p))

    @cached_property
    def shear_rate(self) -> np.ndarray:
        return _read_only(shear_rate(self._p.velocity_gradient))

    @cached_property
    def velocity_gradient(self) -> np.ndarray:
        return _read_only(self._p.velocity_gradient)

    @cached_property
    def _states(self) -> dict[str, np.ndarray]:
        return state_fields(self._p)

    def state(self, name: str) -> np.ndarray:
        """A state variable of the laws, ``(n,)`` or ``(n, k)``."""
        if field_name(name) not in self._states:
            known = ", ".join(field.partition(".")[2] for field in self._states) or "none"
            raise PluginFault(None, f"asked for the state '{name}', which no law has; there are: {known}")
        return _read_only(self._states[field_name(name)])

    def wall_distance(self, name: str) -> np.ndarray:
        """Distance, m, ``(n,)``, from a wall of the case, or a face of its grid."""
        case, grid = self._scene.case, self._scene.grid
        if name in case.walls:
            surface = audit.placed(case.walls[name].surface, case.space_)
            return surface.distance(np.array(self.position), self.time)[0]
        if name not in self.space.faces:
            known = ", ".join([*case.walls, *self.space.faces])
            raise PluginFault(None, f"asked for the wall '{name}'; there are: {known}")
        axis = self.space.axes.index(name.partition("_")[0])
        above = self._p.position[:, axis]
        return above.copy() if name.endswith("min") else grid.extent[axis] - above


def _read_only(array: np.ndarray) -> np.ndarray:
    view = array.view()
    view.flags.writeable = False
    return view
