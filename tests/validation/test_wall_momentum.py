"""The impulses of walls account for the momentum of the material."""

from __future__ import annotations

import numpy as np
import pytest
from bands import below
from turned import axes
from wall_scenes import G, coulomb

import mpmkit

pytestmark = pytest.mark.section(6)
ORDERS, UPDATES = ("usl", "usf", "musl"), ("apic", "flip", "pic", "blend")
LEAN = axes(25.0)[1]
FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 5.0, "sound_speed": 15.0}
PUSHED = {
    "plane-strain": (
        {"domain": {"x": [-0.5, 0.8], "z": [-0.5, 0.8]}},
        {"kind": "box", "lower": [0, 0.2], "upper": [0.3, 0.4]},
        {"kind": "plane", "point": [0.03, 0.05], "normal": LEAN.tolist()},
        [0.2, -1.0],
    ),
    "axisymmetric": (
        {"domain": {"r": [0, 0.8], "z": [-0.5, 0.8]}},
        {"kind": "cylinder", "radius": 0.2, "height": 0.2, "base": [0.0, 0.21]},
        {"kind": "plane", "point": [0.0, 0.2], "normal": [0.0, 1.0]},
        [0.0, -1.0],
    ),
    "3d": (
        {"domain": {"x": [-0.5, 0.6], "y": [-0.5, 0.6], "z": [-0.5, 0.6]}},
        {"kind": "box", "lower": [0, 0, 0.12], "upper": [0.2, 0.2, 0.32]},
        {"kind": "plane", "point": [0.03, 0.0, 0.05], "normal": [-0.3, -0.2, 1.0]},
        [0.2, 0.1, -1.0],
    ),
}


def momentum_off(space, order, update, contact, moving, redistribution="none"):
    """|Σ m v - Σ m v₀ - M g t - Σ λ| over Σ |λ|: the error of the particles' momentum."""
    domain, shape, surface, velocity = PUSHED[space]
    up = {"kind": "velocity", "velocity": [0.0] * (len(velocity) - 1) + [0.3]}
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": space,
                "until": 1.0,
                "grid": {"cell_size": 0.05, **domain},
                "walls": {
                    "w": {"surface": {**surface, **({"motion": up} if moving else {})}, "contact": contact}
                },
                "bodies": [{"shape": shape, "material": FLUID, "velocity": velocity}],
                "scheme": {"order": order, "velocity": update, "redistribution": redistribution},
            }
        )
    )
    p = simulation.particles
    start, dim = p.mass @ p.velocity, len(velocity)
    for _ in range(80):
        simulation.advance()
    given = simulation.wall_sums()[0, :dim]
    gravity = np.array([0.0] * (dim - 1) + [-G])
    off = p.mass @ p.velocity - start - p.mass.sum() * gravity * simulation.time - given
    assert np.linalg.norm(given) > 0.1 * p.mass.sum() * G * simulation.time  # it has been reached
    return np.abs(off[-1:] if space == "axisymmetric" else off).max() / np.linalg.norm(given)


@pytest.mark.parametrize("contact", ["slip", "stick", coulomb(0.3)], ids=str)
@pytest.mark.parametrize("space", PUSHED)
def test_walls_account_for_all_momentum(validate, space, contact):
    """Reported impulses and gravity give the whole momentum, in every order and velocity update."""
    pairs = [(order, update) for order in ORDERS for update in UPDATES]
    if space == "3d":
        pairs = pairs[:: 5 if contact != "slip" else 2]
    off = max(momentum_off(space, *pair, contact, moving=k % 2 == 0) for k, pair in enumerate(pairs))
    validate(f"Wall, {space}: momentum that it did not give", off, below(1e-10, "0"))
