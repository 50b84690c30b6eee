"""Keeps volume, box and position of sheared particles consistent."""

import math

import numpy as np
from numba import prange

from mpmkit.contracts import Cells, Redistributing, Redistribution, hookimpl
from mpmkit.kernels.compile import CHUNK, chunk_count, kernel

DUE = 0.1
"""Shear ∫ γ̇ dt between two corrections."""
FULL = 0.75
"""Least crowding of a full node; a full node whose neighbours are all full is inside."""
CROWDED = 1.05
"""Crowding that is tolerated at nodes that are not inside."""
MOST = 0.4
"""Limit of |ln κ| in corrections, so that particles on top of each other are not thrown apart."""
RATE = 2.0
"""Rate of the corrections over γ̇: the factor 2 of d ln J/dt and of dx/dt below."""
STEEP, LOOSE = 0.25, 0.8
"""At the surface, the crowding changes by more than ``STEEP`` over a cell, or is below ``LOOSE``."""
UNEVEN, DIFFUSION = 0.4, 0.5
"""In 3-D: |κ_f - 1| above which particles walk at random; diffusivity, over γ̇ h² and the part above."""
LONGEST = 0.2
"""Longest shift, over the spacing of the particles."""
EMPTY, LEAST, LARGEST = 0.5, 0.5, 2.0
"""A cell with a filling below ``EMPTY`` is at the surface; the others bound divisors and weights."""
PASSES = 3
"""Passes of the weights; more amplify noise where nearly every box lies across a face between cells."""


class Even(Redistribution):
    """Boxes have equal sides, J follows the available room, and particles are kept evenly spaced.

    All rates are proportional to the shear rate γ̇, so nothing happens at rest or in rigid motion, and the
    step has no influence. With the crowding κ of the grid's nodes and κ_f of a lattice as fine as the
    particles' spacing h:

        d ln J/dt = -2 γ̇ ln κ inside, and -2 γ̇ ln(κ/1.05) elsewhere where κ > 1.05,
        dx/dt = -2 γ̇ h² ∇κ_f, with κ_f < 1 only inside, and without a component out of the surface,
        in 3-D a random walk of diffusivity 0.5 γ̇ h² (|κ_f - 1| - 0.4) where |κ_f - 1| > 0.4,
        V of the internal force ← w V, with weights w that fill each full cell, Σ_p w_p V_p part_pc = V_c.
    """

    name = "even"
    api_version = 2
    citation = (
        "shift after Lind, Xu, Stansby & Rogers, J. Comput. Phys. 231 (2012) 1499-1523; quadrature errors: "
        "Baumgarten & Kamrin, Int. J. Numer. Meth. Eng. 124 (2023), doi:10.1002/nme.7217"
    )
    equal_boxes = True

    def is_due(self, shear: float) -> bool:
        return shear >= DUE

    def redistribute(self, ops: Redistributing, time: float) -> None:
        crowding = ops.nodes.crowding()
        inside = ops.nodes.least_around(crowding) >= FULL
        rate = ops.nodes.average(ops.shear_rate())
        shift = _shift(ops, crowding, inside, rate, time)
        ops.expand(-RATE * time * ops.nodes.at_particles(rate * _excess(crowding, inside)))
        ops.shift(shift)
        ops.weigh(_weights(ops))


def _excess(crowding: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """ln κ at nodes inside, and of others what is above ``CROWDED``."""
    some = np.log(np.maximum(crowding, 0.5))
    beyond = np.maximum(some - np.log(CROWDED), 0.0)
    return np.clip(np.where(inside, some, beyond), -MOST, MOST)


def _shift(
    ops: Redistributing, crowding: np.ndarray, inside: np.ndarray, rate: np.ndarray, time: float
) -> np.ndarray:
    """-2 γ̇ dt h² ∇(κ_f - 1) and the random walk, ``(n, dim)``, m."""
    fine, h = ops.places, ops.places.spacing
    departure = np.clip(fine.crowding() - 1, -1.0, 1.0)
    excess = np.maximum(fine.at_particles(np.abs(departure)) - UNEVEN, 0.0)
    departure[(departure < 0) & ~fine.nearest(ops.nodes, inside)] = 0.0
    shift = fine.slope_at_particles(departure)
    if shift.shape[1] < 3:
        excess[:] = 0.0
    sheared = time * ops.nodes.at_particles(rate)
    slope, there = ops.nodes.slope_at_particles(crowding), ops.nodes.at_particles(crowding)
    _displace(sheared, excess, h, slope, there, ops.nodes.spacing, ops.random(), shift)
    return shift


@kernel()
def _displace(sheared, excess, h, slope, crowding, spacing, random, shift):
    """Turn ∇κ_f into the shift: scale it, add the random walk, and leave out parts near the surface.

    Near the surface, the shift has no part down the crowding, and the walk has no part across the surface in
    either direction: a walk that goes only inwards would move the surface.

    Args:
        sheared, excess: ``(n,)``, γ̇ dt, and the part of |κ_f - 1| above ``UNEVEN``.
        h, spacing: m, of the particles and of the nodes.
        slope, crowding: ``(n, dim)``, 1/m, and ``(n,)``: ∇κ and κ of the nodes.
        random: ``(n, dim)``, from -1 to 1.
        shift: ``(n, dim)``, ∇κ_f, 1/m, becomes the shift, m; its largest component is at most ``LONGEST`` h.
    """
    n, dim = shift.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            drawn, walk = -RATE * sheared[p] * h * h, math.sqrt(6 * DIFFUSION * excess[p] * sheared[p]) * h
            steepness = outwards = along = 0.0
            for d in range(dim):
                steep = spacing * slope[p, d]
                steepness += steep * steep
                outwards += drawn * shift[p, d] * steep
                along += walk * random[p, d] * steep
            near = steepness > STEEP**2 or crowding[p] < LOOSE
            taken = (min(outwards, 0.0) + along) / max(steepness, 1e-300) if near else 0.0
            most = 0.0
            for d in range(dim):
                shift[p, d] = drawn * shift[p, d] + walk * random[p, d] - taken * spacing * slope[p, d]
                most = max(most, abs(shift[p, d]))
            part = min(1.0, LONGEST * h / max(most, 1e-300))
            for d in range(dim):
                shift[p, d] *= part


def _weights(ops: Redistributing) -> np.ndarray:
    """w with Q_c(w) = Σ_p w_p V_p part_pc / V_c = 1 in full cells, by passes of w ← w Σ_c part_pc / Q_c(w).

    One pass leaves about half of the error where most boxes lie across the faces of cells: each of these gets
    the mean of what its two cells need.
    """
    cells = ops.cells()
    filling = cells.filling()
    full = cells.least_beside(filling) > EMPTY
    weights = _share(cells, filling, full)
    for _ in range(PASSES - 1):
        weights *= _share(cells, cells.filling(weights), full)
    return np.clip(weights, LEAST, LARGEST)


def _share(cells: Cells, filling: np.ndarray, full: np.ndarray) -> np.ndarray:
    """Σ_c part_pc / Q_c, with Q_c = 1 at the surface."""
    return cells.at_particles(1 / np.clip(np.where(full, filling, 1.0), LEAST, LARGEST))


@hookimpl
def mpmkit_redistributions():
    return [Even]
