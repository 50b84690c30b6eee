"""Affine velocities: conserved angular momentum, and a damping that does not depend on the step."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bands import below, close_to
from test_free_flight import DX, flight

import mpmkit

pytestmark = pytest.mark.section(5)
SPIN = 5.0


def angular_momentum_lost(cell_size: float, velocity: object, order: str = "usl") -> float:
    """Part of its angular momentum that an elastic disc loses in one turn."""
    simulation = flight("plane-strain", ("cpgimp", order, velocity), cell_size=cell_size)
    p = simulation.particles
    centre = np.array([1.0, 1.0]) - simulation.grid.lower
    turn = SPIN * np.array([[0.0, -1.0], [1.0, 0.0]])
    p.velocity[:] = (p.position - centre) @ turn.T
    if p.affine.shape[1]:
        p.affine[:] = turn

    def momentum() -> float:
        x = p.position - centre
        return float(np.sum(p.mass * (x[:, 0] * p.velocity[:, 1] - x[:, 1] * p.velocity[:, 0])))

    start = momentum()
    while simulation.time < 2 * math.pi / SPIN:
        simulation.advance()
    return 1 - momentum() / start


@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
def test_angular_momentum(validate, order):
    """Discs of three and of six cells lose 14 to 23 % in a turn with FLIP, and hardly anything with APIC."""
    flip = angular_momentum_lost(DX, "flip", order)
    coarse, fine = (angular_momentum_lost(cell, "apic", order) for cell in (DX, DX / 2))
    name = f"Spinning disc, APIC, {order.upper()}"
    validate(f"{name}, R = 3 cells: angular momentum lost in a turn", coarse, below(0.02, "0"))
    validate(f"{name}, R = 6 cells: angular momentum lost in a turn", abs(fine), below(0.005, "0"))
    assert abs(coarse) < 0.1 * flip


def shear_wave(velocity: object, fraction: float, wave_length: int, until: float = 1.0) -> float:
    """Energy left at ``until`` of a shear wave, so many cells long, that nothing else would damp."""
    cells = max(wave_length, 8)
    side = cells * DX
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": until,
                "gravity": [0.0, 0.0],
                "grid": {
                    "cell_size": DX,
                    "domain": {"x": [0.0, side], "z": [0.0, side]},
                    "faces": dict.fromkeys(("x_min", "x_max", "z_min", "z_max"), "periodic"),
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [side, side]},
                        "material": {
                            "law": "newtonian",
                            "viscosity": 0.0,
                            "density": 1000.0,
                            "sound_speed": 1.0,
                        },
                    }
                ],
                "scheme": {"velocity": velocity, "time_step": {"fraction": fraction}},
            }
        )
    )
    p = simulation.particles
    p.position[:, 1] += 0.25 * DX  # boxes that lie across the nodes, the worst place for them
    p.velocity[:, 0] = 0.01 * np.sin(2 * np.pi * p.position[:, 1] / (wave_length * DX))
    start = float(np.sum(p.velocity[:, 0] ** 2))
    while simulation.time < until - 1e-9:
        simulation.advance(until - simulation.time)
    return float(np.sum(p.velocity[:, 0] ** 2)) / start


DAMPED = {"name": "apic", "rate": 5.0}


def test_damping_does_not_depend_on_the_step(validate):
    """With a tenth of the step, APIC damps as much per second as before, and PIC ten times as much."""
    coarse, fine = (math.log(shear_wave(DAMPED, fraction, 8)) for fraction in (0.4, 0.04))
    validate(
        "Shear wave of 8 cells, APIC: damping at a tenth of the step", fine / coarse, close_to(1.0, rel=0.03)
    )
    pic = [math.log(shear_wave("pic", fraction, 32)) for fraction in (0.4, 0.04)]
    assert pic[1] / pic[0] == pytest.approx(10.0, rel=0.01)


def test_damping_spares_what_the_grid_resolves(validate):
    """APIC damps with the fourth power of the wave number; PIC is a viscosity, with the second power."""
    short, long = (math.log(shear_wave(DAMPED, 0.4, wave)) for wave in (8, 16))
    order = math.log2(short / long)
    validate("Shear waves of 8 and 16 cells, APIC: order of the damping", order, close_to(4.0, abs=0.2))


def test_without_damping_a_shear_wave_stays(validate):
    left = shear_wave({"name": "apic", "rate": 0.0}, 0.4, 8)
    validate("Shear wave of 8 cells, APIC without damping: energy left", left, close_to(1.0, rel=1e-9))
