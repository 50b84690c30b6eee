"""The particles: a structure of arrays, in groups of one material. Splitting alone replaces the arrays."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..contracts import ConstitutiveLaw, EquationOfState, Motion
from ..kernels.sort import permute


@dataclass
class Group:
    """Particles of one material: a contiguous stretch ``part`` of every array, with the state of its law."""

    law: ConstitutiveLaw
    equation_of_state: EquationOfState
    density: float
    sound_speed: float | None
    """m/s, of the equation of state, at present"""
    mach: float | None
    """largest Mach number, where the sound speed is to follow the flow"""
    part: slice
    state: dict[str, np.ndarray]

    @property
    def wave_speed(self) -> float:
        """Fastest wave of the law, m/s."""
        return self.law.wave_speed(self.density, self.sound_speed)

    @property
    def remarks(self) -> list[str]:
        """What the law has to say of itself in this material."""
        return self.law.remarks(self.density, self.sound_speed)

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
    """(n,) what a particle is called, from first to last however the arrays are sorted."""
    body: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    affine: np.ndarray
    """(n, dim, dim) affine part of the velocity, 1/s; (n, 0, 0) where the velocity update keeps none"""
    mass: np.ndarray
    initial_volume: np.ndarray
    volume: np.ndarray
    volume_ratio: np.ndarray
    half_size: np.ndarray
    """(n, dim) half side lengths of the domains that the shape function sees, by its own rule"""
    initial_half_size: np.ndarray | None
    """(n, dim) what they were, where they follow from the deformation as a whole"""
    least_half_size: np.ndarray | None
    """(n, dim) what they never fall below, where they follow the strain step by step"""
    box: np.ndarray
    """(n, dim) half side lengths of the material's boxes, m, by the normal strain along each axis"""
    velocity_gradient: np.ndarray
    stress: np.ndarray
    """(n, 6) the extra stress; the Cauchy stress is this minus the mapped pressure."""
    pressure: np.ndarray
    """(n,) of the equation of state at the particle's own volume ratio"""
    mapped_pressure: np.ndarray
    """(n,) what the volumetric treatment makes of it: the pressure that enters the internal force"""
    quadrature: np.ndarray
    """(n,) part of its volume with which a particle enters the internal force"""
    deformation_gradient: np.ndarray | None
    groups: list[Group] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.number)

    @property
    def dim(self) -> int:
        return self.position.shape[1]

    def arrays(self) -> dict[str, np.ndarray]:
        """Every array that has an entry a particle, by name."""
        return {name: value for name, value in vars(self).items() if isinstance(value, np.ndarray)}

    def take(self, index: np.ndarray) -> None:
        """Replace every array by its entries at ``index``, which must leave each group in its own part."""
        parts = [np.searchsorted(index, [group.part.start, group.part.stop]) for group in self.groups]
        for name, array in self.arrays().items():
            setattr(self, name, array[index])
        for group, (start, stop) in zip(self.groups, parts, strict=True):
            local = index[start:stop] - group.part.start
            group.state = {name: array[local] for name, array in group.state.items()}
            group.part = slice(int(start), int(stop))

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

    def motion(self, group: Group) -> Motion:
        """What the law of a group is told of its particles."""
        part, F = group.part, self.deformation_gradient
        return Motion(
            velocity_gradient=self.velocity_gradient[part],
            volume_ratio=self.volume_ratio[part],
            pressure=self.pressure[part],
            density=group.density,
            sound_speed=group.sound_speed,
            deformation_gradient=None if F is None else F[part],
        )

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
    sorted_rows = scratch.view(array.dtype)[: array.size].reshape(rows.shape)
    permute(rows, order, sorted_rows)
    rows[...] = sorted_rows
