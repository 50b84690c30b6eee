"""Coulomb friction under a round disc that expands, compared with the equation of motion along its radius."""

from __future__ import annotations

import numpy as np
import pytest
from bands import close_to
from clock import at

import mpmkit

pytestmark = pytest.mark.section(6)

DENSITY, MODULUS, G, RADIUS, HEIGHT, DX = 1000.0, 1e5, 9.81, 0.8, 0.04, 0.02
RATE = 0.5
TIMES = np.array([0.0, 0.016, 0.032])
"""Whole periods 4 H/c of the bounce under its weight, over which the floor bears just that weight."""


def reference(coefficient):
    """Mean radial velocity at ``TIMES``, m/s: ρ dv/dt = dσ_r/dr + (σ_r - σ_θ)/r - μ ρ g v/|v|, ν = 0.

    σ_r = E du/dr, σ_θ = E u/r, no stress at the rim; 400 rings. Friction stops a ring and does not turn it.
    """
    rings, dt = 400, 2e-5
    edge = np.linspace(0.0, RADIUS, rings + 1)
    r, dr = (edge[1:] + edge[:-1]) / 2, RADIUS / rings
    v, u, means = RATE * r, np.zeros(rings), []
    for step in range(round(TIMES[-1] / dt) + 1):
        if step in np.rint(TIMES / dt):
            means.append(float(np.sum(r * v) / np.sum(r)))
        radial = np.concatenate([[0.0], MODULUS * np.diff(u) / dr, [0.0]])  # on the edges
        force = np.diff(edge * radial) / (r * dr) - MODULUS * u / r**2
        v = v + dt * force / DENSITY
        v = np.sign(v) * np.maximum(np.abs(v) - coefficient * G * dt, 0.0)
        u = u + dt * v
    return means


@pytest.mark.parametrize("coefficient", [0.0, 0.2, 0.5])
def test_swelling_disc_rubs_on_its_floor(validate, coefficient):
    """v_r = e r at the start. Friction stops the disc at once near the axis; the rest continues to slide."""
    case = {
        "space": "axisymmetric",
        "until": 1.0,
        "grid": {
            "cell_size": DX,
            "domain": {"r": [0.0, 50 * DX], "z": [0.0, 5 * DX]},
            "faces": {"z_min": {"kind": "friction", "coefficient": coefficient}},
        },
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [RADIUS, HEIGHT]},
                "material": {
                    "law": "neo-hookean",
                    "density": DENSITY,
                    "youngs_modulus": MODULUS,
                    "poisson_ratio": 0.0,
                },
            }
        ],
        "scheme": {"order": "musl", "velocity": "apic", "time_step": {"fraction": 0.4}},
    }
    simulation = mpmkit.Simulation(mpmkit.parse_case(case))
    p, found = simulation.particles, []
    p.velocity[:, 0] = RATE * p.position[:, 0]
    for _ in at(simulation, TIMES):
        found.append(float(p.mass @ p.velocity[:, 0] / p.mass.sum()))
    exact = reference(coefficient)
    assert exact[0] == pytest.approx(2 / 3 * RATE * RADIUS, rel=1e-4)
    for k in (1, 2):
        name = f"Swelling disc, friction {coefficient:g}: mean radial velocity at {1e3 * TIMES[k]:g} ms"
        validate(name, found[k], close_to(exact[k], rel=0.03), unit="m/s")
