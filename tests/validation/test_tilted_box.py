"""Concrete at rest in a box that is turned against the grid."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bands import above, below, close_to
from clock import advance_to, at
from turned import axes, filled, lattice, put_under_weight
from wall_scenes import FRESH, G, grid, plane

pytestmark = pytest.mark.section(6)


def tilted_box(degrees, offset, contact, cell, until, sound, watch):
    """Concrete with a level surface in a box of three planes, 0.2 m wide, which is tilted.

    Returns:
        Force of all walls over the weight, (2,), from ``watch`` to ``until``, s; the least distance of a
        particle from a wall, cells; and the largest speed, m/s.
    """
    (along, normal), origin = axes(degrees), np.array([0.14, 0.06]) + cell * np.asarray(offset)
    level = origin[1] + 0.12

    def keep(a, b):
        return (a > 0) & (a < 0.2) & (b > 0) & (origin[1] + a * along[1] + b * normal[1] < level)

    simulation = filled(
        {
            "until": 5.0,
            "grid": grid(cell, [0, 0], [0.42, 0.4]),
            "walls": {
                "bottom": plane(origin, normal, contact),
                "left": plane(origin, along, contact),
                "right": plane(origin + 0.2 * along, -along, contact),
            },
            "bodies": [{"material": {**FRESH, "sound_speed": sound}}],
        },
        lattice(cell / 2, keep, origin, degrees, reach=0.5),
    )
    put_under_weight(simulation, level)
    advance_to(simulation, watch)
    before, p, behind = simulation.wall_sums(), simulation.particles, math.inf
    for _ in at(simulation, np.linspace(watch, until, 20)[1:]):
        place = p.position + simulation.grid.lower - origin
        a, b = place @ along, place @ normal
        behind = min(behind, np.minimum(np.minimum(a, 0.2 - a), b).min() / cell)
    force = (simulation.wall_sums() - before)[:, :2].sum(axis=0) / (until - watch) / (p.mass.sum() * G)
    return force, behind, np.linalg.norm(p.velocity, axis=1).max()


def hold_box(validate, contact, *scene):
    force, behind, speed = tilted_box(20.0, (0.3, 0.1), contact, *scene)
    name = f"Concrete at rest in a box tilted by 20°, {contact}, {1e3 * scene[0]:g} mm"
    validate(f"{name}: force of its walls over the weight", force[1], close_to(1.0, rel=0.002))
    validate(f"{name}: sideways", force[0], close_to(0.0, abs=0.002))
    validate(f"{name}: least distance of a particle from a wall, cells", behind, above(-0.1))
    validate(f"{name}: largest speed over √(g H)", speed / math.sqrt(G * 0.12), below(1e-3, "0"))


BOXES = ["slip", "stick"]


@pytest.mark.parametrize("contact", BOXES)
def test_tilted_box_at_rest(validate, contact):
    hold_box(validate, contact, 0.02, 1.0, 10.0, 0.6)


@pytest.mark.slow
@pytest.mark.parametrize("contact", BOXES)
def test_tilted_box_stays_at_rest(validate, contact):
    hold_box(validate, contact, 0.01, 2.0, 20.0, 1.5)
