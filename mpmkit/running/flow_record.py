"""The flow data for the player of the page: few particles and few moments, selected during the run."""

from __future__ import annotations

import math

import numpy as np

from ..kernels.sums import kinetics
from ..kernels.tensors import shear_rate
from ..output.flow import Moment, arrays_of, moment_of, moments_of_arrays
from ..solver.particle_fields import added_fields, mean_pressure, yielded
from ..solver.simulation import Simulation
from ..solver.state_fields import state_fields
from ..solver.stateful import State, plain_state, restore_plain

MOMENTS = 100
"""Most moments that are kept."""
LOOKS = 400
"""Moments of a run that are checked."""
PARTICLES = 5000
"""Approximate number of particles kept of a moment; all if there are fewer."""
GOLDEN = (5**0.5 - 1) / 2
STANDSTILL = 0.15
"""Change assigned to a whole run of material at rest."""
LEAST = 0.009
"""Least change for a new moment; a moment costs as much as a step of a few particles."""


class FlowRecord:
    """Moments of the flow, closer together in time when the material moves fast.

    The *change* between two moments is the RMS displacement of the particles over the height of the bodies,
    plus a small part for the elapsed time. A check keeps a moment if the change since the last one, estimated
    by the RMS speed, may be ``LEAST``. If there are too many moments, the one with the least change around it
    is removed. Which particles are kept depends on their numbers alone, and those are spread
    evenly: a particle has the same number through the run, and what a split adds is thinned as the rest.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._height = simulation.case.height
        self._until = simulation.case.end
        self._share = 1.0
        self._last = -1
        """step of the last moment"""
        self._speed = 0.0
        """RMS speed at the last look, m/s"""
        self.moments: list[Moment] = []
        self._changes: list[float] = []
        """between each moment and the next"""

    def state(self) -> State:
        """The moments so far, and the changes between them."""
        own = plain_state(self, but=("_height", "_until"))
        found = own | {"changes/": np.array(self._changes)}
        return found | {f"moments/{name}": array for name, array in arrays_of(self.moments).items()}

    def restore(self, state: State) -> None:
        """Restore them."""
        restore_plain(self, state)
        self._changes = state["changes/"].tolist()
        moments = {name.partition("/")[2]: array for name, array in state.items() if "moments/" in name}
        self.moments = [
            moment.copied() for moment in moments_of_arrays(moments)
        ]  # of a state that may change

    def look(self, simulation: Simulation) -> None:
        """Add the present step if enough may have changed since the last moment."""
        if not len(simulation.particles):
            return
        mass, doubled, _ = kinetics(simulation.particles.mass, simulation.particles.velocity)
        before, self._speed = self._speed, math.sqrt(doubled / mass)
        if self.moments:
            passed = simulation.time - self.moments[-1].time
            moved = max(before, self._speed) * passed / self._height
            if moved + STANDSTILL * passed / self._until < LEAST:  # NaN is kept
                return
        self.add(simulation)

    def add(self, simulation: Simulation) -> None:
        """Add the present step if it is new; another moment may be removed for it."""
        if self._last == simulation.steps or not len(simulation.particles):
            return
        self._last = simulation.steps
        self.moments.append(self._moment(simulation))
        if len(self.moments) > 1:
            self._changes.append(self._change(*self.moments[-2:]))
        if len(self.moments) > MOMENTS:
            self._drop_the_least()

    def _moment(self, simulation: Simulation) -> Moment:
        p, grid = simulation.particles, simulation.grid
        kept = self._kept(p.number)
        if not kept.any():
            kept[:1] = True
        squared = np.einsum("pi,pi->p", p.velocity, p.velocity)
        fields = {
            "number": p.number,
            "body": p.body,
            "yielded": yielded(p),
            "position": p.position + grid.lower,
            "half_size": p.box,
            "speed": np.sqrt(squared),
            "shear_rate": shear_rate(p.velocity_gradient),
            "pressure": mean_pressure(p),
        }
        with simulation.blaming:
            added = state_fields(p) | added_fields(simulation)
        numbers = {name: field for name, field in added.items() if field.ndim == 1}
        if not kept.all():
            fields = {name: field[kept] for name, field in fields.items()}
            numbers = {name: field[kept] for name, field in numbers.items()}
        return moment_of(simulation.time, self._share, fields, numbers)

    def _kept(self, number: np.ndarray) -> np.ndarray:
        """Which particles are kept, by their numbers; after many splits, a smaller share is kept."""
        if self._share * len(number) > 2 * PARTICLES or not self.moments:
            self._share = min(1.0, PARTICLES / len(number))
        return (number * GOLDEN) % 1.0 < self._share

    def _change(self, before: Moment, after: Moment) -> float:
        passed = (after.time - before.time) / self._until
        a, b = before.position, after.position
        if not np.array_equal(before.number, after.number):
            _, of_a, of_b = np.intersect1d(
                before.number, after.number, assume_unique=True, return_indices=True
            )
            a, b = a[of_a], b[of_b]
        with np.errstate(over="ignore", invalid="ignore"):
            moved = b - a
            rms = np.sqrt(np.einsum("pi,pi->", moved, moved) / max(len(moved), 1))
        # A diverging run has no finite displacement: keep its moments; a guard will stop the run.
        return STANDSTILL * passed + (float(rms) / self._height if np.isfinite(rms) else 1.0)

    def _drop_the_least(self) -> None:
        around = np.array(self._changes[:-1]) + np.array(self._changes[1:])
        least = int(np.argmin(around))
        del self.moments[least + 1]
        self._changes[least : least + 2] = [float(around[least])]
