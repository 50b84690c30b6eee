"""The distance of points from a plane region with straight edges."""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from .compile import CHUNK, chunk_count, kernel


@kernel()
def section_distance(x, start, end):
    """Signed distance φ, m, ``(k,)``, above 0 outside, and its gradient, ``(k, 2)``.

    φ is the distance of the nearest edge (the first of several at equal distance). If the foot of the point
    lies between the ends of the edge, φ is the distance of its line, with the sign of the side; otherwise φ
    is the distance of the corner. For the sign at a corner, a ray from the point along the first axis crosses
    the edges an odd number of times if the point is in the region.

    Args:
        x: points, m, ``(k, 2)``.
        start, end: ends of the edges, m, ``(edges, 2)``, with the region on their left.
    """
    k = len(x)
    distance, gradient = np.empty(k), np.empty((k, 2))
    for c in prange(chunk_count(k)):
        for p in range(c * CHUNK, min(k, (c + 1) * CHUNK)):
            nearest, at_corner, inside = np.inf, False, False
            distance[p] = gradient[p, 0] = gradient[p, 1] = np.nan  # stays so if the point is not a number
            for e in range(len(start)):
                ax, ay, bx, by = start[e, 0], start[e, 1], end[e, 0], end[e, 1]
                length = math.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
                ux, uy = (bx - ax) / length, (by - ay) / length
                rx, ry = x[p, 0] - ax, x[p, 1] - ay
                place = rx * ux + ry * uy
                foot = min(max(place, 0.0), length)
                qx, qy = rx - foot * ux, ry - foot * uy
                square = qx * qx + qy * qy
                if square < nearest:
                    nearest = square
                    at_corner = foot != place and square > 0.0
                    if at_corner:
                        gradient[p, 0], gradient[p, 1] = qx, qy
                    else:
                        gradient[p, 0], gradient[p, 1] = uy, -ux
                        distance[p] = rx * uy - ry * ux
                if (ay > x[p, 1]) != (by > x[p, 1]) and x[p, 0] < ax + (x[p, 1] - ay) / (by - ay) * (bx - ax):
                    inside = not inside
            if at_corner:
                away = math.sqrt(nearest)
                sign = -1.0 if inside else 1.0
                distance[p] = sign * away
                gradient[p, 0] *= sign / away
                gradient[p, 1] *= sign / away
    return distance, gradient
