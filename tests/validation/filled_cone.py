"""A cone that is closed at its bottom and filled, in which a fluid is at rest."""

from __future__ import annotations

import math

import numpy as np
from clock import at
from turned import put_under_weight
from wall_scenes import G

import mpmkit
from mpmkit.solver.particle_fields import mean_pressure

BOTTOM, TOP, HEIGHT, CELL = 0.1, 0.05, 0.3, 0.01
LEAN = np.array([HEIGHT, BOTTOM - TOP]) / math.hypot(HEIGHT, BOTTOM - TOP)
"""Normal of the side, out of the cone, in (r, z)."""


def filled_cone(material, until, thickness, **scheme):
    """A fluid 0.3 m high in a closed cone that goes on above it, 10 cells across its foot, with slip.

    Args:
        thickness: of the wall, which is open at its top, cells; or None if all that is not inside is wall.

    Returns:
        How far a particle was beyond a wall at most, cells; volume over that at the start, where it is
        farthest from 1; and pressure in the second row above the bottom, away from the side, over ρ g depth,
        as a mean over the second half of the time.
    """
    longer = 1.2
    shape = {
        "kind": "frustum", "bottom_radius": BOTTOM, "top_radius": BOTTOM - longer * (BOTTOM - TOP),
        "height": longer * HEIGHT,
    }  # fmt: skip
    surface = {"kind": "body", "shape": shape, "side": "inside"}
    if thickness:
        surface |= {"thickness": thickness * CELL, "open": ["top"]}
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "axisymmetric",
                "until": 10.0,
                "grid": {
                    "cell_size": CELL,
                    "domain": {"r": [0, 0.15], "z": [-0.05, 0.4]},
                },
                "walls": {"mould": {"surface": surface, "contact": "slip"}},
                "bodies": [
                    {
                        "shape": {
                            "kind": "frustum", "bottom_radius": BOTTOM, "top_radius": TOP, "height": HEIGHT,
                        },
                        "material": material,
                    }
                ],
                "scheme": scheme,
            }
        )
    )  # fmt: skip
    p = simulation.particles
    put_under_weight(simulation, HEIGHT)
    start, beyond, volume, foot, depth = p.volume.sum(), -math.inf, 1.0, [], []
    for time in at(simulation, np.linspace(0, until, round(until / 0.005) + 1)[1:]):
        place = p.position + simulation.grid.lower
        side = (place - [BOTTOM, 0]) @ LEAN
        beyond = max(beyond, np.maximum(side, -place[:, 1]).max() / CELL)
        now = p.volume.sum() / start
        volume = now if abs(now - 1) > abs(volume - 1) else volume
        if time > 0.499 * until:
            row = (place[:, 1] > CELL) & (place[:, 1] < 2 * CELL) & (place[:, 0] < 0.6 * BOTTOM)
            foot.append(np.average(mean_pressure(p)[row], weights=p.mass[row]))
            depth.append(HEIGHT - np.average(place[row, 1], weights=p.mass[row]))
    pressure = np.mean(foot) / (material["density"] * G * np.mean(depth))
    return beyond, volume, float(pressure)
