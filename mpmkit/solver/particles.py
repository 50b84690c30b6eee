"""The particles: a structure of arrays, in groups of one material. Only refinement replaces the arrays."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..contracts import ConstitutiveLaw, EquationOfState, Kinematics
from ..contracts.law import initial_state
from ..contracts.scale import Scale
from ..errors import PluginFault
from ..kernels.sort import permute
from ..registry.audit import require_number, require_sentences
from .stateful import State, plain_state, restore_plain

STIFFER = 1.05
"""The step follows the wave speed if it exceeds that of the unstrained material by this factor."""


@dataclass
class Group:
    """Particles of one material: a contiguous stretch ``part`` of every array, with the state of its law."""

    law: ConstitutiveLaw
    equation_of_state: EquationOfState
    density: float
    """kg/m³, at J = 1"""
    sound_speed: float | None
    """m/s, present sound speed of the equation of state"""
    mach: float | None
    """largest Mach number, if the sound speed follows the flow; else None"""
    part: slice
    state: dict[str, np.ndarray]

    @property
    def wave_speed(self) -> float:
        """Fastest wave of the unstrained material, m/s.

        Raises:
            PluginFault: it is not a positive number.
        """
        given = self.law.wave_speed(self.density, self.sound_speed)
        speed = require_number(self.law, "wave_speed", given)
        if not speed > 0 and (self.sound_speed is None or math.isfinite(self.sound_speed)):
            raise PluginFault(self.law, f"has a wave speed of {speed} m/s; it must be positive")
        return speed

    @property
    def remarks(self) -> list[str]:
        """Sentences of the law about itself in this material."""
        said = self.law.remarks(self.density, self.sound_speed)
        return require_sentences(self.law, "remarks", said)

    def warnings(self, scale: Scale, until: float) -> list[str]:
        """Warnings about this material in a scene that runs for ``until`` s."""
        said = self.law.warnings(self.density, self.sound_speed, scale, until)
        return require_sentences(self.law, "warnings", said)

    def pressure(self, volume_ratio: np.ndarray) -> np.ndarray:
        """Pressure of the equation of state, Pa; for a law that uses one."""
        assert self.sound_speed is not None
        return self.equation_of_state.pressure(volume_ratio, self.density, self.sound_speed)

    def compressive_energy(self, volume_ratio: np.ndarray) -> np.ndarray:
        """Energy of the equation of state per initial volume, J/m³; for a law that uses one."""
        assert self.sound_speed is not None
        return self.equation_of_state.energy(volume_ratio, self.density, self.sound_speed)


@dataclass
class Particles:
    """State of all particles, n of them on dim axes. Positions are measured from the grid's lower corner."""

    number: np.ndarray
    """(n,) number of each particle; it stays the same when the arrays are sorted"""
    body: np.ndarray
    """(n,) number of its body in the case; sources are counted after the bodies"""
    position: np.ndarray
    """(n, dim) m"""
    velocity: np.ndarray
    """(n, dim) m/s"""
    affine: np.ndarray
    """(n, dim, dim) affine part of the velocity, 1/s; (n, 0, 0) if the velocity update has none"""
    mass: np.ndarray
    """(n,) kg"""
    initial_volume: np.ndarray
    """(n,) V0, m³"""
    volume: np.ndarray
    """(n,) V = J V0, m³"""
    volume_ratio: np.ndarray
    """(n,) J"""
    half_size: np.ndarray
    """(n, dim) half side lengths of the particle domains of the shape function, m, by its own rule"""
    initial_half_size: np.ndarray | None
    """(n, dim) their initial values, m, if they follow from the total deformation"""
    least_half_size: np.ndarray | None
    """(n, dim) their lower limits, m, if they follow the strain step by step"""
    box: np.ndarray
    """(n, dim) half side lengths of the material's boxes, m, by the normal strain along each axis"""
    velocity_gradient: np.ndarray
    """(n, 3, 3) 1/s"""
    stress: np.ndarray
    """(n, 6) extra stress, Pa; the Cauchy stress is this minus the mapped pressure"""
    pressure: np.ndarray
    """(n,) pressure of the equation of state at the particle's own volume ratio, Pa"""
    mapped_pressure: np.ndarray
    """(n,) pressure after the volumetric treatment, Pa; it enters the internal force"""
    quadrature: np.ndarray
    """(n,) part of the volume of a particle that enters the internal force"""
    expansion: np.ndarray
    """(n,) d ln J per unit of shear that a redistribution has asked for"""
    deformation_gradient: np.ndarray | None
    """(n, 3, 3) F; None if nothing in the case needs it"""
    portion: np.ndarray
    """(n,) share of an initial particle: 1 at the start, halved by a split, summed by a merge"""
    age: np.ndarray
    """(n,) time since a particle came in, or since the start, s"""
    groups: list[Group] = field(default_factory=list)
    time: float = 0.0
    """s, at the start of the present step"""
    numbers_given: int = 0
    """Count of particle numbers used so far; numbers of removed particles are not used again"""

    def __len__(self) -> int:
        return len(self.number)

    @property
    def dim(self) -> int:
        return self.position.shape[1]

    @property
    def present_groups(self) -> list[Group]:
        """The groups that have particles; a material may not have come in yet."""
        return [group for group in self.groups if group.part.stop > group.part.start]

    def arrays(self) -> dict[str, np.ndarray]:
        """Every array with one entry per particle, by name."""
        return {name: value for name, value in vars(self).items() if isinstance(value, np.ndarray)}

    def state(self) -> State:
        """All arrays, and for each group its numbers, its part and the state of its law."""
        found = plain_state(self)
        for index, group in enumerate(self.groups):
            own = plain_state(group) | {"part/": np.array([group.part.start, group.part.stop])}
            own |= {f"law/{name}": array for name, array in group.state.items()}
            found |= {f"group/{index}/{name}": value for name, value in own.items()}
        return found

    def restore(self, state: State) -> None:
        """Restore a state of the same groups."""
        restore_plain(self, state)
        for index, group in enumerate(self.groups):
            prefix = f"group/{index}/"
            own = {key.removeprefix(prefix): v for key, v in state.items() if key.startswith(prefix)}
            restore_plain(group, own)
            start, stop = own["part/"]
            group.part = slice(int(start), int(stop))
            group.state = {name: own[f"law/{name}"].copy() for name in group.law.state}

    def take(self, index: np.ndarray) -> None:
        """Replace every array by its entries at ``index``, which must leave each group in its own part."""
        self._count_numbers()
        parts = [np.searchsorted(index, [group.part.start, group.part.stop]) for group in self.groups]
        for name, array in self.arrays().items():
            setattr(self, name, array[index])
        for group, (start, stop) in zip(self.groups, parts, strict=True):
            local = index[start:stop] - group.part.start
            group.state = {name: array[local] for name, array in group.state.items()}
            group.part = slice(int(start), int(stop))

    def add(self, index: int, new: Particles) -> None:
        """Add particles at the end of a group, with the state in which its law begins."""
        at, count = self.groups[index].part.stop, len(new)
        added = new.arrays()
        for name, array in self.arrays().items():
            setattr(self, name, np.concatenate([array[:at], added[name], array[at:]]))
        group = self.groups[index]
        start = initial_state(group.law, count)
        group.state = {name: np.concatenate([array, start[name]]) for name, array in group.state.items()}
        group.part = slice(group.part.start, at + count)
        for later in self.groups[index + 1 :]:
            later.part = slice(later.part.start + count, later.part.stop + count)

    def new_numbers(self, count: int) -> np.ndarray:
        """New particle numbers, never used before."""
        self._count_numbers()
        first = self.numbers_given
        self.numbers_given += count
        return np.arange(first, first + count)

    def _count_numbers(self) -> None:
        self.numbers_given = max(self.numbers_given, int(self.number.max(initial=-1)) + 1)

    def reorder(self, order: np.ndarray, scratch: np.ndarray) -> None:
        """Put the particles into a new order, which must leave each group in its own part.

        ``scratch`` is a flat array of doubles, as many as the widest array has.
        """
        for array in self.arrays().values():
            _permute(array, order, scratch)
        for group in self.groups:
            local = order[group.part] - group.part.start
            for array in group.state.values():
                array[...] = array[local]

    def kinematics(self, group: Group) -> Kinematics:
        """The particle data that are passed to the law of a group."""
        part, F = group.part, self.deformation_gradient
        return Kinematics(
            velocity_gradient=self.velocity_gradient[part],
            volume_ratio=self.volume_ratio[part],
            pressure=self.pressure[part],
            density=group.density,
            sound_speed=group.sound_speed,
            deformation_gradient=None if F is None else F[part],
            age=self.age[part] if group.law.needs_age else None,
            time=self.time,
        )

    def wave_speed(self, group: Group) -> float:
        """Fastest wave in the present state of a group, m/s. If the wave of the unstrained material is hardly
        slower, its speed is used, so that the step does not change all the time.

        Raises:
            PluginFault: the law returns no valid speed.
        """
        if group.part.start == group.part.stop:
            return group.wave_speed
        given = group.law.present_wave_speed(self.kinematics(group), group.state)
        speed = require_number(group.law, "present_wave_speed", given)
        if not speed >= 0:
            raise PluginFault(group.law, f"has a wave speed of {speed} m/s; it must not be negative")
        unstrained = group.wave_speed
        return speed if speed > STIFFER * unstrained else unstrained

    @property
    def nbytes(self) -> int:
        states = sum(array.nbytes for group in self.groups for array in group.state.values())
        return states + sum(array.nbytes for array in self.arrays().values())


def _permute(array: np.ndarray, order: np.ndarray, scratch: np.ndarray) -> None:
    if array.size == 0:
        return
    if not array.flags.c_contiguous:
        array[...] = array[order]
        return
    rows = array.reshape(len(array), -1)
    if array.itemsize == scratch.itemsize:  # one function moves numbers of both kinds
        rows = rows.view(scratch.dtype)
    sorted_rows = scratch.view(rows.dtype)[: array.size].reshape(rows.shape)
    permute(rows, order, sorted_rows)
    rows[...] = sorted_rows
