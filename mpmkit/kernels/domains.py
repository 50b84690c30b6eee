"""How the half-sizes of the particle domains follow the deformation."""

from __future__ import annotations

import math

from numba import prange

from .compile import CHUNK, chunk_count, inline, kernel
from .elementary import cube_root
from .tensors import squares_of_shear


@kernel()
def follow_strain(L, dt, box, least, half_size):
    """l_i ← l_i (1 + Δt D_ii), ``(n, dim)``, m: the box follows the normal strain along each axis.

    The half-sizes that the shape function sees are those of the box, or ``least``; they stay as they are
    where ``least`` has no rows.

    The box must fill the space between a particle's neighbours. Rows that slide over each other keep their
    distance, and a body that rotates as a whole keeps its boxes. So simple shear and rotation do not change
    the box. The stretch U_ii, in contrast, grows with shear, and F_ii shrinks as the material rotates.
    """
    n, dim = box.shape
    follows = len(least) > 0
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            for a in range(dim):
                box[p, a] *= 1 + dt * L[p, a, a]
                if follows:
                    half_size[p, a] = max(box[p, a], least[p, a])


@kernel()
def hold_volume(L, volume, position, radial, box, half_size, follows, largest):
    """l = V^(1/dim) / 2 along every axis, with the area V / (2 π r) for the volume in an axisymmetric scene.

    A box with equal sides has no direction, so that shear cannot distort it. The half-sizes that the shape
    function sees are those of the box if it ``follows``. ``largest``, with an entry for each chunk, becomes
    the largest shear rate γ̇, 1/s, of its particles.
    """
    n, dim = box.shape
    gradients, boxes, half_sizes = L.reshape(-1), box.reshape(-1), half_size.reshape(-1)
    for c in prange(chunk_count(n)):
        begin, end = c * CHUNK, min(n, (c + 1) * CHUNK)
        side = volume[begin:end].copy()
        if radial:
            for k in range(len(side)):
                side[k] /= 2 * math.pi * position[begin + k, 0]
        if dim == 2:
            for k in range(len(side)):
                side[k] = 0.5 * math.sqrt(side[k])
        else:
            for k in range(len(side)):
                side[k] = 0.5 * cube_root(side[k]) if side[k] > 0.0 else math.nan
        _hold(boxes[dim * begin : dim * end], side, dim)
        if follows:
            _hold(half_sizes[dim * begin : dim * end], side, dim)
        squares_of_shear(gradients[9 * begin : 9 * end], side)
        most = 0.0
        for square in side:
            most = max(most, square)
        largest[c] = math.sqrt(most)


@inline()
def _hold(sides, side, dim):
    """All sides of a box are alike; of a volume of zero and less they are no number."""
    if dim == 3:
        for k in range(len(side)):
            sides[3 * k] = sides[3 * k + 1] = sides[3 * k + 2] = side[k]
    else:
        for k in range(len(side)):
            sides[2 * k] = sides[2 * k + 1] = side[k]


@kernel()
def volume_within_reach(volume, half_size, cell_size, within):
    """V Π min(1, Δx/(2 l_i)), ``(n,)``: volume of the part of each box that its weights see."""
    n, dim = half_size.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            part = 1.0
            for a in range(dim):
                part *= min(1.0, 0.5 * cell_size / half_size[p, a])
            within[p] = volume[p] * part


@kernel()
def follow_volume(volume_ratio, initial_half_size, half_size):
    """l = l0 J^(1/dim)."""
    n, dim = half_size.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            factor = volume_ratio[p] ** (1 / dim)
            for a in range(dim):
                half_size[p, a] = initial_half_size[p, a] * factor


@kernel()
def follow_stretch(F, initial_half_size, half_size):
    """l_i = l0_i U_ii with the right stretch U = √(FᵀF) (Charlton et al. 2017).

    The root in closed form (Hoger & Carlson 1984): with the invariants i1, i2, i3 of U,
    U = (i1 i3 I + (i1² - i2) C - C²) / (i1 i2 - i3).
    """
    n, dim = half_size.shape
    for c in prange(chunk_count(n)):
        for p in range(c * CHUNK, min(n, (c + 1) * CHUNK)):
            xx = F[p, 0, 0] ** 2 + F[p, 1, 0] ** 2 + F[p, 2, 0] ** 2
            yy = F[p, 0, 1] ** 2 + F[p, 1, 1] ** 2 + F[p, 2, 1] ** 2
            zz = F[p, 0, 2] ** 2 + F[p, 1, 2] ** 2 + F[p, 2, 2] ** 2
            yz = F[p, 0, 1] * F[p, 0, 2] + F[p, 1, 1] * F[p, 1, 2] + F[p, 2, 1] * F[p, 2, 2]
            xz = F[p, 0, 0] * F[p, 0, 2] + F[p, 1, 0] * F[p, 1, 2] + F[p, 2, 0] * F[p, 2, 2]
            xy = F[p, 0, 0] * F[p, 0, 1] + F[p, 1, 0] * F[p, 1, 1] + F[p, 2, 0] * F[p, 2, 1]
            # Eigenvalues of C by the trigonometric formula for a symmetric 3 × 3 matrix (Smith 1961).
            mean = (xx + yy + zz) / 3
            off = yz * yz + xz * xz + xy * xy
            spread = math.sqrt(((xx - mean) ** 2 + (yy - mean) ** 2 + (zz - mean) ** 2 + 2 * off) / 6)
            angle = 0.0
            if spread > 1e-14 * mean:
                a, b, d = (xx - mean) / spread, (yy - mean) / spread, (zz - mean) / spread
                e, f, g = yz / spread, xz / spread, xy / spread
                half_det = (a * (b * d - e * e) - g * (g * d - e * f) + f * (g * e - b * f)) / 2
                angle = math.acos(min(1.0, max(-1.0, half_det))) / 3
            tiny = 1e-12 * mean
            u1 = math.sqrt(max(mean + 2 * spread * math.cos(angle), tiny))
            u2 = math.sqrt(max(mean + 2 * spread * math.cos(angle - 2 * math.pi / 3), tiny))
            u3 = math.sqrt(max(mean + 2 * spread * math.cos(angle + 2 * math.pi / 3), tiny))
            i1, i2, i3 = u1 + u2 + u3, u1 * u2 + u2 * u3 + u3 * u1, u1 * u2 * u3
            diagonal = (xx, yy, zz)
            squares = (xx * xx + xy * xy + xz * xz, xy * xy + yy * yy + yz * yz, xz * xz + yz * yz + zz * zz)
            for axis in range(dim):
                stretch = (i1 * i3 + (i1 * i1 - i2) * diagonal[axis] - squares[axis]) / (i1 * i2 - i3)
                half_size[p, axis] = initial_half_size[p, axis] * stretch
