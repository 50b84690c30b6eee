"""What a plug-in gives back, or writes where it must not: it is named, before anything else comes to harm."""

from __future__ import annotations

import json
import math
from typing import ClassVar

import numba
import numpy as np
import pytest

import mpmkit
from mpmkit.case.plugins import cautions, plugins_of
from mpmkit.contracts import (
    ConstitutiveLaw,
    ElastoviscoplasticLaw,
    EquationOfState,
    GeneralisedNewtonianLaw,
    Redistribution,
    ShapeFunction,
    StateVariable,
    UpdateOrder,
    VelocityUpdate,
    VolumetricTreatment,
)
from mpmkit.errors import CaseError, GuardStop, PluginStop
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
        case["scheme"] = {"redistribution": "none"} | {kind: plugin.name}
    return mpmkit.Simulation(mpmkit.parse_case(json.loads(json.dumps(case)), registry=registry))


def blamed(kind, plugin, steps=3):
    """What is said of it when the case is read, set up, or within a few steps."""

    def run():
        made = simulation(kind, plugin)
        made.remarks(), cautions(made.case)
        for _ in range(steps):
            made.advance()
        made.check()

    with pytest.raises(PluginStop) as stop:
        run()
    assert f"the plug-in '{plugin.name}' ({kind.replace('_', ' ')})" in str(stop.value)
    assert stop.value.guard == "plug-in-error"
    return str(stop.value)


class Law(ConstitutiveLaw):
    name = "of-the-tests"
    api_version = 2
    citation = "none"
    state = {"age": StateVariable("s", "age")}

    def update_stress(self, kinematics, state, dt, stress):
        stress[:] = 0.0


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
        api_version = 2
        citation = "none"

        def pressure(self, volume_ratio, density, sound_speed):
            return given(volume_ratio)

        def energy(self, volume_ratio, density, sound_speed):
            return np.zeros_like(volume_ratio)

    assert reason in blamed("equation_of_state", Bad)


class Fluid(EquationOfState):
    """p = ρ c² (1/J - 1), with something wrong."""

    name = "of-the-tests"
    api_version = 2
    citation = "none"

    def pressure(self, volume_ratio, density, sound_speed):
        return density * sound_speed**2 * (1 / volume_ratio - 1)

    def energy(self, volume_ratio, density, sound_speed):
        return density * sound_speed**2 * (volume_ratio - 1 - np.log(volume_ratio))


def test_an_equation_of_state_that_is_sound_runs():
    made = simulation("equation_of_state", Fluid)
    made.advance()
    assert made.steps == 1


def test_an_equation_of_state_that_writes_to_what_it_may_only_read():
    class Meddler(Fluid):
        def pressure(self, volume_ratio, density, sound_speed):
            volume_ratio *= 0.999
            return super().pressure(volume_ratio, density, sound_speed)

    assert "changed 'volume_ratio', which it may only read" in blamed("equation_of_state", Meddler, 1)


@pytest.mark.parametrize(
    ("energy", "reason"),
    [
        (lambda e: e - 1e9, "gave particle 0 an energy of -1e+09 J/m³"),
        (lambda e: e + 1e9, "the energy must be that work"),
        (lambda e: 2 * e, "the energy must be that work"),
        (lambda e: -e, "the energy must be that work"),
        (lambda e: e * np.nan, "an energy that is not finite"),
        (lambda e: e.astype(complex), "returned an array of complex128 from energy"),
        (lambda e: e.astype(object), "returned an array of object from energy"),
        (lambda e: None, "returned nothing from energy; it must be an array of shape (64,)"),
    ],
    ids=["far below", "far above", "twice", "sign", "nan", "complex", "objects", "nothing"],
)
def test_an_energy_that_is_not_the_work_of_the_pressure(energy, reason):
    class Bad(Fluid):
        def energy(self, volume_ratio, density, sound_speed):
            return energy(super().energy(volume_ratio, density, sound_speed))

    assert reason in blamed("equation_of_state", Bad, steps=1)


@pytest.mark.parametrize(
    ("energy", "reason"),
    [
        (lambda stress: -1e9, "an energy of -1e+09 J/m³; what is stored cannot be negative"),
        (lambda stress: np.full(len(stress), -1e9), "what is stored cannot be negative"),
        (lambda stress: np.full(len(stress), np.nan), "an energy that is not finite"),
        (lambda stress: math.nan, "an energy that is not finite"),
        (lambda stress: None, "gave nothing as strain_energy; it must be a number"),
        (lambda stress: "much", "gave the text 'much' as strain_energy"),
        (lambda stress: stress.__setitem__(..., 1.0) or 0.0, "changed 'stress', which it may only read"),
    ],
    ids=["number", "array", "nan array", "nan", "nothing", "text", "meddles"],
)
def test_a_strain_energy_that_cannot_be_used(energy, reason):
    class Bad(Law):
        def strain_energy(self, motion, state, stress):
            return energy(stress)

    assert reason in blamed("law", Bad)


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
def test_what_a_law_says_of_itself_cannot_be_used(attribute, value, reason):
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
        (StateVariable("1", "x", initial="young"), "'young', which is no parameter of the law"),
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
def test_whatever_a_law_raises_is_its_own_fault(method, raised):
    def fail(self, *given):
        raise raised

    said = blamed("law", type("Bad", (Law,), {method: fail, "__module__": __name__}))
    assert f" raised {type(raised).__name__}: {raised} (test_plugin_faults.py, line " in said


def test_an_interrupt_is_nobodys_fault():
    class Slow(Law):
        def update_stress(self, motion, state, dt, stress):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulation("law", Slow).advance()


@pytest.mark.parametrize(
    ("average", "rate", "reason"),
    [
        (lambda field: field[:-1], 0.0, "returned an array of shape (63,) from average"),
        (lambda field: field * np.nan, 0.0, "an average that is not finite"),
        (lambda field: np.ones(N, dtype=int), 0.0, "returned an array of int64 from average"),
        (lambda field: field.astype(complex), 0.0, "returned an array of complex128 from average"),
        (lambda field: None, 0.0, "returned nothing from average"),
        (lambda field: np.add(field, 1.0, out=field), 0.0, "changed 'field', which it may only read"),
        (lambda field: field, "fast", "gave the text 'fast' as relaxation_rate; it must be a number"),
        (lambda field: field, -1.0, "has a relaxation rate of -1.0 /s"),
        (lambda field: field, math.nan, "has a relaxation rate of nan /s"),
    ],
    ids=[
        "shape",
        "no number",
        "integers",
        "complex",
        "nothing",
        "meddles",
        "text",
        "negative rate",
        "no rate",
    ],
)
def test_a_volumetric_treatment_that_cannot_be_used(average, rate, reason):
    class Bad(VolumetricTreatment):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def average(self, ops, field):
            return average(field)

        def relaxation_rate(self, ops):
            return rate

    assert reason in blamed("volumetric", Bad)


@pytest.mark.parametrize(
    ("use", "reason"),
    [
        (
            lambda ops: ops.shift(np.zeros((N - 1, 2))),
            "gave an array of shape (63, 2) as a displacement; it must",
        ),
        (lambda ops: ops.shift(np.full((N, 2), np.nan)), "gave particle 0 a displacement that is not finite"),
        (lambda ops: ops.shift(None), "gave nothing as a displacement"),
        (
            lambda ops: ops.shift(np.zeros((N, 2), dtype=int)),
            "an array of shape (64, 2) of int64 as a displace",
        ),
        (lambda ops: ops.scale_volume_ratio(np.ones(3)), "gave an array of shape (3,) as a factor of J"),
        (lambda ops: ops.scale_volume_ratio(np.zeros(N)), "gave 0 as a factor of J; it must be above 0"),
        (lambda ops: ops.scale_volume_ratio(np.full(N, np.inf)), "a factor of J that is not finite"),
        (lambda ops: ops.weigh(-np.ones(N)), "gave -1 as a weight; it must be at least 0"),
        (lambda ops: ops.weigh(1.0), "gave a float as a weight"),
        (lambda ops: ops.nodes.at_particles(np.ones(3)), "gave an array of shape (3,) as a field"),
        (lambda ops: ops.nodes.average(np.ones(N + 1)), "one number for each of 64 particles"),
        (lambda ops: ops.places.least_around(None), "gave nothing as a field"),
        (lambda ops: ops.places.nearest(ops, ops.nodes.crowding()), "what is no lattice of this scene"),
        (lambda ops: ops.cells().at_particles("all"), "gave the text 'all' as a field"),
    ],
)
def test_what_a_redistribution_cannot_hand_in(use, reason):
    class Bad(Redistribution):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def is_due(self, shear):
            return True

        def redistribute(self, ops, time):
            use(ops)

    assert reason in blamed("redistribution", Bad)


@pytest.mark.parametrize(
    ("due", "reason"), [(None, "returned nothing from is_due"), (0.5, "returned a float from is_due")]
)
def test_a_redistribution_that_does_not_say_whether_it_is_due(due, reason):
    class Bad(Redistribution):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def is_due(self, shear):
            return due

        def redistribute(self, ops, time):
            pass

    assert f"{reason}; it must be True or False" in blamed("redistribution", Bad)


def test_a_flip_that_is_no_number():
    class Bad(VelocityUpdate):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def map_to_particles(self, ops, dt):
            ops.move_particles(dt, flip=math.nan)

    assert "asked for a flip of nan" in blamed("velocity", Bad)


@pytest.mark.parametrize(
    ("use", "reason"),
    [
        (lambda ops, dt: ops.average("all"), "asked for an average of str"),
        (lambda ops, dt: ops.average(np.ones(3)), "it must be an array of 64 real numbers"),
        (lambda ops, dt: ops.average(np.ones(N, dtype=complex)), "it must be an array of 64 real numbers"),
        (lambda ops, dt: ops.nodes_to_particles(np.ones(N - 1)), "asked for an average of (63,) of float64"),
        (lambda ops, dt: ops.average(np.ones(N), "weight"), "it must be by 'mass' or 'volume'"),
        (lambda ops, dt: ops.move_particles("dt", flip=1.0), "asked for a step of 'dt' s"),
        (lambda ops, dt: ops.move_particles(math.nan, flip=1.0), "asked for a step of nan s"),
        (lambda ops, dt: ops.move_particles(dt, flip="much"), "asked for a flip of much"),
        (
            lambda ops, dt: ops.move_particles(dt / 2, flip=1.0),
            "advanced the particles by 0.002 s in a step of 0.004 s",
        ),
        (lambda ops, dt: None, "advanced the particles by 0 s in a step of 0.004 s"),
    ],
    ids=["text", "few", "complex", "nodes", "measure", "step", "nan", "flip", "half", "nothing"],
)
def test_a_velocity_update_that_misuses_its_operations(use, reason):
    class Bad(VelocityUpdate):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def map_to_particles(self, ops, dt):
            use(ops, dt)

    assert reason in blamed("velocity", Bad)


class Order(UpdateOrder):
    name = "of-the-tests"
    api_version = 2
    citation = "none"
    calls: ClassVar = (
        "map_to_grid",
        "solve_momentum",
        "map_to_particles",
        "update_velocity_gradient",
        "update_stress",
    )

    def step(self, ops, dt):
        for call in self.calls:
            method, _, times = call.partition("*")
            timed = method in ("solve_momentum", "map_to_particles", "update_stress")
            getattr(ops, method)(*((float(times or 1) * dt,) if timed else ()))


@pytest.mark.parametrize(
    ("calls", "reason"),
    [
        ((), "moved the particles by 0 s in a step of 0.004 s"),
        (Order.calls[:-1], "updated the stress by 0 s in a step of 0.004 s"),
        ((*Order.calls[:-1], "update_stress*2"), "updated the stress by 0.008 s in a step of 0.004 s"),
        ((*Order.calls[:3], "update_stress"), "updated the stress without the velocity gradient of the step"),
        (("map_to_grid", *Order.calls[2:]), "with nodal velocities advanced by 0 s"),
        (("map_to_grid", "map_forces", *Order.calls[1:]), "the forces mapped 2 times; it must be once"),
        (Order.calls[1:], "the forces mapped 0 times; it must be once"),
        ((*Order.calls[:2], *Order.calls[3:]), "moved the particles by 0 s in a step of 0.004 s"),
    ],
    ids=[
        "nothing",
        "no stress",
        "twice",
        "no gradient",
        "no momentum",
        "forces twice",
        "no map",
        "no motion",
    ],
)
def test_an_order_that_does_not_advance_the_scene(calls, reason):
    assert reason in blamed("order", type("Bad", (Order,), {"calls": calls, "__module__": __name__}))


@pytest.mark.parametrize(
    "calls",
    [
        Order.calls,
        (*Order.calls[:4], "update_stress*0.5", "update_stress*0.5"),
        (*Order.calls[:3], "remap_velocity", *Order.calls[3:]),
    ],
    ids=["whole", "halves", "remapped"],
)
def test_an_order_that_is_sound_runs(calls):
    made = simulation("order", type("Good", (Order,), {"calls": calls, "__module__": __name__}))
    for _ in range(3):
        made.advance()
    assert made.steps == 3


@pytest.mark.parametrize("fraction", [0.0, -1.0, math.nan, math.inf, "half", None], ids=str)
@pytest.mark.parametrize(
    ("kind", "name"),
    [("order", "acoustic_fraction"), ("order", "viscous_fraction"), ("velocity", "acoustic_fraction")],
)
def test_a_part_of_the_limit_that_is_none(kind, name, fraction):
    """It was reported as a step that is too long, and the case was asked to shorten it."""

    class Update(VelocityUpdate):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def map_to_particles(self, ops, dt):
            ops.move_particles(dt, flip=1.0)

    base = Order if kind == "order" else Update
    said = blamed(kind, type("Bad", (base,), {name: fraction, "__module__": __name__}))
    assert f" as {name}; it must be" in said


def hats(**changes):
    """The hat functions, written out, with something wrong."""
    calls = []

    class Hats(ShapeFunction):
        name = "of-the-tests"
        api_version = 2
        citation = "none"
        support = 2

        def fill(self, position, half_size, cell_size, base, weight, gradient):
            cells = position / cell_size
            base[:] = np.floor(cells) + changes.get("base", 0)
            part = cells - np.floor(cells)
            weight[..., 0], weight[..., 1] = 1 - part, part * changes.get("weight", 1.0)
            gradient[..., 0], gradient[..., 1] = -1 / cell_size, changes.get("gradient", 1.0) / cell_size
            gradient *= changes.get("sign", 1)
            if changes.get("mirrored"):
                weight[:] = weight[..., ::-1].copy()
            if "later" in changes:
                calls.append(len(position))
                if len(position) == N and calls.count(N) > 3:
                    changes["later"](base, weight, gradient)
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
        ({"sign": -1}, "gave gradients of which that of a linear field, Σ ∇N x, is not one"),
        ({"mirrored": True}, "gave weights whose mean position of the nodes, Σ N x, is not the particle's"),
        ({"unset": True}, "left 'weight' without a finite number"),
        ({"beyond": True}, "wrote beyond the ends of the array 'weight'"),
        ({"meddle": True}, "changed 'position', which it may only read"),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_a_shape_function_whose_tables_cannot_be_used(changes, reason):
    assert reason in blamed("shape", hats(**changes), steps=1)


@pytest.mark.parametrize(
    "later",
    [
        lambda base, weight, gradient: base.__setitem__((7, 1), 2**30),
        lambda base, weight, gradient: base.__setitem__((7, 0), -(2**31)),
        lambda base, weight, gradient: base.__iadd__(2),
    ],
    ids=["far", "far below", "all"],
)
def test_a_base_that_goes_astray_between_rehearsals(later):
    """It led the compiled loops out of the nodes: signal 11."""
    said = blamed("shape", hats(later=later), steps=8)
    assert "stopped at step 2, " in said
    assert "the 'base' " in said
    assert "which leads to nodes more than a cell from the particle's own" in said


@pytest.mark.parametrize(
    ("later", "reason"),
    [
        (
            lambda base, weight, gradient: weight.__setitem__(5, np.nan),
            "weights that sum to nan and not to 1",
        ),
        (lambda base, weight, gradient: weight.__imul__(1.01), "weights that sum to 1.0201 and not to 1"),
        (lambda base, weight, gradient: gradient.__setitem__(5, np.nan), "gradients that do not sum to zero"),
        (lambda base, weight, gradient: gradient.__setitem__(5, 0.3), "gradients that do not sum to zero"),
    ],
    ids=["nan", "heavy", "nan gradients", "gradients"],
)
def test_weights_that_go_astray_between_rehearsals(later, reason):
    """They were told as a step that is too long, or not at all."""
    assert reason in blamed("shape", hats(later=later), steps=25)


@pytest.mark.parametrize("domain", ["stretched", None, 1])
def test_a_rule_for_domains_that_there_is_not(domain):
    plugin = hats()
    plugin.particle_domain = property(lambda self: domain)
    assert f"has a particle_domain of {domain!r}; it must be one of strain, fixed" in blamed("shape", plugin)


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
