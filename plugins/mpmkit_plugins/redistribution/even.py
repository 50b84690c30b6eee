"""Keeps volume, box and position of sheared particles consistent."""

import math

import numpy as np
from numba import prange

from mpmkit.contracts import Cells, Redistributing, Redistribution, hookimpl
from mpmkit.kernels.compile import CHUNK, chunk_count, inline, kernel

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
UNEVEN, DIFFUSION, ORDERED = 0.05, 0.5, 3.0
"""In 3-D: |κ_f - 1| from which particles walk at random (compression under gravity is less); diffusivity over
γ̇ h² and the part above; shear of a particle after which the walk ends."""
LONGEST = 0.2
"""Longest shift and longest step of the walk along an axis, over the spacing of the particles."""
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
        in 3-D a random walk of diffusivity 0.5 γ̇ h² (|κ_f - 1| - 0.05), until a particle has sheared by 3,
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
    """-2 γ̇ dt h² ∇(κ_f - 1), and in 3-D the random walk, ``(n, dim)``, m."""
    fine, h = ops.places, ops.places.spacing
    departure = np.clip(fine.crowding() - 1, -1.0, 1.0)
    departure[(departure < 0) & ~fine.nearest(ops.nodes, inside)] = 0.0
    uneven = fine.at_particles(np.abs(departure)) if ops.dim == 3 else None
    shift = fine.slope_at_particles(departure)
    sheared = time * ops.nodes.at_particles(rate)
    surface = ops.nodes.slope_at_particles(crowding), ops.nodes.at_particles(crowding), ops.nodes.spacing
    _scale(shift, sheared, h, *surface)
    if uneven is not None:
        diffusivity = np.where(ops.past_shear() < ORDERED, DIFFUSION * np.maximum(uneven - UNEVEN, 0.0), 0.0)
        _walk(shift, ops.random(), diffusivity * sheared, h, *surface)
    return shift


@inline()
def _steepness(slope, spacing, crowding, p):
    """|∇κ|² over a cell near the surface, elsewhere 0."""
    steepness = 0.0
    for d in range(slope.shape[1]):
        steepness += (spacing * slope[p, d]) ** 2
    return steepness if steepness > STEEP**2 or crowding[p] < LOOSE else 0.0


@kernel()
def _scale(shift, sheared, h, slope, crowding, spacing):
    """Turn ∇κ_f into the shift; near the surface it has no part down the crowding.

    Args:
        shift: ``(n, dim)``, ∇κ_f, 1/m, becomes the shift, m; its largest component is at most ``LONGEST`` h.
        sheared: ``(n,)``, γ̇ dt.
        h, spacing: m, of the particles and of the nodes.
        slope, crowding: ``(n, dim)``, 1/m, and ``(n,)``: ∇κ and κ of the nodes.
    """
    n, dim = shift.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            drawn, outwards = -RATE * sheared[p] * h * h, 0.0
            for d in range(dim):
                outwards += drawn * shift[p, d] * spacing * slope[p, d]
            near = _steepness(slope, spacing, crowding, p)
            taken = min(outwards, 0.0) / near if near > 0 else 0.0
            most = 0.0
            for d in range(dim):
                shift[p, d] = drawn * shift[p, d] - taken * spacing * slope[p, d]
                most = max(most, abs(shift[p, d]))
            part = min(1.0, LONGEST * h / max(most, 1e-300))
            for d in range(dim):
                shift[p, d] *= part


@kernel()
def _walk(shift, random, spread, h, slope, crowding, spacing):
    """Add the step √(6 D dt) of the random walk to the shift, ``(n, dim)``, m.

    Near the surface it has no part across it in either direction: a walk that goes only inwards would move
    the surface.

    Args:
        random: ``(n, dim)``, from -1 to 1.
        spread: ``(n,)``, D dt / h².
        h, slope, crowding, spacing: as for ``_scale``.
    """
    n, dim = shift.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            step = h * min(LONGEST, math.sqrt(6 * spread[p]))
            along = 0.0
            for d in range(dim):
                along += step * random[p, d] * spacing * slope[p, d]
            near = _steepness(slope, spacing, crowding, p)
            taken = along / near if near > 0 else 0.0
            for d in range(dim):
                shift[p, d] += step * random[p, d] - taken * spacing * slope[p, d]


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
