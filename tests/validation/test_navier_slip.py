"""Slip in proportion to the shear at a wall: u_w = b du/dn, of shear between plates and of a film.

The flow starts as the exact one and goes on for half of H²/ν, in which the slip at the wall adjusts to what
the wall does.
"""

from __future__ import annotations

import numpy as np
import pytest
from bands import below, close_to
from clock import advance_to
from turned import put_under_weight
from wall_scenes import plane

import mpmkit

pytestmark = pytest.mark.section(6)
HEIGHT, VISCOSITY, DENSITY, DRIVE, SPEED = 0.05, 1.0, 100.0, 2.0, 1.0
ADJUSTS = DENSITY * HEIGHT**2 / VISCOSITY
"""Time in which shear spreads over the height, s."""


def slip_length(part):
    """Slip length, m, for one that is this part of the height."""
    return {"kind": "navier-slip", "slip_length": part * HEIGHT}


def layer(contact, start, time, *, offset=0.0, cells=10, drive=0.0, weight=10.0, lid=False):
    """A Newtonian layer on a plane, two cells long and periodic.

    Args:
        start: velocity along the plane at the distance z from it, m/s.
        offset: of the plane from a row of nodes, cells.
        drive: acceleration along the plane, m/s².
        weight: acceleration onto it, m/s²; it begins with the pressure of that.
        lid: whether a plate on top, to which it sticks, moves along the plane with ``SPEED``.

    Returns:
        Distance from the plane, m, and velocity along it, m/s, of the particles at a time, s.
    """
    cell = HEIGHT / cells
    foot = (2 + offset) * cell
    walls = {"floor": plane((0, foot), (0, 1), contact)}
    if lid:
        motion = {"kind": "velocity", "velocity": [SPEED, 0]}
        walls["lid"] = plane((0, foot + HEIGHT), (0, -1), "stick", motion=motion)
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": 100.0,
                "gravity": [drive, -weight],
                "grid": {
                    "cell_size": cell,
                    "domain": {"x": [0, 2 * cell], "z": [0, HEIGHT + 6 * cell]},
                    "faces": {"x_min": "periodic", "x_max": "periodic"},
                },
                "walls": walls,
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0, foot], "upper": [2 * cell, foot + HEIGHT]},
                        "material": {
                            "law": "newtonian",
                            "density": DENSITY,
                            "viscosity": VISCOSITY,
                            "sound_speed": 10.0,
                        },
                    }
                ],
            }
        )
    )
    p = simulation.particles
    put_under_weight(simulation, foot + HEIGHT, weight)
    p.velocity[:, 0] = start(p.position[:, 1] - foot)
    advance_to(simulation, time)
    return p.position[:, 1] - foot, p.velocity[:, 0]


def slip_over_law(z, u, part, degree):
    """u_w/(b du/dn) of the curve that is fitted to all particles."""
    fit = np.polyfit(z, u, degree)
    return fit[-1] / (part * HEIGHT * fit[-2])


def film(part, offset=0.0, cells=10):
    """The same for a film, u = G/ν (H z - z²/2 + b H)."""

    def start(z):
        return DRIVE * DENSITY / VISCOSITY * (HEIGHT * z - z**2 / 2 + part * HEIGHT**2)

    time = 0.5 * ADJUSTS
    z, u = layer(slip_length(part), start, time, offset=offset, cells=cells, drive=DRIVE)
    return slip_over_law(z, u, part, 2)


@pytest.mark.parametrize("part", [0.1, 0.5])
def test_slip_of_shear_between_plates(validate, part):
    """On nodes. The exact slip is U b/(b + H)."""

    def start(z):
        return SPEED * (z / HEIGHT + part) / (1 + part)

    z, u = layer(slip_length(part), start, 0.5 * ADJUSTS, lid=True)
    name = f"Navier slip, shear between plates, b {part:g} H, 10 cells"
    validate(f"{name}: slip over b du/dn", slip_over_law(z, u, part, 1), close_to(1.0, rel=0.03))
    slip = np.polyfit(z, u, 1)[-1] / (SPEED * part / (1 + part))
    validate(f"{name}: slip over the exact one", slip, close_to(1.0, rel=0.03))


def hold_film(validate, part, offset=0.0, cells=10):
    name = f"Navier slip, film, b {part:g} H, wall {offset:g} cells off the nodes, {cells} cells"
    found = film(part, offset, cells)
    validate(f"{name}: slip over b du/dn", found, close_to(1.0, rel=0.03))


CHORD = pytest.mark.xfail(
    reason="5.7 % too little for b = 0.1 H, 5.1 % for 0.5 H: the shear is taken between the wall and the next"
    " row, where it is less by half a cell over H, 5 %, than at the wall; 2.4 % at 20 cells",
    strict=True,
)
BETWEEN = pytest.mark.xfail(
    reason="13 % too much at 0.37 cells for b = 0.1 H, 9 % for 0.5 H, 93 % at 0.8 for 0.1 H: the wall pushes"
    " in only 93 and 90 % of the steps, as ghosts bear the film in the others, and drags only when it pushes",
    strict=True,
)


@CHORD
@pytest.mark.parametrize("part", [0.1, 0.5])
def test_slip_of_a_film(validate, part):
    hold_film(validate, part)


@pytest.mark.slow
def test_slip_of_a_fine_film(validate):
    hold_film(validate, 0.1, cells=20)


@BETWEEN
@pytest.mark.parametrize(("part", "offset"), [(0.1, 0.37), (0.5, 0.37), (0.1, 0.8)])
def test_slip_of_a_film_between_nodes(validate, part, offset):
    hold_film(validate, part, offset)


@pytest.mark.parametrize("offset", [0.0, 0.37])
@pytest.mark.parametrize(("part", "limit"), [(0.0, "stick"), (1000.0, "slip")])
def test_no_and_much_slip(validate, part, limit, offset):
    """A film that starts from rest."""
    contacts = (slip_length(part), limit)
    found, expected = (
        layer(contact, np.zeros_like, 0.1 * ADJUSTS, offset=offset, drive=DRIVE)[1] for contact in contacts
    )
    off = np.abs(found - expected).max() / np.abs(expected).max()
    name = f"Navier slip, film from rest, b {part:g} H, wall {offset:g} cells off the nodes"
    validate(f"{name}: velocity off that with {limit}", off, below(0.03, "0"))
