"""What a pilot on coarse cells says of a run, against the run."""

import json
import time
from pathlib import Path

import pytest

import mpmkit
from mpmkit.case import load_case
from mpmkit.plan import plan
from mpmkit.plan.pilot import FEW, coarser, pilot
from mpmkit.solver.memory import expected_particles
from mpmkit.solver.simulation import Simulation

CASES = Path(__file__).parent.parent / "cases"
COARSE = ["grid.cell_size=0.01", 'grid.domain={"r": [0, 0.36], "z": [0, 0.31]}', "until=0.6"]
SCENES = {
    "split": COARSE,
    "sound that follows": [*COARSE, 'bodies.0.material.sound_speed={"mach": 0.1}'],
}


@pytest.mark.parametrize("overrides", SCENES.values(), ids=SCENES)
def test_steps_and_particles_to_come_are_those_of_the_run(overrides):
    case = load_case(CASES / "slump.json", overrides)
    simulation = Simulation(case)
    first = len(simulation.particles)
    while simulation.time < case.until:
        simulation.advance(case.until - simulation.time)
    cost = plan(case, threads=1)
    assert cost["particles"] == first
    assert cost["steps"] == pytest.approx(simulation.steps, rel=0.1)
    assert cost["particles_at_end"] == pytest.approx(len(simulation.particles), rel=0.25)


def test_a_coarse_copy_has_few_particles_and_the_same_scene():
    case = load_case(CASES / "slump_quarter.json")
    coarse = coarser(case)
    assert expected_particles(coarse) < 1.5 * FEW[3]
    assert coarse.grid.faces == case.grid.faces
    for axis, (low, high) in coarse.grid.domain.items():
        assert low == case.grid.domain[axis][0]
        assert high >= case.grid.domain[axis][1] - 1e-9
        cells = (high - low) / coarse.grid.cell_size
        assert cells == pytest.approx(round(cells))


def test_a_case_of_few_particles_is_its_own_pilot():
    case = load_case(CASES / "slump_fast.json")
    assert coarser(case) is case


def test_a_pilot_that_diverges_says_nothing():
    case = load_case(
        CASES / "slump_fast.json",
        ["grid.domain=" + json.dumps({"r": [0, 0.12], "z": [0, 0.32]}), "until=1.0"],
    )
    assert pilot(case, 10.0) is None  # the sheet leaves at the open face


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "overrides"),
    [("slump.json", COARSE), ("slump_quarter.json", ["until=0.3"]), ("slump_fast.json", [])],
)
def test_expected_time_is_that_of_the_run_within_half_as_much_again(file, overrides):
    """Both measured now, on this machine, however busy it is."""
    case = load_case(CASES / file, overrides)
    expected = plan(case, threads=1)["expected_seconds"]
    start = time.perf_counter()
    mpmkit.run(case, threads=1)
    taken = time.perf_counter() - start
    assert taken / 1.5 < expected < 1.5 * taken
