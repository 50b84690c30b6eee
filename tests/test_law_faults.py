"""A law that returns a wrong value, or writes where it must not, is named before other data are damaged."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest
from faulty_plugins import Law, N, blamed, simulation

from mpmkit.case.plugins import plugins_of
from mpmkit.contracts import (
    ElastoviscoplasticLaw,
    GeneralisedNewtonianLaw,
    StateVariable,
)
from mpmkit.errors import CaseError, GuardStop
from mpmkit.registry.blame import blaming_plugins


class Viscous(GeneralisedNewtonianLaw):
    name = "of-the-tests"
    api_version = 2
    citation = "none"


class Yielding(ElastoviscoplasticLaw):
    name = "of-the-tests"
    api_version = 2
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
    ("attribute", "value", "reason"),
    [
        ("wave_speed", None, "gave nothing as wave_speed; it must be a number"),
        ("wave_speed", "fast", "gave the text 'fast' as wave_speed; it must be a number"),
        ("wave_speed", math.nan, "has a wave speed of nan m/s; it must be positive"),
        ("wave_speed", 1j, "gave a complex as wave_speed; it must be a number"),
        ("largest_viscosity", None, "gave nothing as largest_viscosity"),
        ("remarks", None, "returned nothing from remarks; it must be a list of sentences"),
        ("remarks", "It creeps.", "returned the text 'It creeps.' from remarks"),
        ("cautions", [1], "returned a list from cautions; it must be a list of sentences"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_unusable_remarks_of_a_law(attribute, value, reason):
    plugin = type("Bad", (Law,), {attribute: lambda self, *given: value, "__module__": __name__})
    assert reason in blamed("law", plugin)


@pytest.mark.parametrize(
    ("variable", "reason"),
    [
        (
            StateVariable("1", "x", shape=(3,), initial=[1.0, 2.0]),
            "a state 'x' that starts from [1.0, 2.0]",
        ),
        (StateVariable("1", "x", shape=3), "a state 'x' that has the shape 3; it must be a tuple"),
        (StateVariable("1", "x", initial="young"), "'young', which is not a parameter of the law"),
        (StateVariable("1", "x", initial=math.nan), "a state 'x' that starts from nan; it must be a finite"),
        ("young", "a state 'x' that is 'young'; it must be a StateVariable"),
    ],
    ids=["values", "shape", "text", "nan", "no variable"],
)
def test_a_state_that_cannot_be_made(variable, reason):
    class Bad(Law):
        state = {"x": variable}

    assert reason in blamed("law", Bad)


@pytest.mark.parametrize("dtype", [complex, object, np.int64])
def test_a_viscosity_that_is_of_no_real_numbers(dtype):
    class Bad(Viscous):
        def apparent_viscosity(self, shear_rate):
            return np.ones_like(shear_rate).astype(dtype)

        def largest_viscosity(self, largest_shear_rate):
            return 1.0

    if dtype is np.int64:  # whole numbers are real ones, and are taken as such
        simulation("law", Bad).advance()
    else:
        blamed("law", Bad)


@pytest.mark.parametrize(
    "raised", [KeyError("a"), TypeError("b"), ValueError("c"), SystemExit(0), CaseError("d")], ids=repr
)
@pytest.mark.parametrize("method", ["wave_speed", "largest_viscosity", "update_stress", "remarks"])
def test_any_exception_in_a_law_is_blamed_on_the_law(method, raised):
    def fail(self, *given):
        raise raised

    said = blamed("law", type("Bad", (Law,), {method: fail, "__module__": __name__}))
    assert f" raised {type(raised).__name__}: {raised} (test_law_faults.py, line " in said


def test_an_interrupt_is_blamed_on_no_plugin():
    class Slow(Law):
        def update_stress(self, motion, state, dt, stress):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulation("law", Slow).advance()
