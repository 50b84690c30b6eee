"""A container and its content in uniform motion, compared with the same at rest."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from bands import below, close_to
from clock import advance_to, at
from turned import put_under_weight
from wall_scenes import FRESH, G, centre, grid, plane

import mpmkit

pytestmark = pytest.mark.section(6)


@cache
def carried(velocity, contact, as_one, time=0.5):
    """Concrete in a box that moves with it: its centre of mass against the box, m, and the box's force, N.

    Both are means over the last two thirds. The box is one body, or four planes.
    """
    cell, corner, velocity = 0.02, np.array([0.3, 0.3]), np.array(velocity)
    size, motion = np.array([0.2, 0.16]), {"kind": "velocity", "velocity": velocity.tolist()}
    shape = {"kind": "box", "lower": corner.tolist(), "upper": (corner + size).tolist()}
    if as_one:
        surface = {"kind": "body", "shape": shape, "side": "inside", "motion": motion}
        walls = {"box": {"surface": surface, "contact": contact}}
    else:
        faces = {"left": (corner, (1, 0)), "bottom": (corner, (0, 1))}
        faces |= {"right": (corner + size, (-1, 0)), "top": (corner + size, (0, -1))}
        walls = {name: plane(*face, contact, motion=motion) for name, face in faces.items()}
    ends = corner + np.array([[0, 0], size, velocity * time, size + velocity * time])
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": 2.0,
                "grid": grid(cell, ends.min(axis=0) - 0.1, ends.max(axis=0) + 0.1),
                "walls": walls,
                "bodies": [
                    {
                        "shape": {**shape, "upper": [*(corner + np.array([0.2, 0.1]))]},
                        "material": {**FRESH, "sound_speed": 20.0},
                        "velocity": velocity.tolist(),
                    }
                ],
            }
        )
    )
    put_under_weight(simulation, corner[1] + 0.1)
    advance_to(simulation, time / 3)
    before, places = simulation.wall_sums(), []
    for now in at(simulation, np.linspace(time / 3, time, 21)[1:]):
        places.append(centre(simulation) + simulation.grid.lower - corner - velocity * now)
    force = (simulation.wall_sums() - before)[:, :2].sum(axis=0) / (time * 2 / 3)
    return np.mean(places, axis=0), force, simulation.particles.mass.sum() * G


def hold_carried(validate, velocity, contact, as_one):
    rest, push, weight = carried((0.0, 0.0), contact, as_one)
    place, force, _ = carried(velocity, contact, as_one)
    name = (
        f"Box of concrete that moves at a constant velocity, {'one body' if as_one else 'planes'}, {contact}"
    )
    validate(f"{name}: force at rest over the weight", push[1] / weight, close_to(1.0, rel=0.01))
    off = np.abs(place - rest).max() / rest.max()
    validate(f"{name}: centre of mass off, of its place at rest", off, below(1e-3, "0"))
    validate(f"{name}: force off, of that at rest", np.abs(force - push).max() / weight, below(0.01, "0"))


@pytest.mark.parametrize(
    ("velocity", "contact"),
    [
        pytest.param((0.4, 0.0), "slip", marks=pytest.mark.slow),
        pytest.param((0.0, 0.4), "stick", marks=pytest.mark.slow),
        pytest.param((0.3, -0.25), "slip", marks=pytest.mark.slow),
        ((0.3, -0.25), "stick"),
    ],
    ids=str,
)
def test_container_and_content_move_together(validate, velocity, contact):
    """The same as at rest, at all offsets of the box from the nodes."""
    hold_carried(validate, velocity, contact, as_one=False)


@pytest.mark.parametrize("contact", ["slip", pytest.param("stick", marks=pytest.mark.slow)])
def test_container_of_one_body_and_content_move_together(validate, contact):
    """A node in a corner is next to two faces of the body; the body's wall has a part for each."""
    hold_carried(validate, (0.4, 0.0), contact, as_one=True)
