"""Relaxation of volume ratios J towards grid averages: only here do positions of particles change J."""

from __future__ import annotations

import math

import numpy as np

from ..case.scheme import Scheme
from ..errors import PluginFault
from ..kernels import domains, nodes, volumes
from .averager import Averager
from .node_volumes import node_volumes
from .particles import Group, Particles
from .stateful import State, plain_state, restore_plain

WORTH = 0.05
"""Relaxation waits until this part of the departures of J is due: an average costs a tenth of a step, and
such small corrections can be made together."""
CROWDED = 0.02
"""Allowed excess of the crowding: boxes do not tile a body exactly."""
MOST = 1.02
"""Upper limit of the crowding. One or two per cent correspond to the pressure of the flow itself, ρ v² at a
Mach number of 0.1. Larger values, where boxes overlap for some reason, would throw particles apart."""


class Relaxation:
    """J ← J + (1 - exp(-∫ rate dt)) (A J - J), with A the average over a material by initial volume.

    The integral is over the time since the last relaxation; it is applied when it reaches ``WORTH``. A is
    symmetric in the initial volumes and its rows sum to one, so that Σ V0 J is kept, and for any convex
    energy Σ V0 e(J) does not grow. Each material is averaged separately: at the same pressure, two materials
    have different volume ratios.

    If a node has more material than its volume, J relaxes to the average divided by the crowding κ,

        κ = Σ V_p N_np / ((1 + CROWDED) V_n),   from 1 to MOST,

    i.e. to the available volume: the particles are too close, even if their strain rates do not show it.
    Only the part of V_p within reach of the weights counts, so that boxes longer than a cell, between
    which the material is torn, do not add to the crowding. Boxes of constant size give no information.

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
        """Advance by a step, at the rate, 1/s, of the volumetric treatment.

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
    """κ of every node of the window, ``(nodes,)``, if boxes follow the material."""
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
