"""Body forces: their impulse on the material and their entries in the ledger are exact."""

from __future__ import annotations

import copy
import math
from typing import ClassVar

import numpy as np
import pytest
import xarray

import mpmkit
from mpmkit.case import parse_case
from mpmkit.case.forewarnings import forewarnings
from mpmkit.case.plausibility import implausible
from mpmkit.case.resolved import resolved
from mpmkit.contracts import BodyForce, GeneralisedNewtonianLaw
from mpmkit.errors import CaseError, GuardStop
from mpmkit.plan.symmetry import planes_of_symmetry
from mpmkit.registry import Registered, Registry, installed
from mpmkit.running.milestones import LOOKS, Milestones
from mpmkit.running.runner import resume
from mpmkit.solver.ledger import ENERGY, FORCES, GRAVITY, REST
from mpmkit.solver.simulation import Simulation

MUD = {"law": "bingham-evp", "density": 1500, "yield_stress": 20, "plastic_viscosity": 5, "sound_speed": 15}
BLOCK = {
    "space": "plane-strain",
    "until": 0.2,
    "gravity": [0, 0],
    "grid": {"cell_size": 0.02, "domain": {"x": [-1, 1], "z": [-1, 1]}},
    "bodies": [{"shape": {"kind": "box", "lower": [-0.05, -0.05], "upper": [0.05, 0.05]}, "material": MUD}],
    "output": {"report": False},
}
"""A block that floats."""
TILT = {"kind": "gravity-table", "times": [0.02, 0.1], "vectors": [[0, -9.81], [3, -9.0]]}
VIBRATES = {"kind": "oscillation", "amplitude": [0.001, 0.002], "frequency": 50}
SHORT = {"kind": "moving-frame", "times": [0, 0.05, 0.0500001], "velocities": [[0, 0], [0, -0.5], [0, 0]]}


def a_case(forces, **changes):
    return parse_case(copy.deepcopy(BLOCK) | {"forces": forces} | changes)


def advanced(forces, steps=200, **changes):
    simulation = Simulation(a_case(forces, **changes))
    for _ in range(steps):
        simulation.advance()
    return simulation


def run_on(simulation, steps=100):
    for _ in range(steps):
        simulation.advance()


def mean_velocity(simulation):
    p = simulation.particles
    return p.mass @ p.velocity / p.mass.sum()


# --- What the material gets


def test_the_long_form_of_gravity_is_the_short_one_to_the_bit():
    key = advanced({}, gravity=[1.0, -9.81])
    force = advanced({"weight": {"kind": "gravity", "vector": [1.0, -9.81]}}, gravity=None)
    np.testing.assert_array_equal(force.particles.position, key.particles.position)
    np.testing.assert_array_equal(force.account(), key.account())
    assert force.account()[GRAVITY, ENERGY] > 0


def test_a_force_that_stands_for_gravity_is_all_the_gravity_there_is():
    case = a_case({"tilt": TILT}, gravity=None)
    assert not case.gravity_vector.any()
    np.testing.assert_array_equal(case.gravity_at_start, [0, -9.81])
    again = parse_case(resolved(case))
    assert not again.gravity_vector.any()
    assert a_case({"v": VIBRATES}, gravity=None).gravity_vector.tolist() == [0, -9.81]


@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
def test_a_block_that_floats_has_the_integral_of_the_acceleration(order):
    """A table by the trapezoidal rule, a mould by its velocity, a stop that is far shorter than a step."""
    scheme = {"scheme": {"order": order}}
    tilted = advanced({"tilt": TILT}, **scheme)
    late = tilted.time - 0.1
    assert late > 0
    expected = np.array([3 * 0.08 / 2 + 3 * late, -9.81 * 0.02 - 0.08 * (9.81 + 9) / 2 - 9 * late])
    np.testing.assert_allclose(mean_velocity(tilted), expected, rtol=1e-12)
    shaken = advanced({"v": VIBRATES}, **scheme)
    rate = 2 * math.pi * 50
    expected = np.array([0.001, 0.002]) * rate * math.sin(rate * shaken.time)
    np.testing.assert_allclose(mean_velocity(shaken), expected, rtol=1e-10)
    before = advanced({"s": SHORT}, steps=90, **scheme)
    assert 0.01 < before.time < 0.05
    np.testing.assert_allclose(mean_velocity(before), [0, 10 * before.time], rtol=1e-12, atol=1e-15)
    assert before.time_step > 1e3 * 1e-7
    while before.time < 0.051:
        before.advance()
    np.testing.assert_allclose(mean_velocity(before), [0, 0], atol=1e-13)


def test_a_vector_turns():
    """The integral of g (sin α, -cos α) with α = 2 (t - 0.01), until 0.05 s."""
    turning = {"kind": "turning-gravity", "vector": [0, -9.81], "rate": 2, "start": 0.01, "end": 0.05}
    simulation = advanced({"g": turning}, gravity=None)
    angle, late = 0.08, simulation.time - 0.05
    turned = np.array([(1 - math.cos(angle)) / 2, -math.sin(angle) / 2])
    expected = 9.81 * (np.array([0, -0.01]) + turned + late * np.array([math.sin(angle), -math.cos(angle)]))
    np.testing.assert_allclose(mean_velocity(simulation), expected, rtol=1e-12)


def rotating(fraction):
    """A block at rest in the laboratory, seen from a frame that rotates, after about a third of a turn."""
    frame = {"kind": "rotating-frame", "point": [0.1, 0.0], "rate": 4.0}
    body = {"shape": {"kind": "box", "lower": [0.44, -0.06], "upper": [0.56, 0.06]}, "material": MUD}
    simulation = Simulation(a_case({"turn": frame}, bodies=[body]), fraction=fraction)
    p = simulation.particles
    start = p.position + simulation.grid.lower - [0.1, 0.0]
    p.velocity[:] = -4.0 * start @ np.array([[0, 1.0], [-1.0, 0]])
    while simulation.time < 0.5:
        simulation.advance()
    mean = p.mass @ (p.position + simulation.grid.lower) / p.mass.sum() - [0.1, 0.0]
    angle = -4.0 * simulation.time
    off = np.linalg.norm(mean - 0.4 * np.array([math.cos(angle), math.sin(angle)]))
    return simulation, off / 0.4, np.linalg.norm(mean) / 0.4


def test_what_rests_in_the_laboratory_circles_in_a_rotating_frame():
    """On the circle to the first order of the step, as all places are, and with the energy of the frame."""
    coarse, off, radius = rotating(0.5)
    _, off_fine, _ = rotating(0.125)
    assert off < 2 * 4.0 * coarse.time_step
    assert off_fine < 0.3 * off
    assert radius == pytest.approx(1, abs=4.0 * coarse.time_step)
    p, account = coarse.particles, coarse.account()
    x = p.position + coarse.grid.lower - [0.1, 0.0]
    jacobi = p.mass @ ((p.velocity**2).sum(axis=1) - 16.0 * (x**2).sum(axis=1)) / 2
    assert abs(jacobi) < 4 * 4.0 * coarse.time_step * account[:, ENERGY].sum()
    assert abs(account[REST, ENERGY]) < 1e-3 * account[:, ENERGY].sum()


def test_fluid_in_a_centrifuge_is_pressed_outwards():
    """p = ρ ω² r²/2 and a constant where it rests against a wall, in the mean of its oscillations."""
    water = {"law": "newtonian", "density": 1000, "viscosity": 5.0, "sound_speed": 20}
    simulation = Simulation(
        a_case(
            {"turn": {"kind": "centrifugal", "rate": 10.0}},
            space="axisymmetric",
            grid={
                "cell_size": 0.02,
                "domain": {"r": [0, 0.2], "z": [0, 0.02]},
                "faces": {"r_max": "slip", "z_min": "slip", "z_max": "slip"},
            },
            bodies=[{"shape": {"kind": "cylinder", "radius": 0.2, "height": 0.02}, "material": water}],
        )
    )
    slopes = []
    while simulation.time < 0.31:
        simulation.advance()
        p = simulation.particles
        slopes.append(np.polyfit(p.position[:, 0] ** 2, p.mapped_pressure, 1)[0])
    assert np.mean(slopes) == pytest.approx(1000 * 10.0**2 / 2, rel=0.03)


# --- The ledger


@pytest.mark.parametrize("velocity", ["apic", "flip", "pic"])
def test_the_work_of_each_force_is_exact(velocity):
    """A floating block has exactly the energy and momentum that the two forces gave it."""
    simulation = advanced({"tilt": TILT, "v": VIBRATES}, scheme={"velocity": velocity})
    account = simulation.account()
    work = simulation.force_work
    assert work.shape == (2,)
    assert (np.abs(work) > 0.01).all()
    kinetic = account[:, ENERGY].sum()
    assert account[FORCES, ENERGY] == pytest.approx(kinetic, rel=1e-12)
    assert abs(account[REST, 1:]).max() < 1e-12 * account[FORCES, 1:].max()


def test_the_history_has_the_work_and_power_by_name(tmp_path):
    case = a_case({"tilt": TILT, "v": VIBRATES}, until=0.1, gravity=None)
    history = mpmkit.run(case, tmp_path / "run")
    assert history.force.values.tolist() == ["tilt", "v"]
    assert history.force_work.attrs["units"] == "J"
    assert history.force_power.attrs["units"] == "W"
    summed = (history.force_power * history.time.diff("time")).sum("time")
    np.testing.assert_allclose(summed, history.force_work[-1], rtol=1e-9)
    both = history.force_work.sum("force")
    np.testing.assert_allclose(history.ledger_energy.sel(cause="forces"), both, rtol=1e-12, atol=1e-15)
    assert (history.potential_energy == 0).all()


# --- The scene follows


def test_a_fluid_at_rest_starts_with_the_pressure_of_its_weight_under_a_table():
    grid = {
        "cell_size": 0.02,
        "domain": {"x": [0, 0.1], "z": [0, 0.2]},
        "faces": {"x_min": "slip", "x_max": "slip", "z_min": "slip"},
    }
    body = {"shape": {"kind": "box", "lower": [0, 0], "upper": [0.1, 0.16]}, "material": MUD}
    simulation = Simulation(a_case({"tilt": TILT}, gravity=None, grid=grid, bodies=[body]))
    assert simulation.starts_under_weight
    lowest = simulation.particles.position[:, 1] < 0.01
    assert simulation.particles.pressure[lowest] == pytest.approx(1500 * 9.81 * 0.155, rel=0.01)


def test_the_step_resolves_a_fast_oscillation():
    fast = {"kind": "oscillation", "amplitude": [1e-6, 0], "frequency": 2e4}
    simulation = advanced({"v": fast}, steps=1)
    assert simulation.limited_by == "forces"
    assert simulation.time_step == pytest.approx(5e-5 / 20)
    assert advanced({"v": VIBRATES}, steps=1).limited_by == "acoustic"


def test_the_sound_speed_knows_the_forces():
    material = MUD | {"sound_speed": {"factor": 10}}
    bodies = [BLOCK["bodies"][0] | {"material": material}]
    case = a_case({"v": VIBRATES}, bodies=bodies)
    peak = np.array([0.001, 0.002]) * (2 * math.pi * 50) ** 2
    speed = case.sound_speed(case.bodies[0].material)
    assert speed == pytest.approx(10 * math.sqrt(2 * peak.sum() * 0.1))
    with pytest.raises(CaseError, match=r"is a factor of √\(2 g h\), but gravity is"):
        a_case({}, bodies=bodies)


def test_material_is_not_at_rest_while_gravity_still_changes():
    """It has been fast, and hardly moves any more: at rest from the end of the table on, or never."""

    def rests(forces):
        simulation = Simulation(a_case(forces, gravity=None))
        milestones = Milestones(simulation)
        milestones._seen.fastest = 100.0
        for _ in range(10 * LOOKS):
            milestones.watch()
            simulation.advance()
        milestones.watch()
        assert simulation.time > 0.08
        return milestones.at_rest_since

    table = {"kind": "gravity-table", "times": [0, 0.05], "vectors": [[0, 0], [0, -1e-3]]}
    assert 0.05 <= rests({"tilt": table}) < 0.08
    assert rests({"g": {"kind": "gravity", "vector": [0, -1e-3]}}) < 0.02
    shaken = {"kind": "oscillation", "amplitude": [1e-9, 0], "frequency": 10}
    assert rests({"v": shaken, "g": {"kind": "gravity", "vector": [0, 0]}}) is None
    assert rests({"v": shaken | {"end": 0.05}, "g": {"kind": "gravity", "vector": [0, 0]}}) >= 0.05


def test_plan_offers_no_quarter_of_a_scene_with_forces():
    case = {
        "space": "3d",
        "until": 0.1,
        "grid": {"cell_size": 0.1, "domain": {a: [-1, 1] for a in "xyz"}},
        "bodies": [{"shape": {"kind": "cylinder", "radius": 0.2, "height": 0.2}, "material": MUD}],
    }
    assert planes_of_symmetry(parse_case(case)) is not None
    table = {"kind": "gravity-table", "times": [0, 1], "vectors": [[0, 0, -9.81], [1, 0, -9.81]]}
    assert planes_of_symmetry(parse_case(case | {"forces": {"t": table}})) is None


def test_a_floor_is_missed_under_a_table_too():
    case = a_case({"tilt": TILT}, gravity=None, until=2.0)
    assert any("has no floor" in sentence for sentence in forewarnings(case))


def test_a_stop_in_no_time_is_noticed():
    said = " ".join(implausible(a_case({"s": SHORT})))
    assert "forces.s accelerates by up to 5e+06 m/s²; usual is up to 1000 m/s²" in said
    assert not any("forces.s" in text for text in implausible(a_case({"v": VIBRATES})))


def test_a_resumed_run_has_the_same_bits(tmp_path):
    frame = {"kind": "rotating-frame", "point": [0, 0], "times": [0.0, 0.1], "rates": [0, 3]}
    data = copy.deepcopy(BLOCK) | {"forces": {"tilt": TILT, "turn": frame}, "gravity": None}
    rows = {"report": False, "history_interval": 0.002, "frame_interval": 0.1}
    mpmkit.run(parse_case(data | {"until": 0.1, "output": rows}), tmp_path / "once")
    mpmkit.run(parse_case(data | {"until": 0.06, "output": rows}), tmp_path / "short")
    resume(tmp_path / "short", until=0.1)
    with (
        xarray.open_dataset(tmp_path / "short" / "history.nc") as again,
        xarray.open_dataset(tmp_path / "once" / "history.nc") as once,
    ):
        assert (np.abs(once.force_work[-1]) > 0.01).all()
        xarray.testing.assert_identical(again.drop_attrs(), once.drop_attrs())


# --- The clock


class Clock(GeneralisedNewtonianLaw):
    """A law that records the times of its calls."""

    name, citation, api_version = "clock", "none", 2
    seen: ClassVar[list[float]] = []

    def apparent_viscosity(self, shear_rate, state=None):
        return np.full_like(shear_rate, 1.0)

    def update_stress(self, kinematics, state, dt, stress):
        self.seen.append(kinematics.time)
        super().update_stress(kinematics, state, dt, stress)


def test_a_law_and_an_order_read_the_clock():
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered("law", Clock, "tests", "1", "clock")], [])
    material = {"law": "clock", "density": 1500, "sound_speed": 15}
    data = copy.deepcopy(BLOCK) | {"bodies": [BLOCK["bodies"][0] | {"material": material}]}
    simulation = Simulation(parse_case(data, registry=registry))
    Clock.seen.clear()
    times = []
    for _ in range(5):
        times.append(simulation.time)
        simulation.advance()
    assert sorted(set(Clock.seen)) == times
    assert simulation.operations.time == simulation.time
    assert simulation.operations.stage.time == simulation.refiner.time == simulation.time


# --- What is wrong

QUARTER = {
    "grid": {"cell_size": 0.02, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"x_min": "symmetry"}},
    "bodies": [{"shape": {"kind": "box", "lower": [0, 0], "upper": [0.1, 0.1]}, "material": MUD}],
}
RADIAL = {
    "space": "axisymmetric",
    "grid": {"cell_size": 0.02, "domain": {"r": [0, 1], "z": [0, 1]}},
    "bodies": [{"shape": {"kind": "cylinder", "radius": 0.1, "height": 0.1}, "material": MUD}],
}
PERIODIC = {
    "grid": {
        "cell_size": 0.02,
        "domain": {"x": [-1, 1], "z": [-1, 1]},
        "faces": {"x_min": "periodic", "x_max": "periodic"},
    }
}
TURN = {"kind": "rotating-frame", "point": [0, 0], "rate": 3.0}


@pytest.mark.parametrize(
    ("force", "changes", "sentence"),
    [
        (TILT, {"gravity": [0, -9.81]}, "gravity is [0.0, -9.81], and forces.f of the kind 'gravity-table'"),
        (TILT, QUARTER | {"gravity": None}, "forces.f accelerates material across x_min, a plane of symm"),
        (TURN, QUARTER, "forces.f accelerates material across x_min, a plane of symmetry"),
        (TILT, RADIAL | {"gravity": None}, "forces.f has a part along r on the axis of symmetry"),
        (TURN, RADIAL, "forces.f: the space axisymmetric has no velocity around its axis"),
        (TURN, PERIODIC, "forces.f is not the same at x_min and x_max, which are periodic"),
        (VIBRATES | {"amplitude": [1, 2, 3]}, {}, "forces.f: amplitude is [1.0, 2.0, 3.0], but the sp"),
        (VIBRATES | {"frequency": 0}, {}, "forces.f.frequency is 0; it must be"),
        (VIBRATES | {"start": 1, "end": 1}, {}, "end is 1 s; it must be above start, 1 s"),
        (TILT | {"times": [0, 0]}, {"gravity": None}, "times has 0 s after 0 s; each must be above the one"),
        (TILT | {"times": [0, 1, 2]}, {"gravity": None}, "vectors has 2 entries and times 3; there must be"),
        (SHORT | {"period": 0.01}, {}, "period is 0.01 s; it must be at least the 0.0500001 s of the table"),
        (SHORT | {"count": 3}, {}, "count is 3, but there is no period"),
        (SHORT | {"count": 2.5, "period": 1}, {}, "count is 2.5; it must be a whole number"),
        (TURN | {"rates": [1, 2]}, {}, "it must have either rate, or times and rates"),
        (TURN | {"axis": [0, 0, 1]}, {}, "but in the space plane-strain it is out of the plane"),
        ({"kind": "oscilation"}, {}, 'did you mean "oscillation"?'),
        (
            {"kind": "gravity", "vector": [1, -9.81]},
            RADIAL | {"gravity": None},
            "gravity is [1.0, -9.81]; along r it must be 0 in an axisymmetric scene",
        ),
        ({"kind": "centrifugal", "rate": 1, "point": [0.1, 0]}, RADIAL, "it must be [0, z], on the axis"),
    ],
)
def test_a_wrong_force_has_its_sentence(force, changes, sentence):
    with pytest.raises(CaseError) as error:
        a_case({"f": force}, **changes)
    assert sentence in str(error.value)


def test_a_faulty_force_is_named():
    class Breaks(BodyForce):
        name, citation, api_version = "breaks", "none", 2

        def acceleration(self, x, v, t):
            return np.zeros_like(x) if t < 0.01 else np.zeros(3)

        def largest(self, lower, upper, t0, t1):
            return np.zeros(len(lower))

    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered("body_force", Breaks, "tests", "1", "breaks")], [])
    simulation = Simulation(parse_case(copy.deepcopy(BLOCK) | {"forces": {"f": "breaks"}}, registry=registry))
    with pytest.raises(GuardStop, match=r"'breaks' \(body force\) returned .* from mean_acceleration; it mu"):
        run_on(simulation)
