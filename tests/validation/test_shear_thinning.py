"""Fluids that thin in shear, n < 1: a film down a slope, and a sheet that spreads on a slip floor."""

from __future__ import annotations

import numpy as np
import pytest
from bands import below, close_to
from channel import Channel, Fluid, down_slope
from clock import at
from fluids import BAND
from test_spreading import DENSITY, G

import mpmkit

pytestmark = pytest.mark.section(2)


@pytest.mark.parametrize("index", [0.5, 0.7])
def test_film_that_thins_in_shear(validate, index):
    """u = n/(n+1) (ρ g_x/k)^(1/n) [H^(1+1/n) - (H - z)^(1+1/n)], started 3 % too slow.

    At the surface γ̇ is 0 and k γ̇^(n-1) has no bound; the law keeps it below what it has at γ̇ = 1/m.
    """
    drive, across = down_slope(1000.0, 20)
    fluid = Fluid(0.0, 100.0, index, density=1000.0)
    flow = Channel(
        fluid, 0.05, drive, cells=10, m=10.0, order="musl", fraction=1.0,
        normal_gravity=across, free_surface=True, sound_speed=20.0,
    )  # fmt: skip
    flow.start_with(0.97 * fluid.speed(drive, 0.05, flow.z))
    flow.run_until_steady(2e-3, interval=0.01, at_most=1.0)
    name = f"Shear-thinning film, n = {index:g}"
    exact = fluid.plug_speed(drive, 0.05)
    validate(f"{name}: surface speed", flow.plug_speed(), close_to(exact, rel=BAND), unit="m/s")
    error = flow.error(fluid.speed(drive, 0.05, flow.z))
    validate(f"{name}: profile, L2 error", error, below(BAND))


def test_sheet_that_thins_in_shear_slumps_at_its_rate(validate):
    """v_r = e r on a slip floor: 6 μ e = ρ g H/2 with μ = k (√12 e)^(n-1), away from the edge.

    e = [ρ g H/(12 k 12^((n-1)/2))]^(1/n), dH/dt = -2 e H. With n = 1/2 a sheet of half the height spreads
    four times as slowly; a Newtonian sheet of half the height, only twice as slowly.
    """
    radius, height, k, n = 0.6, 0.1, 750.0, 0.5
    dx = height / 4
    material = {
        "law": "herschel-bulkley", "density": DENSITY, "yield_stress": 0.0, "consistency": k, "flow_index": n,
        "regularisation": 20.0, "sound_speed": {"factor": 20},
    }  # fmt: skip
    case = {
        "space": "axisymmetric",
        "until": 1.0,
        "grid": {
            "cell_size": dx,
            "domain": {"r": [0.0, 32 * dx], "z": [0.0, 6 * dx]},
            "faces": {"z_min": "slip"},
        },
        "bodies": [
            {"shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [radius, height]}, "material": material}
        ],
        "scheme": {"order": "musl", "velocity": "apic", "time_step": {"fraction": 0.9}},
    }
    simulation = mpmkit.Simulation(mpmkit.parse_case(case))
    p, h, dt = simulation.particles, height, 1e-4

    def rate(h):
        return (DENSITY * G * h / (12 * k * 12 ** ((n - 1) / 2))) ** (1 / n)

    found, expected = [], []
    for _ in at(simulation, np.arange(0.0, 0.201, 0.05)):
        inside = p.position[:, 0] < radius / 2
        r, v = p.position[inside, 0], p.velocity[inside, 0]
        found.append(float(np.sum(p.mass[inside] * v * r) / np.sum(p.mass[inside] * r * r)))
        expected.append(rate(h))
        for _ in range(round(0.05 / dt)):
            middle = h - dt * rate(h) * h
            h -= 2 * dt * rate(middle) * middle
    name = "Shear-thinning sheet, n = 0.5"
    for step in (2, 4):
        row = f"{name}: thinning rate at {0.05 * step:g} s"
        validate(row, found[step], close_to(expected[step], rel=0.05), unit="1/s")
