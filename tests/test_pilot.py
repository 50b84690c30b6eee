"""The prediction of a pilot run on coarse cells, compared with the run."""

import json
import math
import time
from pathlib import Path

import pytest

import mpmkit
from mpmkit.case import load_case
from mpmkit.plan import plan
from mpmkit.plan.cost import _mean_seconds
from mpmkit.plan.part_clock import PartClock
from mpmkit.plan.pilot import FEW, Growth, coarser, pilot
from mpmkit.plan.trial import Trial
from mpmkit.plan.wall_load import IDLE, TOUCHED, load
from mpmkit.solver.memory import expected_particles
from mpmkit.solver.simulation import Simulation

CASES = Path(__file__).parent.parent / "cases"
CELLS_10 = ["grid.cell_size=0.01", 'grid.domain={"r": [0, 0.36], "z": [0, 0.31]}']
COARSE = [*CELLS_10, "until=0.6"]
CONE = {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": 0.3}
LIFT = {"kind": "velocity", "velocity": [0, 0, 0.3]}
MOULD = {
    "mould": {
        "surface": {"kind": "body", "shape": CONE, "side": "inside", "thickness": 0.02, "motion": LIFT},
        "contact": "slip",
    }
}
"""That of the lifted slump in three dimensions."""
SCENES = {
    "split": COARSE,
    "sound that follows": [*COARSE, 'bodies.0.material.sound_speed={"mach": 0.1}'],
}


@pytest.mark.parametrize("overrides", SCENES.values(), ids=SCENES)
def test_steps_and_particles_to_come_are_those_of_the_run(overrides, monkeypatch):
    """A fast machine takes this run for too short to be worth a pilot; here it gets one on any machine."""
    monkeypatch.setattr("mpmkit.plan.cost.WORTH_A_PILOT", 0.0)
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
    [
        ("slump.json", COARSE),
        ("slump_quarter.json", ["until=0.3"]),
        ("slump_fast.json", []),
        ("slump_lifted.json", [*CELLS_10, "until=1"]),
        ("slump_quarter.json", ["until=0.3", f"walls={json.dumps(MOULD)}"]),
    ],
)
def test_expected_time_is_that_of_the_run_within_half_as_much_again(file, overrides):
    """Both are measured at the same time, so that other work on the machine affects both."""
    case = load_case(CASES / file, overrides)
    expected = plan(case, threads=1)["expected_seconds"]
    start = time.perf_counter()
    mpmkit.run(case, threads=1)
    taken = time.perf_counter() - start
    assert taken / 1.5 < expected < 1.5 * taken


def advanced(case, until):
    """A simulation at a time, and what its walls had to do on the way, the mean over the steps."""
    simulation, loads = Simulation(case), []
    while simulation.time < until:
        simulation.advance(until - simulation.time)
        loads.append(load(simulation))
    return simulation, sum(loads) / len(loads)


def test_a_mould_costs_what_it_has_to_do_and_nothing_once_it_is_away():
    """Its pilot has a fifth of the nodes near the mould; what is foretold is that of the case's own."""
    case = load_case(CASES / "slump_lifted.json", [*CELLS_10, "until=0.35"])
    simulation, start = advanced(case, 0.02)
    near = [len(wall.near.at) for wall in simulation.operations.walls.walls]
    assert start == pytest.approx(IDLE + TOUCHED + sum(near), rel=0.05)
    simulation, mean = advanced(case, 0.35)
    assert load(simulation) == IDLE  # lifted by 0.1 m: nothing touches it
    assert mean < 0.8 * start
    growth = pilot(case, 60.0)
    assert not growth.of_the_case
    assert growth.walls == pytest.approx(mean, rel=0.2)


def test_a_pilot_keeps_cells_no_wider_than_the_thinnest_wall():
    case = load_case(CASES / "slump_lifted.json", [*CELLS_10, "walls.mould.surface.thickness=0.014"])
    assert coarser(case).grid.cell_size == pytest.approx(0.014)


def test_the_seconds_of_a_step_follow_what_walls_and_redistributions_have_to_do():
    start = Trial(2e-3, of_walls=1e-3, load=1000.0, redistributing=10e-3, redistributions=0.0, stopped=[])
    nan = math.nan
    for walls, often, expected in (
        (1000.0, 0.0, 3e-3),
        (100.0, 0.0, 2.1e-3),
        (3000.0, 0.0, 5e-3),
        (nan, nan, 3e-3),
        (1000.0, 50.0, 3.5e-3),  # in every twentieth step of 1 ms
        (1000.0, 5000.0, 13e-3),  # never more than once in a step
    ):
        growth = Growth(1.0, 1.0, 1.0, nan, nan, nan, nan, walls, often, of_the_case=False)
        assert _mean_seconds(start, 1000, growth, 1e-3) == pytest.approx(expected)
    assert start.step == pytest.approx(3e-3)


def test_a_pilot_counts_the_redistributions_of_a_second_of_the_flow():
    case = load_case(CASES / "slump_lifted.json", [*CELLS_10, "until=0.25"])
    simulation = Simulation(case)
    parts = PartClock(simulation)
    while simulation.time < case.until:
        simulation.advance(case.until - simulation.time)
    assert parts.redistributions > 20
    assert pilot(case, 60.0).redistributions == pytest.approx(parts.redistributions / case.until, rel=0.5)


def test_the_clock_of_the_parts_changes_no_bits_and_counts_no_second_twice():
    case = load_case(CASES / "slump_lifted.json", CELLS_10)
    plain, timed = Simulation(case), Simulation(case)
    parts = PartClock(timed)
    begin = time.perf_counter()
    for simulation in (timed, plain):
        for _ in range(300):
            simulation.advance()
    assert parts.redistributing > 0
    assert parts.walls > 0
    assert parts.seconds < time.perf_counter() - begin
    assert (plain.particles.velocity == timed.particles.velocity).all()
    before = parts.seconds
    plain.advance()
    assert parts.seconds == before


def test_without_walls_there_is_nothing_to_do():
    simulation, mean = advanced(load_case(CASES / "slump_fast.json"), 0.01)
    assert (load(simulation), mean) == (0.0, 0.0)
