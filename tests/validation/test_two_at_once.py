"""Two materials in one run, and a law with state variables: splitting of particles and sound speeds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bands import below, close_to

import mpmkit
from mpmkit.contracts import StateVariable
from mpmkit.registry import Registered, Registry, installed
from mpmkit.solver.sound import largest_energy

pytestmark = pytest.mark.section(3)


class Dyed(installed().of_kind("law")["newtonian"]):
    """A Newtonian fluid with a dye that goes with it, and the time that it has been strained."""

    name = "dyed"
    state = {"dye": StateVariable("1", "dye"), "age": StateVariable("s", "age")}

    def update_stress(self, motion, state, dt, stress):
        super().update_stress(motion, state, dt, stress)
        state["age"] += dt


def test_splitting_keeps_mass_and_what_a_law_remembers(validate):
    """Σ m and Σ m λ of each state variable, through hundreds of splits, and λ within its first bounds."""
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered("law", Dyed, "tests", "1", "dyed")], [])
    case = {
        "space": "axisymmetric",
        "until": 1.0,
        "grid": {"cell_size": 0.02, "domain": {"r": [0, 0.6], "z": [0, 0.32]}, "faces": {"z_min": "slip"}},
        "bodies": [
            {
                "shape": {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": 0.3},
                "material": {
                    "law": "dyed",
                    "density": 2574.0,
                    "viscosity": 50.0,
                    "sound_speed": {"factor": 10},
                },
            }
        ],
        "scheme": {"velocity": "apic", "redistribution": "none", "splitting": True},
    }
    simulation = mpmkit.Simulation(mpmkit.parse_case(case, registry=registry))
    p = simulation.particles
    dye = p.groups[0].state["dye"]
    dye[:] = p.position[:, 1]
    mass, held, bounds, count = p.mass.sum(), p.mass @ dye, (dye.min(), dye.max()), len(p)
    splits = 0
    while simulation.time < 0.35:
        before = len(simulation.particles)
        simulation.advance()
        splits += len(simulation.particles) > before
    p, state = simulation.particles, simulation.particles.groups[0].state
    assert len(p) > 1.5 * count
    assert splits > 1
    name = "Splitting with a law that has a state"
    validate(f"{name}: mass lost or gained, of it", abs(p.mass.sum() / mass - 1), below(1e-12, "0"))
    validate(f"{name}: Σ m λ lost or gained, of it", abs(p.mass @ state["dye"] / held - 1), below(1e-12, "0"))
    assert bounds[0] <= state["dye"].min()
    assert state["dye"].max() <= bounds[1]
    np.testing.assert_allclose(state["age"], simulation.time, rtol=1e-12)  # children are as old as parents


def test_two_materials_follow_the_flow_each_at_its_mach_number(validate):
    """c = √(2 e)/mach of each, e the largest energy of all particles, while both collapse."""
    material = {"law": "newtonian", "density": 1000.0, "viscosity": 20.0}
    machs, bodies = (0.1, 0.2), []
    for k, mach in enumerate(machs):
        shape = {"kind": "box", "lower": [0.0, 0.2 * k], "upper": [0.2, 0.2 * (k + 1)]}
        mine = material | {"density": 1000.0 / (k + 1), "sound_speed": {"mach": mach}}
        bodies.append({"shape": shape, "material": mine})
    case = {
        "space": "plane-strain",
        "until": 1.0,
        "grid": {
            "cell_size": 0.04,
            "domain": {"x": [0.0, 1.2], "z": [0.0, 0.48]},
            "faces": {"z_min": "slip", "x_min": "symmetry"},
        },
        "bodies": bodies,
        "scheme": {"velocity": "apic"},
    }
    simulation = mpmkit.Simulation(mpmkit.parse_case(case))
    p, gravity = simulation.particles, simulation.case.gravity_vector
    first = [group.sound_speed for group in p.groups]
    fastest = 0.0
    while simulation.time < 0.3:
        simulation.advance()
        speeds = [group.sound_speed for group in p.groups]
        # Each follows by 5 % at most in the time that its own sound takes to cross the material.
        assert speeds[0] / speeds[1] == pytest.approx(machs[1] / machs[0], rel=0.05)
        fastest = max(fastest, simulation.mach_number)
    assert simulation.case.bodies[0].material.sound_speed.mach == machs[0]
    needed = math.sqrt(2 * largest_energy(p, simulation.grid, gravity)) / machs[0]
    validate("Two materials that follow the flow: c of the first, at 0.3 s", p.groups[0].sound_speed,
             close_to(needed, rel=0.1), unit="m/s")  # fmt: skip
    assert p.groups[0].sound_speed < 0.95 * first[0]
    validate("Two materials that follow the flow: largest Mach number, over that of the slower",
             fastest / machs[1], below(1.0, "≤ 1"))  # fmt: skip
