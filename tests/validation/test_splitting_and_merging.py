"""Splitting comes to an end, and merging limits the number of particles without a change of the flow."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from accurate_setup import bingham
from bands import below

import mpmkit

pytestmark = pytest.mark.section(5)
CASES = Path(__file__).parents[2] / "cases"
TANK = dict.fromkeys(("x_min", "x_max", "z_min", "z_max"), "slip")
WIDTH, HEIGHT, LENGTH = 0.56, 0.28, 1.5


def most_particles(simulation: mpmkit.Simulation, until: float) -> int:
    """Run the simulation; the largest number of particles during the run."""
    most = len(simulation.particles)
    while simulation.time < until:
        simulation.advance(until - simulation.time)
        most = max(most, len(simulation.particles))
    simulation.check()
    return most


@pytest.mark.slow
@pytest.mark.parametrize(("redistribution", "refinement"), [("none", "split-and-merge"), ("even", "split")])
def test_what_is_let_go_in_a_tank_is_not_split_without_end(validate, redistribution, refinement):
    """Without a limit, splitting made 103,334 particles from 1,568 in two seconds, most with boxes of 8.6 by
    0.08 mm."""
    material = bingham(10.0, 1.0, density=1900.0, sound_speed={"factor": 10})
    case = {
        "space": "plane-strain",
        "until": 2.0,
        "grid": {"cell_size": 0.02, "domain": {"x": [0, LENGTH], "z": [0, 0.6]}, "faces": TANK},
        "bodies": [
            {"shape": {"kind": "box", "lower": [0, 0], "upper": [WIDTH, HEIGHT]}, "material": material}
        ],
        "scheme": {"order": "musl", "redistribution": redistribution, "refinement": refinement},
    }
    simulation = mpmkit.Simulation(mpmkit.parse_case(case))
    begun = len(simulation.particles)
    most = most_particles(simulation, 2.0)
    name = (
        f"Block let go in a tank, {redistribution}, {refinement}, 2 s: most particles over those at the start"
    )
    validate(name, most / begun, below(1.5))


@pytest.mark.parametrize(
    ("file", "overrides", "until"),
    [
        ("slump", ["grid.cell_size=0.01", "grid.domain.z=[0, 0.31]"], 0.6),
        pytest.param(
            "slump_quarter",
            ["grid.cell_size=0.02", "grid.domain.z=[0, 0.32]", "bodies.0.particles_per_cell=8"],
            2.0,
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_slump_spreads_with_merging_as_without(validate, file, overrides, until):
    """The spread at any time, and the number of particles over that at the start."""
    found = []
    for refinement in ("split", "split-and-merge"):
        changes = ["scheme.redistribution=none", f"scheme.refinement={refinement}", f"until={until}"]
        simulation = mpmkit.Simulation(mpmkit.load_case(CASES / f"{file}.json", [*overrides, *changes]))
        begun, spread = len(simulation.particles), []
        for time in np.linspace(0, until, 21)[1:]:
            most = most_particles(simulation, time)
            spread.append(simulation.measures.spread(simulation.particles))
        found.append(np.array(spread))
    off = float(np.abs(found[1] / found[0] - 1).max())
    name = f"Merging, {file.replace('_', ' ')}, {until:g} s"
    validate(f"{name}: D(t) off that without merging", off, below(0.003, "0"))
    validate(f"{name}: particles over those at the start", most / begun, below(1.3))
