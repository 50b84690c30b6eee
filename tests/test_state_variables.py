"""State variables of laws: their start values, and the sentences about missing or wrong ones."""

from __future__ import annotations

import numpy as np
import pytest

import mpmkit
from mpmkit.contracts import ConstitutiveLaw, StateVariable, quantity
from mpmkit.contracts.law import initial_state
from mpmkit.errors import CaseError, GuardStop
from mpmkit.registry import Registered, Registry, check, installed
from mpmkit.testing import Violation, law_checks


class Cement(ConstitutiveLaw):
    """A fluid that does not flow; what matters is where its memory starts."""

    name = "cement"
    citation = "none"
    api_version = 2
    state = {
        "age": StateVariable("s", "time since it was mixed", initial="age_at_start"),
        "twice": StateVariable("s", "a property", initial="doubled"),
        "fabric": StateVariable("1", "a tensor", (3, 3), initial=np.eye(3)),
        "pair": StateVariable("1", "a number for all of its entries", (2,), initial=3),
    }

    age_at_start: float | None = quantity("s", "age at the start", ge=0, default=60.0)

    @property
    def doubled(self) -> float:
        return 2 * (self.age_at_start or 0.0)

    def update_stress(self, kinematics, state, dt, stress):
        stress[:] = 0.0
        state["age"] += dt


def scene(**material):
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered("law", Cement, "tests", "1", "cement")], [])
    case = {
        "space": "plane-strain",
        "until": 1.0,
        "gravity": [0, 0],
        "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}},
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0.2 + x, 0.2], "upper": [0.4 + x, 0.4]},
                "material": {"law": "cement", "density": 1000, "sound_speed": 10, **own},
            }
            for x, own in ((0.0, {}), (0.4, material))
        ],
    }
    return mpmkit.parse_case(case, registry=registry)


def test_a_case_says_where_the_memory_of_each_material_starts():
    simulation = mpmkit.Simulation(scene(age_at_start=900))
    young, old = (group.state for group in simulation.particles.groups)
    assert np.all(young["age"] == 60.0)
    assert np.all(old["age"] == 900.0)
    assert np.all(old["twice"] == 1800.0)
    assert old["fabric"].shape == (len(old["age"]), 3, 3)
    assert np.all(old["fabric"] == np.eye(3))
    assert np.all(old["pair"] == 3.0)
    dt = simulation.advance()
    assert np.all(old["age"] == 900.0 + dt)


def test_what_the_case_may_say_is_checked_like_any_parameter():
    with pytest.raises(
        CaseError, match=r"bodies\.1\.material\.age_at_start is -1; it must be a number of at"
    ):
        scene(age_at_start=-1)


def test_a_parameter_that_is_no_number_is_the_plugins_fault():
    with pytest.raises(GuardStop) as stop:
        scene(age_at_start=None)
    assert "the plug-in 'cement' (law)" in str(stop.value)
    assert (
        "state 'age' that starts from its 'age_at_start', which is None; it must be a finite number"
        in str(stop.value)
    )


@pytest.mark.parametrize(
    ("variable", "sentence"),
    [
        (
            StateVariable("s", "age", initial="age"),
            "its state 'x' starts from 'age', which is not a parameter of the law; "
            "its parameters: age_at_start",
        ),
        (
            StateVariable("1", "pair", (2,), initial=[1, 2, 3]),
            r"its state 'x' starts from \[1, 2, 3\]; it must be a finite number or an array of shape \(2,\)",
        ),
        (
            StateVariable("1", "nothing", initial=float("nan")),
            "its state 'x' starts from nan; it must be a finite number",
        ),
        (StateVariable("1", "none", initial=None), "starts from None; it must be a finite number"),
        (0.0, r"its state 'x' is 0\.0; it must be a StateVariable"),
    ],
)
def test_a_start_that_cannot_be_is_refused_at_registration(variable, sentence):
    class Faulty(Cement):
        state = {"x": variable}

    with pytest.raises((TypeError, ValueError), match=sentence):
        check(Faulty, "law")
    with pytest.raises(Violation, match=sentence):
        law_checks(Faulty())[0]()


def test_the_kit_takes_a_law_whose_memory_starts_from_its_parameters():
    checks = {check.name: check for check in law_checks(Cement())}
    checks["descriptor"]()
    checks["declared state"]()


def test_each_particle_has_a_memory_of_its_own():
    state = initial_state(Cement(), 2)
    state["fabric"][0] = 0.0
    assert np.all(state["fabric"][1] == np.eye(3))
