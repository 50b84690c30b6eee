"""A disc between two plates without slip; the upper plate moves down."""

from __future__ import annotations

import math

import numpy as np
from clock import at
from wall_scenes import plane

import mpmkit

RADIUS = 0.05


def squeeze(material, height, speed, cells, times, upper="plane", lower="face", **scheme):
    """Mean force on the upper plate, N, from each of ``times``, s, to the next, and the gap, m, half-way.

    The disc has no weight. Plates are wider than the disc at all times, so that its radius follows from its
    volume. It starts with the flow of ideal slip, v = (r/2, -z) v/h, and without stress.

    Args:
        upper: a ``plane``, or a ``cylinder``, which is a body.
        lower: a ``face`` of the grid, or a ``plane``.
    """
    cell = height / cells
    across = math.ceil(1.1 * RADIUS / cell) * cell
    above = 5 * cell
    motion = {"kind": "velocity", "velocity": [0, -speed]}
    if upper == "plane":
        top = plane((0, height), (0, -1), "stick", motion=motion)
    else:
        shape = {"kind": "cylinder", "radius": across + 4 * cell, "height": 4 * cell, "base": [0, height]}
        top = {
            "surface": {"kind": "body", "shape": shape, "side": "outside", "motion": motion},
            "contact": "stick",
        }
    walls = {"upper": top}
    below = 0.0 if lower == "face" else 2 * cell
    if lower == "plane":
        walls["lower"] = plane((0, 0), (0, 1), "stick")
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "axisymmetric",
                "until": 10.0,
                "gravity": [0, 0],
                "grid": {
                    "cell_size": cell,
                    "domain": {"r": [0, across], "z": [-below, height + above]},
                    "faces": {} if lower == "plane" else {"z_min": "stick"},
                },
                "walls": walls,
                "bodies": [
                    {
                        "shape": {"kind": "cylinder", "radius": RADIUS, "height": height},
                        "material": material,
                    }
                ],
                "scheme": scheme,
            }
        )
    )
    p = simulation.particles
    p.velocity[:] = speed / height * (p.position - [0, below]) * [0.5, -1]
    given = [simulation.wall_sums()[0, 1] for _ in at(simulation, times)]
    middle = (np.asarray(times)[1:] + np.asarray(times)[:-1]) / 2
    return -np.diff(given) / np.diff(times), height - speed * middle
