"""Cost of a run: counts, limits, and memory compared with the real allocation."""

import json
import math
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from mpmkit.case import load_case, parse_case
from mpmkit.plan import cost, plan
from mpmkit.solver.memory import (
    PASSING,
    bytes_per_particle,
    expected_bytes,
    expected_particles,
    wall_bytes,
    window_nodes,
)
from mpmkit.solver.simulation import Simulation

CASES = Path(__file__).parent.parent / "cases"
CONE = {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": 0.3}
TWO = {
    "mould": {
        "surface": {"kind": "body", "shape": CONE, "side": "inside", "thickness": 0.02},
        "contact": "slip",
    },
    "plate": {"surface": {"kind": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}, "contact": "stick"},
}
"""Walls of three dimensions."""


def test_the_paper_s_scene_is_planned_as_the_paper_has_it(monkeypatch):
    """Three of its steps, and no cheaper models: they have tests of their own, on scenes that cost less."""
    monkeypatch.setattr("mpmkit.plan.trial.TRIAL_SECONDS", 0.0)
    monkeypatch.setattr(cost, "WORTH_ADVICE", math.inf)
    ferreira = plan(load_case(CASES / "slump_ferreira.json"))
    assert ferreira["particles"] == pytest.approx(351_860, rel=1e-3)
    assert ferreira["nodes"] == [146, 146, 64]
    assert ferreira["steps"] == pytest.approx(388_000, rel=1e-2)
    assert ferreira["time_step"] == pytest.approx(1.03e-5, rel=1e-2)
    assert ferreira["sound_speed"] == [pytest.approx(121.3, rel=1e-3)]
    assert ferreira["limited_by"] == "acoustic"
    assert ferreira["time_step"] / ferreira["limits"]["viscous"] == pytest.approx(80, rel=0.02)
    (warning,) = ferreira["warnings"]
    assert "viscous limit of 1.28e-07 s 80.7-fold" in warning
    assert ferreira["expected_seconds"] > 0
    json.dumps(ferreira, allow_nan=False)


@pytest.mark.slow
def test_the_paper_s_scene_has_cheaper_models():
    found = plan(load_case(CASES / "slump_ferreira.json"))
    assert found["cheaper"]
    assert all(model["expected_seconds"] < found["expected_seconds"] for model in found["cheaper"])
    json.dumps(found, allow_nan=False)


SCENES = {
    "axisymmetric": ("slump.json", ["grid.cell_size=0.0025", "grid.domain.z=[0,0.305]"]),
    "quarter": ("slump_quarter.json", []),
    "stretch": ("slump.json", ["scheme.shape.domain=stretch"]),
    "linear": ("slump.json", ["scheme.shape=linear"]),
    "whole cone": (
        "slump_ferreira.json",
        [
            "grid.cell_size=0.01",
            "grid.domain=" + json.dumps({"x": [-0.36, 0.36], "y": [-0.36, 0.36], "z": [0, 0.31]}),
        ],
    ),
}


@pytest.mark.parametrize(("file", "overrides"), SCENES.values(), ids=SCENES)
def test_expected_memory_is_that_of_the_arrays(file, overrides):
    case = load_case(CASES / file, ["scheme.redistribution=none", *overrides])
    simulation = Simulation(case)
    simulation.operations.begin()
    n, operations = len(simulation.particles), simulation.operations
    assert expected_particles(case) == pytest.approx(n, rel=0.01)
    tables = operations.base, operations.weight, operations.gradient, operations.hoop
    held = simulation.particles.nbytes + sum(table.nbytes for table in tables)
    assert bytes_per_particle(case) - 8 * PASSING == pytest.approx(held / n, rel=0.03)
    assert window_nodes(case) == pytest.approx(1.25 * len(operations.window.nodes), rel=0.25)
    window = operations.window
    total = held + sum(a.base.nbytes for a in (window.nodes, window.pairs, window.average)) + 8 * PASSING * n
    assert expected_bytes(case, n) == pytest.approx(total, rel=0.25)


@pytest.mark.parametrize("file", ["slump.json", "slump_quarter.json"])
def test_expected_memory_has_room_for_a_redistribution(file):
    """What it takes while it works, at most, is what the estimate is larger by."""
    plain, case = (
        load_case(CASES / file, [f"scheme.redistribution={chosen}"]) for chosen in ("none", "even")
    )
    simulation = Simulation(case)
    operations, n = simulation.operations, len(simulation.particles)
    operations.begin()
    simulation.particles.velocity_gradient[:, 0, 1] = 1.0
    peaks = []
    for _ in range(2):  # at first there is code to be loaded as well
        operations.stage.shear = operations.stage.elapsed = 0.1
        operations.stage.restore(operations.stage.state())  # without the blocks of nodes that it keeps
        tracemalloc.start()
        try:
            assert operations.stage.redistribute_if_due(operations.window, operations.sorting)
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
        operations.begin()
    peak = peaks[-1]
    estimate = expected_bytes(case, n) - expected_bytes(plain, n)
    assert peak < estimate < 1.5 * peak


@pytest.mark.parametrize(
    ("file", "overrides"),
    [
        ("slump_lifted.json", []),
        ("slump_lifted.json", ["walls.mould.surface.motion.start=0.1", "grid.cell_size=0.01"]),
        ("slump_quarter.json", [f"walls={json.dumps(TWO)}"]),
    ],
)
def test_expected_memory_has_room_for_the_nodes_of_walls(file, overrides):
    case = load_case(CASES / file, ["grid.domain.z=[0, 0.31]", *overrides])
    simulation = Simulation(case)
    simulation.advance()
    held = 0
    for wall in simulation.operations.walls.walls:
        arrays = [*vars(wall.near).values(), *wall.near.memory.values()]
        held += sum({id(owner(a)): owner(a).nbytes for a in arrays if isinstance(a, np.ndarray)}.values())
    assert held < wall_bytes(case) < 1.6 * held
    plain = expected_bytes(case.model_copy(update={"walls": {}}), 1000)
    assert expected_bytes(case, 1000) == pytest.approx(plain + wall_bytes(case), rel=1e-6)


def owner(array):
    """The array whose memory an array shows a part of."""
    while isinstance(array.base, np.ndarray):
        array = array.base
    return array


def test_a_case_with_a_redistribution_is_planned():
    coarse = ["grid.cell_size=0.02", "grid.domain.z=[0,0.32]", "scheme.splitting=false", "until=0.1"]
    plain = plan(load_case(CASES / "slump.json", [*coarse, "scheme.redistribution=none"]))
    found = plan(load_case(CASES / "slump.json", [*coarse, "scheme.redistribution=even"]))
    assert found["particles"] == plain["particles"]
    assert found["memory_bytes"] > plain["memory_bytes"]


@pytest.mark.parametrize(
    ("file", "changes", "most"),
    [
        ("slump_ferreira.json", [], 700),
        ("slump_quarter_fine.json", ["scheme.redistribution=none"], 700),
        ("slump_quarter_fine.json", [], 950),
    ],
)
def test_a_particle_in_three_dimensions_takes_few_bytes(file, changes, most):
    """Nodes included; that ``plan`` says what the arrays take is asserted above.

    A redistribution needs splines of its own, on two lattices.
    """
    case = load_case(CASES / file, changes)
    particles = expected_particles(case)
    assert expected_bytes(case, particles) / particles < most


def test_a_wider_domain_takes_no_more_nodes():
    """The window over the material is all that is stored and all that is worked on."""
    wide = json.dumps({"x": [-2.4, 2.4], "y": [-2.4, 2.4], "z": [0, 0.62]})
    case, wider = (
        load_case(CASES / "slump_ferreira.json", ["grid.cell_size=0.02", f"grid.domain={domain}"])
        for domain in (json.dumps({"x": [-0.36, 0.36], "y": [-0.36, 0.36], "z": [0, 0.32]}), wide)
    )
    found = []
    for each in (case, wider):
        simulation = Simulation(each)
        simulation.advance()
        found.append(simulation.operations.window.shape)
    assert found[0] == found[1]


def test_a_kept_history_counts():
    data = json.loads((CASES / "slump.json").read_text())
    plain = expected_bytes(parse_case(data), 1000)
    data["output"] = {"particle_history": ["position", "stress"], "history_interval": 0.04}
    assert expected_bytes(parse_case(data), 1000) - plain == pytest.approx(2 * 100 * (2 + 6) * 8 * 1000)
