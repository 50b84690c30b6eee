"""The benchmark: it measures the work of a run, and its output has the documented entries."""

import json

import numpy as np
import pytest

from mpmkit.bench import SCENES
from mpmkit.bench.midflow import in_mid_flow
from mpmkit.bench.timing import KERNELS, timed
from mpmkit.cli import main
from mpmkit.solver.simulation import Simulation


@pytest.fixture(scope="module")
def small():
    return in_mid_flow(SCENES["small-axisymmetric"])


def test_mid_flow_is_no_lattice_and_keeps_mass_and_speed(small):
    """The body is the cone's concrete, on its way outwards, its particles anywhere in their cells."""
    p = small.particles
    cone = np.pi / 3 * 0.3 * (0.1**2 + 0.1 * 0.05 + 0.05**2)  # m³
    assert p.mass.sum() == pytest.approx(2574 * cone, rel=1e-3)
    front = 0.29  # m/s, of the reference curve of D(t) at 0.3 s
    assert front / 3 < np.sqrt(np.average(p.velocity[:, 0] ** 2, weights=p.mass)) < front
    within = p.position / small.grid.cell_size % 1
    assert np.histogram(within[:, 0], bins=8, range=(0, 1))[0].min() > 0.05 * len(p)


def test_cutting_keeps_mass_momentum_and_the_boxes_volume():
    scene = SCENES["accurate-axisymmetric"]
    small = {**scene.case, "grid": {**scene.case["grid"], "cell_size": 0.005}}
    cut = in_mid_flow(type(scene)("cut", "", small, coarser=2))
    coarse = in_mid_flow(
        type(scene)("coarse", "", {**small, "grid": {**small["grid"], "cell_size": 0.01}}, 1)
    )
    assert len(cut.particles) == 4 * len(coarse.particles)
    for field in ("mass", "volume"):
        whole, parts = (getattr(s.particles, field).sum() for s in (coarse, cut))
        assert parts == pytest.approx(whole, rel=1e-9)
    momenta = [np.average(s.particles.velocity[:, 1], weights=s.particles.mass) for s in (coarse, cut)]
    assert momenta[0] == pytest.approx(momenta[1], rel=1e-3)


def test_kernels_add_up_to_the_step(small):
    timing = timed(small, "small", 1, 0.2)
    assert set(timing.kernels) == {*KERNELS, "outside"}
    assert all(spent >= 0 for spent in timing.kernels.values())
    assert timing.kernels["particles to nodes"] > 0
    assert sum(timing.kernels.values()) == pytest.approx(1e9 / timing.particle_steps_per_second)


def test_the_stopwatch_restores_the_original_functions(small):
    names = set(vars(small.operations))
    timed(small, "small", 1, 0.05)
    assert set(vars(small.operations)) == names


def test_json(capsys):
    with pytest.raises(SystemExit) as stop:
        main(["bench", "small-axisymmetric", "--threads", "1", "--seconds", "0.1", "--json"])
    assert stop.value.code == 0
    (timing,) = json.loads(capsys.readouterr().out)
    assert set(timing) == {"scene", "particles", "threads", "particle_steps_per_second", "kernels"}
    assert timing["scene"] == "small-axisymmetric"
    assert timing["threads"] == 1
    assert timing["particle_steps_per_second"] > 0


def test_a_scene_that_is_not_there(capsys):
    with pytest.raises(SystemExit) as stop:
        main(["bench", "slum"])
    assert stop.value.code == 2
    assert "scene is 'slum'; it must be one of seed-3d" in capsys.readouterr().err


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_every_scene_is_a_valid_case(scene):
    from mpmkit.case import parse_case

    assert parse_case(scene.case).name == scene.name


def test_a_simulation_goes_on_from_a_state(small):
    """From the same state, the same step, to the bit."""
    import copy

    states = [copy.deepcopy(small.particles) for _ in range(2)]
    runs = [Simulation(small.case, state) for state in states]
    for run in runs:
        run.advance(1e-5)
    assert np.array_equal(runs[0].particles.position, runs[1].particles.position)
