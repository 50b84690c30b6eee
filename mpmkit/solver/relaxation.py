"""Volume ratios tend to values from the grid: only here do the positions of particles change J."""

from __future__ import annotations

import math

import numpy as np

from ..case.model import Scheme
from ..errors import PluginFault
from ..kernels import domains, nodes, volumes
from .averager import Averager
from .node_volumes import node_volumes
from .particles import Group, Particles
from .stateful import State, plain_state, restore_plain

WORTH = 0.05
"""Part of the departures of J that is due to go before any goes: so little may as well go at once, and to
average costs a tenth of a step."""
CROWDED = 0.02
"""Part by which a node may be too full before it counts: boxes do not quite tile what they fill."""
MOST = 1.02
"""Crowding that counts at most. A per cent or two has the pressure of the flow itself, ρ v² at a Mach number
of 0.1; more, where boxes lie over each other for whatever reason, would throw them apart."""


class Relaxation:
    """J ← J + (1 - exp(-∫ rate dt)) (A J - J), with A the average over a material by initial volume.

    The integral is over the time since the last one, which was when it had come to ``WORTH``. A is symmetric
    in the initial volumes and its rows sum to one, so that Σ V0 J is kept, and for any convex energy
    Σ V0 e(J) does not grow. Each material is averaged by itself: at one pressure, two of them have two volume
    ratios.

    Where a node has more material on it than room, J is drawn to the average over the crowding κ instead,

        κ = Σ V_p N_np / ((1 + CROWDED) V_n),   from 1 to MOST,

    towards the volume there is: particles have come too close, whatever their rates say that they have done.
    Of V_p counts what is within reach of the weights, so that boxes drawn out longer than a cell, between
    which material is torn, crowd nothing; boxes that stay as they are tell nothing.

    Attributes:
        due: the integral so far.
    """

    def __init__(self, scheme: Scheme, radial: bool) -> None:
        self.due = 0.0
        self._treatment = scheme.volumetric
        self._boxes_tell = scheme.shape.particle_domain != "fixed"
        self._radial = radial

    def state(self) -> State:
        """``due``."""
        return plain_state(self)

    def restore(self, state: State) -> None:
        """Take ``due`` back."""
        restore_plain(self, state)

    def relax(self, averager: Averager, rate: float, dt: float) -> None:
        """Go on by a step, at the rate, 1/s, that the treatment asks for.

        Raises:
            PluginFault: the rate is not a number of at least 0.
        """
        if not rate >= 0:
            raise PluginFault(self._treatment, f"has a relaxation rate of {rate} /s; it must be positive")
        self.due += rate * dt
        if self.due < WORTH:
            return
        part, self.due = -math.expm1(-self.due), 0.0
        p = averager.particles
        crowding = find_crowding(averager, self._radial) if self._boxes_tell else None
        for group in p.groups:
            if group.law.uses_equation_of_state:
                averager.at_nodes(p.volume_ratio, _only(p, group), crowding)
                mean = averager.at_particles()
                volumes.draw(p.volume_ratio[group.part], mean[group.part], part)


def find_crowding(averager: Averager, radial: bool) -> np.ndarray:
    """κ of every node of the window, ``(nodes,)``, for boxes that follow the material."""
    p, window = averager.particles, averager.window
    within = np.empty(len(p))
    domains.volume_within_reach(p.volume, p.half_size, window.grid.cell_size, within)
    averager.sums(within, within)
    room = (1 + CROWDED) * node_volumes(window, radial)
    crowding = np.ones(len(room))
    nodes.find_crowding(window.pairs, room, MOST, crowding, *averager.sorting.active.arguments)
    return crowding


def _only(p: Particles, group: Group) -> np.ndarray:
    """Initial volumes of a material, zero for the others."""
    if len(p.groups) == 1:
        return p.initial_volume
    weights = np.zeros(len(p))
    weights[group.part] = p.initial_volume[group.part]
    return weights
