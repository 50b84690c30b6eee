"""Particles drawn as one smooth body: each is a ball, the nearest ball is seen, and the depth is smoothed.

The depth is found for each pixel and smoothed where it has no step. Its slope gives the surface normals for
the light (van der Laan et al., Screen space fluid rendering with curvature flow, I3D 2009).
"""

from __future__ import annotations

import numpy as np

MOST_PASSES = 80
"""Most smoothing passes; each averages over the nearest pixels."""
LIGHT = np.array([-0.45, 0.55, 0.7])
"""To the right, up, and towards the eye."""
AMBIENT = 0.45
"""Part of the light that comes from everywhere."""


def nearest_particles(
    places: np.ndarray, radius: np.ndarray, shape: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray]:
    """Depth of the nearest ball in each pixel, and the particle of this ball.

    Args:
        places: ``(n, 3)`` column, row and depth of the particles, pixels; depths grow towards the eye.
        radius: ``(n,)`` of their balls, pixels.
        shape: rows and columns of the picture.

    Returns:
        depths (-inf without a particle) and indices of particles (-1 without a particle), each of ``shape``.
    """
    rows, columns = shape
    depth, number = np.full(shape, -np.inf), np.full(shape, -1)
    order = np.argsort(places[:, 2], kind="stable")  # the nearest comes last and is kept
    column, row = (np.rint(places[order, axis]).astype(int) for axis in (0, 1))
    height, size = places[order, 2], radius[order]
    reach = int(np.ceil(size.max(initial=0.0)))
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            above = size**2 - down**2 - right**2
            i, j = row + down, column + right
            drawn = (above >= 0) & (i >= 0) & (i < rows) & (j >= 0) & (j < columns)
            here, of = np.full(shape, -np.inf), np.full(shape, -1)
            here[i[drawn], j[drawn]] = height[drawn] + np.sqrt(above[drawn])
            of[i[drawn], j[drawn]] = order[drawn]
            nearer = here > depth
            depth[nearer], number[nearer] = here[nearer], of[nearer]
    return depth, number


def smoothed(depth: np.ndarray, radius: float, jump: float) -> np.ndarray:
    """The depth averaged over about the ``radius`` of a ball, pixels, so that single balls are not visible.

    A neighbour whose depth differs by more than ``jump``, pixels, is left out of the mean.
    """
    for _ in range(min(MOST_PASSES, round(radius**2))):  # the averaging length is √passes
        total, weight = depth.copy(), np.ones_like(depth)
        for axis in (0, 1):
            for step in (1, -1):
                beside = np.roll(depth, step, axis)
                with np.errstate(invalid="ignore"):  # nothing beside nothing
                    near = np.abs(beside - depth) < jump
                total[near] += beside[near]
                weight += near
        depth = total / weight
    return depth


def brightness(depth: np.ndarray) -> np.ndarray:
    """How bright a surface is, from 0 to 1, by the angle between its normal and the light."""
    there = np.isfinite(depth)
    slopes = []
    for axis in (1, 0):
        # At an edge, one of the two slopes leads to the background: take the flatter one.
        with np.errstate(invalid="ignore"):  # nothing beside nothing
            forth, back = np.roll(depth, -1, axis) - depth, depth - np.roll(depth, 1, axis)
            slope = np.where(np.abs(forth) < np.abs(back), forth, back)
        slopes.append(np.where(np.isfinite(slope), slope, 0.0))
    normal = np.stack([-slopes[0], slopes[1], np.ones_like(depth)], axis=-1)  # rows grow downwards
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    lit = np.clip(normal @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, 1.0)
    return np.where(there, AMBIENT + (1 - AMBIENT) * lit, 0.0)
