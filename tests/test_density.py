"""Density of the interior relative to that of the material: its definition, and when it stops a run."""

from __future__ import annotations

import logging

import numba
import numpy as np
import pytest

import mpmkit
from mpmkit.case import parse_case
from mpmkit.errors import GuardStop
from mpmkit.running.conclusion import conclude
from mpmkit.running.recorder import Recorder
from mpmkit.solver.density import density
from mpmkit.solver.simulation import Simulation

CELL, CELLS = 0.1, 8
FLUID = {"law": "newtonian", "density": 1000, "viscosity": 1.0, "sound_speed": 20.0}
RUBBER = {"law": "neo-hookean", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}
AXES = {"plane-strain": "xz", "3d": "xyz", "axisymmetric": "rz"}
spaces = pytest.mark.parametrize("space", AXES)


def scene(space="plane-strain", lower=None, upper=None, faces="slip", material=FLUID, **scheme):
    """A block, by default one that fills the domain from wall to wall."""
    axes = AXES[space]
    ends = [f"{a}_{side}" for a in axes for side in ("min", "max") if f"{a}_{side}" != "r_min"]
    lower, upper = lower or [0.0] * len(axes), upper or [CELLS * CELL] * len(axes)
    return Simulation(
        parse_case(
            {
                "space": space,
                "until": 1.0,
                "gravity": [0.0] * len(axes),
                "grid": {
                    "cell_size": CELL,
                    "domain": {a: [0, CELLS * CELL] for a in axes},
                    "faces": dict.fromkeys(ends, faces) if isinstance(faces, str) else faces,
                },
                "bodies": [{"shape": {"kind": "box", "lower": lower, "upper": upper}, "material": material}],
                "scheme": scheme,
            }
        )
    )


def found(simulation):
    return density(simulation.particles, simulation.grid, simulation.case.space_.radial)


@spaces
@pytest.mark.parametrize("faces", ["slip", "stick", "symmetry"])
def test_a_domain_that_is_full_has_the_density_of_its_material(space, faces):
    one = found(scene(space, faces=faces))
    assert (one.mean, one.worst, one.part) == pytest.approx((1.0, 1.0, 1.0), rel=1e-12)
    assert one.departure < 1e-12


@spaces
def test_of_a_block_the_surface_is_left_out(space):
    """Nodes within a cell of the surface lack neighbours, although the material there has the right
    density."""
    axes = AXES[space]
    lower = [0.0 if a == "r" else 2 * CELL for a in axes]
    one = found(scene(space, lower, [6 * CELL] * len(axes), {}))
    assert (one.mean, one.worst) == pytest.approx((1.0, 1.0), rel=1e-12)
    assert 0 < one.part < 1


def test_periodic_faces_are_no_surface():
    sides = {"x_min": "periodic", "x_max": "periodic", "z_min": "periodic", "z_max": "periodic"}
    simulation = scene(faces=sides)
    simulation.particles.position += [1.3, -0.7]  # steps lead out of the domain, and the next ones wrap
    one = found(simulation)
    assert (one.mean, one.worst, one.part) == pytest.approx((1.0, 1.0, 1.0), rel=1e-12)


@spaces
@pytest.mark.parametrize("factor", [0.9, 1.07])
def test_volumes_larger_than_the_space_of_the_particles(space, factor):
    """J changes but positions do not, so that each node holds more material than its volume."""
    simulation = scene(space)
    simulation.particles.volume *= factor
    one = found(simulation)
    assert (one.mean, one.worst, one.departure) == pytest.approx((factor, factor, abs(factor - 1)))


def test_a_body_that_is_compressed_as_it_says_has_its_density():
    """Pressure is no error: positions and volumes agree, in a fluid under its weight and in a solid."""
    simulation = scene(material=RUBBER, lower=[0.1, 0.1], upper=[0.7, 0.7], faces={})
    p = simulation.particles
    middle = p.position.mean(axis=0)
    p.position[:] = middle + 0.8 * (p.position - middle)
    assert found(simulation).mean > 1.4
    p.volume *= 0.8**2
    assert found(simulation).mean == pytest.approx(1.0, abs=0.01)


def test_too_high_and_too_low_densities_do_not_cancel():
    simulation = scene(faces="symmetry")  # at walls, too little would be material that leaves them
    p = simulation.particles
    left = p.position[:, 0] < CELLS * CELL / 2
    p.volume[left] *= 1.1
    p.volume[~left] *= 0.9
    one = found(simulation)
    assert one.mean == pytest.approx(1.0)
    assert 0.085 < one.departure < 0.1  # it changes over a cell or two in the middle
    assert abs(one.worst - 1) == pytest.approx(0.1)


def test_the_worst_place_is_where_particles_crowd():
    simulation = scene()
    p, there = simulation.particles, np.array([3 * CELL, 5 * CELL])
    near = np.linalg.norm(p.position - there, axis=1) < 1.2 * CELL
    p.position[near] = there + 0.3 * (p.position[near] - there)
    one = found(simulation)
    np.testing.assert_allclose(one.place, there)
    assert one.worst > 1.2
    assert one.departure < one.worst - 1


def test_without_an_interior_there_is_no_density():
    simulation = scene(lower=[0.2, 0.2], upper=[0.3, 0.6], faces={})
    one = found(simulation)
    assert np.isnan([one.mean, one.worst, one.departure]).all()
    assert one.part == 0
    simulation.particles.position[:] = np.nan
    assert np.isnan(found(simulation).mean)
    measures = simulation.measures(simulation.particles)
    assert np.isnan([measures["density_mean"], measures["density_worst"]]).all()


@spaces
def test_bits_depend_neither_on_threads_nor_on_a_sort(space):
    simulation = scene(space)
    p = simulation.particles
    p.position += np.random.default_rng(1).uniform(-0.01, 0.01, p.position.shape)
    np.clip(p.position, 1e-9, CELLS * CELL - 1e-9, out=p.position)
    states = []
    for threads in (1, 2):
        numba.set_num_threads(threads)
        states.append(found(simulation))
    assert states[0].mean == states[1].mean
    assert states[0].departure == states[1].departure
    simulation.operations.begin()
    assert found(simulation).departure == pytest.approx(states[0].departure, rel=1e-12)


# --- The watch over it


def squeezed(by, **scheme):
    """A block that is left without the room for its volume, after a step."""
    simulation = scene(lower=[0.1, 0.1], upper=[0.7, 0.7], faces={}, **scheme)
    simulation.advance()
    p = simulation.particles
    p.position[:] = 0.4 + (p.position - 0.4) / np.sqrt(by)
    return simulation


@pytest.mark.parametrize(
    ("scheme", "cure"),
    [
        ({"redistribution": "none"}, "scheme.redistribution 'even' keeps them consistent"),
        ({"redistribution": "even"}, "smaller cells or more particles_per_cell may keep them consistent"),
    ],
)
def test_a_departure_of_a_tenth_stops_a_run_with_a_sentence(scheme, cure):
    simulation = squeezed(1.2, **scheme)
    p = simulation.particles
    worst = found(simulation)
    with pytest.raises(GuardStop) as stop:
        simulation.check()
    error, said = stop.value, str(stop.value)
    assert (error.guard, error.exit_status, error.step) == ("density", 3, 1)
    nearest = p.number[np.argmin(np.linalg.norm(p.position - worst.place, axis=1))]
    assert error.particle == nearest
    assert said.startswith(f"stopped at step 1, t = {simulation.time:.6g} s: particle {nearest} is where the")
    assert f"density is worst, {worst.worst:.3g} times the right one" in said
    assert f"wrong by {100 * worst.departure:.2g} % on average" in said
    assert said.endswith(f"positions and volumes of the particles contradict each other; {cure}")


def test_the_sentence_for_a_solid_does_not_propose_a_redistribution():
    simulation = scene(material=RUBBER, redistribution="none")
    simulation.particles.volume *= 1.2
    with pytest.raises(GuardStop, match="smaller cells or more particles_per_cell"):
        simulation.check()


def test_a_smaller_departure_gives_a_warning():
    simulation = squeezed(1.07, redistribution="none")
    simulation.check()
    watch = simulation.guards.density
    assert watch.noted
    assert watch.most == pytest.approx(0.07, abs=0.01)
    assert watch.since == simulation.time


def test_a_body_with_few_interior_nodes_is_not_judged():
    """In a block of 6 × 4 cells only three nodes are in the interior: an eighth of its volume."""
    simulation = scene(lower=[0.1, 0.1], upper=[0.7, 0.5], faces={}, redistribution="none")
    simulation.particles.volume *= 1.3
    one = found(simulation)
    assert one.departure == pytest.approx(0.3, abs=0.01)
    assert one.part == pytest.approx(3 / 24 / 1.3)
    simulation.check()
    assert not simulation.guards.density.noted


TANK = {
    "name": "tank",
    "space": "plane-strain",
    "until": 5.0,
    "grid": {
        "cell_size": 0.04,
        "domain": {"x": [0, 1.52], "z": [0, 0.48]},
        "faces": dict.fromkeys(("x_min", "x_max", "z_min", "z_max"), "slip"),
    },
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0, 0], "upper": [0.56, 0.28]},
            "material": {
                "law": "bingham-evp",
                "density": 2300.0,
                "yield_stress": 40.0,
                "plastic_viscosity": 20.0,
                "sound_speed": {"factor": 10},
            },
        }
    ],
    "scheme": {"redistribution": "none"},
    "output": {"report": False},
}


def test_a_tank_whose_content_loses_volume_is_warned_of_and_stopped(tmp_path, caplog):
    """Without a redistribution. Before this guard, the run lost a quarter of its height and ended with status
    0."""
    with caplog.at_level(logging.WARNING), pytest.raises(GuardStop) as stop:
        mpmkit.run(parse_case(TANK), tmp_path / "run")
    assert stop.value.guard == "density"
    assert 0.5 < float(str(stop.value).partition("t = ")[2].partition(" s:")[0]) < 4.0
    warned = [r.message for r in caplog.records if r.message.startswith("inside the material the density")]
    assert len(warned) == 1
    assert "(history: density_mean, density_worst)" in warned[0]
    assert "scheme.redistribution 'even' keeps them consistent" in warned[0]


@pytest.mark.slow
def test_a_film_that_slows_down_is_stopped_before_it_has_lost_half_of_its_speed():
    """Without a redistribution: steady at 0.4204 m/s until 4.7 s; it would have 0.15 m/s at 12 s."""
    cell, height, exact = 0.005, 0.05, 0.4204
    film = {
        "space": "plane-strain",
        "until": 12.0,
        "gravity": [9.81 / 2, -9.81 * np.sqrt(0.75)],
        "grid": {
            "cell_size": cell,
            "domain": {"x": [0, 4 * cell], "z": [0, 15 * cell]},
            "faces": {"z_min": "stick", "x_min": "periodic", "x_max": "periodic"},
        },
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0, 0], "upper": [4 * cell, height]},
                "material": TANK["bodies"][0]["material"] | {"sound_speed": 20.0},
            }
        ],
        "scheme": {"redistribution": "none"},
    }
    simulation = Simulation(parse_case(film))
    p, watch = simulation.particles, simulation.guards.density

    def speed():
        return float(p.mass @ p.velocity[:, 0] / p.mass.sum())

    def advance_while(goes_on):
        while goes_on():
            simulation.advance()

    advance_while(lambda: not watch.noted)
    noted_at = simulation.time
    assert speed() == pytest.approx(exact, rel=0.02)
    with pytest.raises(GuardStop) as stop:
        advance_while(lambda: simulation.time < 12.0)
    assert stop.value.guard == "density"
    assert 3.0 < noted_at < simulation.time < 8.0
    assert speed() > 0.8 * exact


def test_the_warning_is_repeated_at_the_end(caplog):
    case = parse_case(TANK | {"until": 0.02})
    simulation = Simulation(case)
    recorder = Recorder(simulation, {}, None)
    recorder.record()
    simulation.advance()
    watch = simulation.guards.density
    watch.most, watch.since = 0.0712, 0.01
    with caplog.at_level(logging.WARNING):
        conclude(recorder, "finished", 1.0)
    assert [r.message for r in caplog.records] == [
        "at the end: inside the material the density is wrong by up to 7.1 % on average, since t = 0.01 s "
        "(history: density_mean, density_worst): positions and volumes of the particles contradict each "
        "other, so flow and height become wrong; scheme.redistribution 'even' keeps them consistent"
    ]


def test_a_watch_that_goes_on_remembers_the_worst():
    simulation = squeezed(1.07, redistribution="none")
    simulation.check()
    other = Simulation(simulation.case)
    other.restore(simulation.state())
    assert vars(other.guards.density) == vars(simulation.guards.density)
    assert other.guards.density.noted


def test_material_that_leaves_a_wall_is_not_too_thin():
    """Two cells of fluid move away from a wall: the gap behind them is not their interior."""
    block = scene(lower=[0.6, 0.0], upper=[0.8, 0.8], faces={"x_max": "slip"})
    assert found(block).part > 0
    for gap in (0.01, 0.1, 0.3):
        block.particles.position[:, 0] -= gap * CELL
        one = found(block)
        assert one.part == 0.0 or abs(one.worst - 1) < 0.04
