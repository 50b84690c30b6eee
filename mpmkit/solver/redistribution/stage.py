"""The particles of a scene for a redistribution, and the times when it acts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...case.scheme import Scheme
from ...contracts import redistribution as contract
from ...errors import PluginFault
from ...kernels import domains, shifts, sums, volumes
from ...kernels.compile import chunk_count
from ...kernels.nodes import OPEN, PERIODIC
from ...kernels.randoms import uniform
from ...kernels.splines import SUPPORT
from ...kernels.tensors import shear_rate
from ...registry import audit
from ..energies import compressive_energy, kinetic_energy, potential_energy, strain_energy
from ..grid import Grid, Window
from ..particles import Particles
from ..sorting import Sorting
from ..stateful import State
from ..walls import Walls
from .cells import BoxCells
from .lattice import SplineLattice
from .mirrored import Mirrored

OVER_MEAN = 2.0
"""The shear rate is limited to this multiple of the largest mean rate since the last redistribution. A flow
that grows linearly from rest reaches this ratio; an impact after a free flight would reach hundreds."""
SCALARS = ("shear", "elapsed", "energy", "rate", "expanding")
AT_A_WALL = 1e-6
"""Distance, in cells, that a shift keeps from a wall."""


def redistributes(author: contract.Redistribution) -> bool:
    """Whether a redistribution can ever be due; one that does not override ``is_due`` never is."""
    return type(author).is_due is not contract.Redistribution.is_due


class Stage:
    """Implements the contract ``Redistributing`` for the fluids of one scene.

    Solids keep their boxes and positions; their volume counts in the crowding. Arrays from the redistribution
    are checked here: PluginFault if one has the wrong shape, or is not finite.

    Attributes:
        acts: whether the redistribution can ever be due; otherwise shear is not summed up.
        shear: largest ∫ γ̇ dt since the last redistribution, 1.
        elapsed: s, since then.
        rate: largest γ̇ in the last step, 1/s.
        expanding: shear, 1, over which the present expansions still act.
        energy: J, energy added by all redistributions so far (negative: removed): the work of expansions, and
            the changes of kinetic, strain, compressive and potential energy at each redistribution.
            Potential energy is that of the history: it has no part along a periodic axis.
        momentum: N s, ``(dim,)``, momentum added by them. Shifts conserve momentum up to rounding, except at
            moving walls.
    """

    nodes: contract.Lattice
    places: contract.Lattice

    def __init__(
        self,
        scheme: Scheme,
        grid: Grid,
        walls: Walls,
        particles: Particles,
        radial: bool,
        gravity: np.ndarray,
        spacing: float,
    ) -> None:
        """``spacing``: m, of particles that come in; used if there are none yet."""
        self.redistribution = scheme.redistribution
        self.acts = redistributes(scheme.redistribution)
        self.shear = self.elapsed = self.energy = self.rate = self.expanding = 0.0
        self.momentum = np.zeros(grid.dim)
        self._blocks: dict[tuple, Mirrored] = {}
        self._downwards = np.where(grid.periodic, 0.0, gravity)
        self._follows = scheme.shape.particle_domain != "fixed"
        self._grid, self._walls = grid, walls
        self._particles, self._radial = particles, radial
        self._times = max(1, round(grid.cell_size / (self._typical_spacing() if len(particles) else spacing)))

    def state(self) -> State:
        return {name: np.array(getattr(self, name)) for name in (*SCALARS, "momentum")}

    def restore(self, state: State) -> None:
        for name in SCALARS:
            setattr(self, name, float(state[name]))
        self.momentum = state["momentum"].copy()
        self._blocks = {}

    def _typical_spacing(self) -> float:
        """m, typical distance between particles."""
        return float(np.median(self._sizes())) ** (1 / self._grid.dim)

    def _sizes(self) -> np.ndarray:
        """Volumes, ``(n,)``; in axisymmetric scenes areas, so that the axis needs no special treatment."""
        p = self._particles
        return p.volume / (2 * np.pi * p.position[:, 0]) if self._radial else p.volume

    # --- Every step

    def stretch(self, volumetric_rate: np.ndarray, dt: float) -> None:
        """Update J and V with the volumetric rate tr L, 1/s, and with the expansions that are due.

        The largest shear rate is that of the step before: the present one is found after the volumes.
        """
        p = self._particles
        shear = min(dt * self.rate, self.expanding)
        if shear == 0:
            volumes.stretch(volumetric_rate, dt, p.initial_volume, p.volume_ratio, p.volume)
            return
        energy = np.empty(chunk_count(len(p)))
        volumes.stretch_and_expand(
            volumetric_rate, dt, p.expansion, shear, p.pressure, p.initial_volume, p.volume_ratio, p.volume,
            energy,
        )  # fmt: skip
        self.expanding -= shear
        self.energy += float(energy.sum())

    def follow(self, dt: float) -> None:
        """Adjust boxes of fluids to their volume if boxes have equal sides, and sum up the shear."""
        most = 0.0
        if self.redistribution.equal_boxes:
            most = max(map(self._hold_volume, self._fluids()), default=0.0)
        elif self.acts:
            rates = (shear_rate(self._particles.velocity_gradient[part]) for part in self._fluids())
            most = max((float(rate.max()) for rate in rates), default=0.0)
        if self.acts:
            self.rate = most
            self.shear += dt * most
            self.elapsed += dt

    def _hold_volume(self, part: slice) -> float:
        """Adjust boxes of a fluid to their volume; return its largest shear rate, 1/s."""
        p = self._particles
        largest = np.empty(chunk_count(part.stop - part.start))
        domains.hold_volume(
            p.velocity_gradient[part], p.volume[part], p.position[part], self._radial,
            p.box[part], p.half_size[part], self._follows, largest,
        )  # fmt: skip
        return float(largest.max(initial=0.0))

    def lend(self, base: np.ndarray, tables: np.ndarray) -> None:
        """Memory that a redistribution may overwrite: ``(n, dim)`` integers of 32 bits, and doubles."""
        self._lent = base, tables

    def redistribute_if_due(self, window: Window, sorting: Sorting) -> bool:
        """Redistribute if the summed shear requires it; return whether it did. Particles must be sorted.

        The tables of the last step are overwritten.
        """
        author = self.redistribution
        if not self.acts or not audit.require_truth(author, "is_due", author.is_due(self.shear)):
            return False
        position, size = self._particles.position, np.ascontiguousarray(self._sizes())
        self._window, self._tasks = window, sorting.tasks
        base, memory = self._lent
        needed = 2 * SUPPORT * position.size
        memory = memory[:needed] if len(memory) >= needed else np.empty(needed)
        weights = memory.reshape(2, *position.shape, SUPPORT)
        self._splines = self.nodes = self._lattice(1, position, size, base, weights[0])
        self.places = self._lattice(self._times, position, size, np.empty_like(base), weights[1])
        before, momentum = self._energy_of_particles(), self._momentum_of_particles()
        author.redistribute(self, self.elapsed)
        self.energy += self._energy_of_particles() - before
        self.momentum += self._momentum_of_particles() - momentum
        del self.nodes, self.places, self._splines, self._window, self._tasks
        self.shear = self.elapsed = 0.0
        return True

    def _energy_of_particles(self) -> float:
        p = self._particles
        stored = strain_energy(p) + compressive_energy(p)
        return kinetic_energy(p) + stored + potential_energy(p, self._downwards)

    def _momentum_of_particles(self) -> np.ndarray:
        p = self._particles
        return np.array([sums.moment(p.mass, p.velocity, along) for along in np.eye(p.dim)])

    def _lattice(self, times: int, *arrays: np.ndarray) -> SplineLattice:
        return SplineLattice(self._block(times, centred=False), self._tasks, *arrays)

    def _block(self, times: int, centred: bool) -> Mirrored:
        """The block over the window, kept for as long as the window stays where it is."""
        window = self._window
        where = (*window.lower.tolist(), *window.shape)
        key = (*where, times, centred)
        if key not in self._blocks:
            self._blocks = {
                known: block for known, block in self._blocks.items() if known[: len(where)] == where
            }
            self._blocks[key] = Mirrored(self._grid, window, times, centred)
            self._leave_room(self._blocks[key])
        elif self._walls.moving:
            self._leave_room(self._blocks[key])
        return self._blocks[key]

    def _leave_room(self, block: Mirrored) -> None:
        """Reduce the volumes of a block by the parts behind walls that are not faces of the grid."""
        if len(self._walls):
            block.leave(self._walls.room(block.places(), block.spacing, block.centred))

    # --- For the redistribution

    @property
    def time(self) -> float:
        return self._particles.time

    def shear_rate(self) -> np.ndarray:
        rate = shear_rate(self._particles.velocity_gradient)
        return np.minimum(rate, OVER_MEAN * self.shear / self.elapsed) if self.elapsed > 0 else rate

    def random(self) -> np.ndarray:
        p = self._particles
        return uniform(p.number, p.time, p.dim)

    def cells(self) -> contract.Cells:
        p = self._particles
        return BoxCells(
            self._block(1, centred=True), self._tasks, p.position, p.box, np.ascontiguousarray(self._sizes())
        )

    def scale_volume_ratio(self, factor: np.ndarray) -> None:
        p = self._particles
        self._require(factor, "a factor of J", (len(p),))
        if factor.min() <= 0:
            raise PluginFault(
                self.redistribution, f"gave {factor.min():.4g} as a factor of J; it must be above 0"
            )
        for part in self._fluids():
            p.volume_ratio[part] *= factor[part]
            p.volume[part] = p.initial_volume[part] * p.volume_ratio[part]

    def expand(self, strain: np.ndarray) -> None:
        p = self._particles
        self._require(strain, "a strain of volume", (len(p),))
        for part in self._fluids():
            p.expansion[part] = strain[part] / self.shear
        self.expanding = self.shear

    def shift(self, displacement: np.ndarray) -> None:
        p = self._particles
        self._require(displacement, "a displacement", p.position.shape)
        displacement = np.array(displacement, dtype=np.float64)
        if self._radial:  # the area V/(2 π r) has no limit at the axis: no box is shifted across it
            radius = p.position[:, 0]
            np.maximum(displacement[:, 0], np.minimum(p.box[:, 0] - radius, 0.0), out=displacement[:, 0])
        low, high = self._kept_inside()
        change = np.zeros((len(p), p.affine.shape[1]))
        for part in self._fluids():
            shifts.shift(p.position[part], displacement[part], low, high, p.affine[part], change[part])
        if p.affine.shape[1]:
            # Momentum added to a node is taken from its neighbours, so that the sum is conserved.
            for axis, average in enumerate(self._splines.averages(change, p.mass)):
                p.velocity[:, axis] += change[:, axis] - self._splines.at_particles(average)

    def _kept_inside(self) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest positions, m, along each axis: off the walls, and not out of an open face; only
        the flow carries material through it."""
        grid, margin = self._grid, AT_A_WALL * self._grid.cell_size
        away = np.where(grid.faces == OPEN, 0.0, np.where(grid.faces == PERIODIC, -np.inf, margin))
        return away[:, 0], grid.extent - away[:, 1]

    def weigh(self, factor: np.ndarray) -> None:
        self._require(factor, "a weight", (len(self._particles),))
        if factor.min() < 0:
            raise PluginFault(
                self.redistribution, f"gave {factor.min():.4g} as a weight; it must be at least 0"
            )
        for part in self._fluids():
            self._particles.quadrature[part] = factor[part]

    def _require(self, given: np.ndarray, what: str, shape: tuple[int, ...]) -> None:
        """Raise PluginFault unless the array from the redistribution has this shape and finite numbers."""
        p, author = self._particles, self.redistribution
        whole = isinstance(given, np.ndarray) and given.dtype.kind != "f"
        found = audit.described(given) + (f" of {given.dtype}" if whole else "")
        if not isinstance(given, np.ndarray) or given.shape != shape or given.dtype.kind != "f":
            raise PluginFault(
                author, f"gave {found} as {what}; it must be an array of shape {shape} of float64"
            )
        audit.require_finite(author, what, given, p.number, self._arguments())

    def _arguments(self) -> Iterator[np.ndarray]:
        """What a redistribution is given; not finite where the run has diverged and J is not positive."""
        p = self._particles
        yield from (p.position, p.volume, p.velocity_gradient)
        yield np.where(p.volume_ratio > 0, 0.0, np.nan)

    def _fluids(self) -> list[slice]:
        return [group.part for group in self._particles.present_groups if group.law.uses_equation_of_state]
