"""What a plug-in gives back, or writes where it must not: it is named, before anything else comes to harm."""

from __future__ import annotations

import json
import math

import numba
import numpy as np
import pytest

import mpmkit
from mpmkit.case.plugins import plugins_of
from mpmkit.contracts import (
    ConstitutiveLaw,
    ElastoviscoplasticLaw,
    EquationOfState,
    GeneralisedNewtonianLaw,
    ShapeFunction,
    StateVariable,
    VelocityUpdate,
    VolumetricTreatment,
)
from mpmkit.errors import GuardStop
from mpmkit.registry import Registered, Registry, installed
from mpmkit.registry.blame import blaming_plugins

FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 1.0, "sound_speed": 10.0}
N = 64


def simulation(kind, plugin):
    """A falling block with one plug-in of the tests."""
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered(kind, plugin, "tests", "1", plugin.name)], [])
    case = {
        "space": "plane-strain",
        "until": 1.0,
        "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
        "bodies": [
            {"shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]}, "material": dict(FLUID)}
        ],
    }
    if kind == "law":
        case["bodies"][0]["material"] = {"law": plugin.name, "density": 1000.0, "sound_speed": 10.0}
    elif kind == "equation_of_state":
        case["bodies"][0]["material"]["equation_of_state"] = plugin.name
    else:
        case["scheme"] = {kind: plugin.name}
    return mpmkit.Simulation(mpmkit.parse_case(json.loads(json.dumps(case)), registry=registry))


def blamed(kind, plugin, steps=3):
    """What is said of it within a few steps."""
    made = simulation(kind, plugin)

    def run():
        with blaming_plugins(plugins_of(made.case), lambda: (made.steps, made.time)):
            for _ in range(steps):
                made.advance()

    with pytest.raises(GuardStop) as stop:
        run()
    assert f"the plug-in '{plugin.name}' ({kind.replace('_', ' ')})" in str(stop.value)
    assert stop.value.guard == "plug-in-error"
    return str(stop.value)


class Law(ConstitutiveLaw):
    name = "of-the-tests"
    api_version = 1
    citation = "none"
    state = {"age": StateVariable("s", "age")}

    def update_stress(self, kinematics, state, dt, stress):
        stress[:] = 0.0


class Viscous(GeneralisedNewtonianLaw):
    name = "of-the-tests"
    api_version = 1
    citation = "none"


class Yielding(ElastoviscoplasticLaw):
    name = "of-the-tests"
    api_version = 1
    citation = "none"


@numba.njit
def _one_too_far(stress):
    for p in range(len(stress) + 1):
        stress[p, 0] = 1.0


def test_a_law_that_writes_beyond_its_stress():
    class Overrun(Law):
        def update_stress(self, kinematics, state, dt, stress):
            _one_too_far(stress)

    assert "wrote beyond the ends of the array 'stress'" in blamed("law", Overrun, steps=1)


def test_a_law_that_writes_beyond_its_state():
    class Overrun(Law):
        def update_stress(self, kinematics, state, dt, stress):
            stress[:] = 0.0
            beyond = np.lib.stride_tricks.as_strided(state["age"], (len(stress) + 1,))
            beyond += dt

    assert "wrote beyond the ends of the array 'state 'age''" in blamed("law", Overrun, steps=1)


def test_a_law_that_reads_beyond_its_arrays_finds_no_number_there():
    class Overrun(Law):
        def update_stress(self, kinematics, state, dt, stress):
            ratio = np.lib.stride_tricks.as_strided(kinematics.volume_ratio, (len(stress) + 1,))
            stress[:] = ratio[1:, None]

    assert "a stress that is not finite" in blamed("law", Overrun, steps=1)


@pytest.mark.parametrize("field", ["velocity_gradient", "volume_ratio", "pressure"])
def test_a_law_that_writes_to_what_it_may_only_read(field):
    class Meddler(Law):
        def update_stress(self, kinematics, state, dt, stress):
            getattr(kinematics, field)[-1] += 1e-3

    assert f"changed '{field}', which it may only read" in blamed("law", Meddler, steps=1)


def test_a_law_that_returns_its_stress():
    class Returning(Law):
        def update_stress(self, kinematics, state, dt, stress):
            return np.zeros_like(stress)

    assert "returned an array of shape (64, 6); it must write into 'stress'" in blamed("law", Returning)


def test_a_law_that_replaces_its_state():
    class Replacing(Law):
        def update_stress(self, kinematics, state, dt, stress):
            state["age"] = state["age"] + dt

    assert "replaced the array of its state 'age'" in blamed("law", Replacing)


def test_a_law_that_gives_one_particle_no_number_later_on():
    class Late(Law):
        def update_stress(self, kinematics, state, dt, stress):
            state["age"] += dt
            stress[:] = 0.0
            if state["age"][0] > 2.5 * dt:
                stress[17, 2] = np.nan

    said = blamed("law", Late, steps=4)
    assert "stopped at step 2, " in said
    assert "gave particle " in said


@pytest.mark.parametrize("viscosity", [7.0, np.ones(N - 1), np.ones((N, 1)), [1.0] * N], ids=str)
def test_a_viscosity_of_another_shape(viscosity):
    class Misshapen(Viscous):
        def apparent_viscosity(self, shear_rate):
            return viscosity if len(shear_rate) == N else np.ones_like(shear_rate)

    said = blamed("law", Misshapen)
    assert "apparent_viscosity returned a" in said
    assert "it must return an array of shape (64,)" in said


@pytest.mark.parametrize("shape", [(N - 1,), (N, 1)])
def test_a_flow_curve_of_another_shape(shape):
    class Misshapen(Yielding):
        def flow_curve(self, shear_rate):
            return np.ones(shape) if len(shear_rate) == N else 1.0 + shear_rate

    assert "the flow curve returned an array of shape" in blamed("law", Misshapen)


def test_a_largest_viscosity_that_is_no_number():
    class Unknown(Law):
        def largest_viscosity(self, largest_shear_rate):
            return math.nan if largest_shear_rate > 1.5 else 0.0

    made = simulation("law", Unknown)
    made.particles.velocity[:] = 1.0
    said = r"'of-the-tests'.*has a largest viscosity of nan"
    with pytest.raises(GuardStop, match=said), blaming_plugins(plugins_of(made.case)):
        made.choose_time_step()


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        (lambda ratio: np.ones((len(ratio), 1)), "returned an array of shape (64, 1) from pressure"),
        (lambda ratio: 3.0, "returned a float from pressure"),
        (lambda ratio: np.full_like(ratio, np.inf), "a pressure that is not finite"),
    ],
    ids=["shape", "scalar", "infinite"],
)
def test_a_pressure_that_cannot_be_used(given, reason):
    class Bad(EquationOfState):
        name = "of-the-tests"
        api_version = 1
        citation = "none"

        def pressure(self, volume_ratio, density, sound_speed):
            return given(volume_ratio)

        def energy(self, volume_ratio, density, sound_speed):
            return np.zeros_like(volume_ratio)

    assert reason in blamed("equation_of_state", Bad)


@pytest.mark.parametrize(
    ("average", "rate", "reason"),
    [
        (lambda field: field[:-1], 0.0, "returned an array of shape (63,) from average"),
        (lambda field: field * np.nan, 0.0, "an average that is not finite"),
        (lambda field: field, -1.0, "has a relaxation rate of -1.0 /s"),
        (lambda field: field, math.nan, "has a relaxation rate of nan /s"),
    ],
    ids=["shape", "no number", "negative rate", "no rate"],
)
def test_a_volumetric_treatment_that_cannot_be_used(average, rate, reason):
    class Bad(VolumetricTreatment):
        name = "of-the-tests"
        api_version = 1
        citation = "none"

        def average(self, ops, field):
            return average(field)

        def relaxation_rate(self, ops):
            return rate

    assert reason in blamed("volumetric", Bad)


def test_a_flip_that_is_no_number():
    class Bad(VelocityUpdate):
        name = "of-the-tests"
        api_version = 1
        citation = "none"

        def map_to_particles(self, ops, dt):
            ops.move_particles(dt, flip=math.nan)

    assert "asked for a flip of nan" in blamed("velocity", Bad)


def hats(**changes):
    """The hat functions, written out, with something wrong."""

    class Hats(ShapeFunction):
        name = "of-the-tests"
        api_version = 1
        citation = "none"
        support = 2

        def fill(self, position, half_size, cell_size, base, weight, gradient):
            cells = position / cell_size
            base[:] = np.floor(cells) + changes.get("base", 0)
            part = cells - np.floor(cells)
            weight[..., 0], weight[..., 1] = 1 - part, part * changes.get("weight", 1.0)
            gradient[..., 0], gradient[..., 1] = -1 / cell_size, changes.get("gradient", 1.0) / cell_size
            if "unset" in changes:
                weight[3] = np.nan
            if "beyond" in changes:
                np.lib.stride_tricks.as_strided(weight, (len(weight) + 1, 2, 2))[-1] = 0.0
            if "meddle" in changes:
                position[0] += 1e-9

        def fill_radial(self, *arguments):
            raise NotImplementedError

    return Hats


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"base": 5}, "nodes more than a cell from the particle's own"),
        ({"weight": 0.99}, "weights that do not sum to one"),
        ({"gradient": 0.99}, "gradients that do not sum to zero"),
        ({"unset": True}, "left 'weight' without a finite number"),
        ({"beyond": True}, "wrote beyond the ends of the array 'weight'"),
        ({"meddle": True}, "changed 'position', which it may only read"),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_a_shape_function_whose_tables_cannot_be_used(changes, reason):
    assert reason in blamed("shape", hats(**changes), steps=1)


def test_a_shape_function_that_is_sound_runs():
    made = simulation("shape", hats())
    made.advance()
    assert made.steps == 1


def test_a_rehearsal_changes_nothing(monkeypatch):
    """To the bit, whether laws and shape functions are rehearsed in every step or hardly ever."""
    last = []
    for interval in (1, 10**9):
        monkeypatch.setattr("mpmkit.registry.audit.INTERVAL", interval)
        made = mpmkit.Simulation(mpmkit.load_case("cases/slump_fast.json"))
        for _ in range(5):
            made.advance()
        last.append(made.particles)
    for name, array in last[0].arrays().items():
        np.testing.assert_array_equal(array, getattr(last[1], name), err_msg=name)
