"""Fields of bodies at the start: velocity, stress, and state variables of laws."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from test_state_variables import Cement

from mpmkit.case import parse_case
from mpmkit.case.resolved import resolved
from mpmkit.errors import CaseError
from mpmkit.plan.symmetry import planes_of_symmetry
from mpmkit.registry import Registered, Registry, installed
from mpmkit.solver.simulation import Simulation

MUD = {"law": "bingham-evp", "density": 1500, "yield_stress": 50, "plastic_viscosity": 5, "sound_speed": 20}
OIL = {"law": "newtonian", "density": 1000, "viscosity": 5.0, "sound_speed": 20}
RUBBER = {"law": "neo-hookean", "density": 1000, "youngs_modulus": 2e5, "poisson_ratio": 0.3}
TANK = {
    "space": "plane-strain",
    "until": 1.0,
    "grid": {
        "cell_size": 0.02,
        "domain": {"x": [0, 0.1], "z": [-0.1, 0.3]},
        "faces": {"x_min": "slip", "x_max": "slip", "z_min": "slip"},
    },
    "bodies": [{"shape": {"kind": "box", "lower": [0, -0.1], "upper": [0.1, 0.1]}, "material": OIL}],
    "output": {"report": False},
}
"""A column 0.2 m high."""


def a_case(initial, material=OIL, registry=None, **changes):
    data = copy.deepcopy(TANK) | changes
    data["bodies"][0] |= {"initial": initial, "material": material}
    return parse_case(data, registry=registry)


def height_above(simulation):
    """Depth of the particles below the top of the column, m."""
    return 0.2 - simulation.particles.position[:, 1]


def fastest(case, seconds):
    simulation, most = Simulation(case), 0.0
    while simulation.time < seconds:
        simulation.advance()
        most = max(most, float(np.abs(simulation.particles.velocity).max()))
    return simulation, most


# --- Stress

STEPS = [
    {"shape": {"kind": "box", "lower": [0, -0.1], "upper": [0.06, 0.1]}, "material": OIL},
    {
        "shape": {"kind": "box", "lower": [0.06, -0.1], "upper": [0.1, 0.1]},
        "material": OIL | {"sound_speed": 21},
    },
]
"""The same column in two pieces side by side, which does not start under its weight by itself."""


def test_a_column_with_hydrostatic_pressure_is_at_rest_from_the_start():
    """Without it, gravity acts suddenly: the pressure swings to twice that of the weight."""
    without = copy.deepcopy(TANK) | {"bodies": copy.deepcopy(STEPS)}
    simulation = Simulation(parse_case(without))
    assert not simulation.starts_under_weight
    assert simulation.swinging is not None
    _, sudden = fastest(parse_case(without), 0.02)
    given = copy.deepcopy(without)
    for body in given["bodies"]:
        body["initial"] = {"stress": {"kind": "hydrostatic"}}
    simulation = Simulation(parse_case(given))
    assert simulation.swinging is None
    p, depth = simulation.particles, height_above(simulation)
    np.testing.assert_allclose(p.pressure * p.volume_ratio, 1000 * 9.81 * depth, rtol=1e-5, atol=1e-6)
    _, calm = fastest(parse_case(given), 0.02)
    assert sudden > 0.05
    assert calm < 0.05 * sudden


def test_it_is_the_start_that_a_full_tank_has_by_itself():
    by_itself = Simulation(parse_case(copy.deepcopy(TANK)))
    given = Simulation(a_case({"stress": {"kind": "hydrostatic"}}))
    assert by_itself.starts_under_weight
    for name in ("pressure", "volume", "volume_ratio"):
        found, expected = (getattr(one.particles, name) for one in (given, by_itself))
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-9)


def test_a_law_that_remembers_its_stress_starts_with_k0():
    """σ_v = ρ g depth and K0 of it across, as long as the difference is below what makes it flow."""
    case = a_case({"stress": {"kind": "k0", "ratio": 0.99}}, MUD)
    simulation = Simulation(case)
    p, depth = simulation.particles, height_above(simulation)
    total = p.stress[:, :3] - p.pressure[:, None]
    vertical = -1500 * 9.81 * depth
    np.testing.assert_allclose(total[:, 1] * p.volume_ratio, vertical, rtol=1e-6, atol=1e-6)
    for across in (0, 2):
        np.testing.assert_allclose(total[:, across], 0.99 * total[:, 1], rtol=1e-6, atol=1e-6)
    _, calm = fastest(case, 0.02)
    assert calm < 5e-3  # as with the hydrostatic start; a sudden one makes 90 mm/s


def test_a_solid_column_stands_from_the_start():
    """With K0 = ν/(1 - ν), which the walls would give a soft column: it does not move, and else it does."""
    ratio = 0.3 / 0.7
    case = a_case({"stress": {"kind": "k0", "ratio": ratio}}, RUBBER)
    simulation = Simulation(case)
    p, depth = simulation.particles, height_above(simulation)
    vertical = -1000 * 9.81 * depth
    np.testing.assert_allclose(p.stress[:, 1] * p.volume_ratio, vertical, rtol=1e-6, atol=1e-3)
    np.testing.assert_allclose(p.stress[:, 0] * p.volume_ratio, ratio * vertical, rtol=1e-6, atol=1e-3)
    stress = p.stress[np.argsort(p.number)]
    simulation.advance()
    np.testing.assert_allclose(p.stress[np.argsort(p.number), 1], stress[:, 1], atol=20)
    _, calm = fastest(case, 0.03)
    _, sudden = fastest(a_case({}, RUBBER), 0.03)
    assert sudden > 0.1
    assert calm < 0.05 * sudden


def test_a_load_and_a_level_are_counted():
    field = {"kind": "hydrostatic", "level": 0.3, "load": 500.0}
    simulation = Simulation(a_case({"stress": field}))
    p = simulation.particles
    expected = 500 + 1000 * 9.81 * (height_above(simulation) + 0.2)
    np.testing.assert_allclose(p.pressure * p.volume_ratio, expected, rtol=1e-6)


# --- Velocity and state


def test_a_velocity_by_a_table():
    field = {"kind": "table", "axis": "z", "places": [-0.1, 0.1], "values": [[0, 0], [2.0, -1.0]]}
    case = a_case({"velocity": field})
    simulation = Simulation(case)
    p = simulation.particles
    up = (p.position[:, 1] / 0.2)[:, None]
    np.testing.assert_allclose(p.velocity, up * [2.0, -1.0], rtol=1e-12)
    assert case.largest_energy == pytest.approx(9.81 * 0.2 + 5.0 / 2)
    again = parse_case(resolved(case))
    np.testing.assert_array_equal(Simulation(again).particles.velocity, p.velocity)


def test_one_velocity_is_the_short_form_to_the_bit():
    short = copy.deepcopy(TANK)
    short["bodies"][0]["velocity"] = [0.3, 0.1]
    long = a_case({"velocity": {"kind": "uniform", "value": [0.3, 0.1]}})
    a, b = Simulation(parse_case(short)), Simulation(long)
    for _ in range(5):
        a.advance()
        b.advance()
    np.testing.assert_array_equal(a.particles.position, b.particles.position)


def test_the_state_of_a_law_by_a_table():
    """A number along an axis, and the components of a pair; what is not named starts as the law says."""
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered("law", Cement, "tests", "1", "cement")], [])
    initial = {
        "law.age": {"kind": "table", "axis": "x", "places": [0, 0.1], "values": [0, 100]},
        "law.pair": {"kind": "uniform", "value": [1, 2]},
    }
    material = {"law": "cement", "density": 1000, "sound_speed": 10}
    simulation = Simulation(a_case(initial, material, registry))
    p, (group,) = simulation.particles, simulation.particles.groups
    np.testing.assert_allclose(group.state["age"], 1000 * p.position[:, 0], rtol=1e-12)
    np.testing.assert_array_equal(group.state["pair"], np.tile([1.0, 2.0], (len(p), 1)))
    assert (group.state["twice"] == 120).all()
    before = group.state["age"].copy()
    simulation.advance()
    np.testing.assert_allclose(np.sort(group.state["age"]), np.sort(before) + simulation.time, rtol=1e-12)
    with pytest.raises(CaseError, match=r"law\.pair: value is \[1\.0\]; law\.pair needs a list of 2 numbers"):
        a_case({"law.pair": {"kind": "uniform", "value": [1]}}, material, registry)


QUARTER = {
    "space": "3d",
    "until": 0.1,
    "grid": {"cell_size": 0.1, "domain": {a: [-1, 1] for a in "xyz"}},
    "bodies": [{"shape": {"kind": "cylinder", "radius": 0.2, "height": 0.2}, "material": OIL}],
}


def test_plan_offers_no_quarter_of_a_body_with_fields():
    data = copy.deepcopy(QUARTER)
    assert planes_of_symmetry(parse_case(data)) is not None
    data["bodies"][0]["initial"] = {"stress": {"kind": "hydrostatic"}}
    assert planes_of_symmetry(parse_case(data)) is None


# --- What is wrong


@pytest.mark.parametrize(
    ("initial", "material", "sentence"),
    [
        (
            {"temperature": {"kind": "uniform", "value": 1}},
            OIL,
            'bodies.0.initial has the field "temperature"; it must be',
        ),
        (
            {"stress": {"kind": "k0", "ratio": 0.5}},
            OIL,
            "has a shear stress, but the law 'newtonian' has one",
        ),
        ({"stress": {"kind": "uniform", "value": 5}}, OIL, "value is 5.0; stress needs a list of 6 numbers"),
        (
            {"stress": {"kind": "uniform", "value": [1, 1, 1, 0, 0, 0]}},
            OIL,
            "a pressure of -1 Pa; a fluid needs",
        ),
        ({"velocity": {"kind": "hydrostatic"}}, OIL, "it gives a stress, and not velocity"),
        (
            {"velocity": {"kind": "table", "axis": "y", "places": [0, 1], "values": [[0, 0], [1, 1]]}},
            OIL,
            "axis is 'y'; the space plane-strain has the axes x, z",
        ),
        (
            {"velocity": {"kind": "table", "axis": "z", "places": [1, 1], "values": [[0, 0], [1, 1]]}},
            OIL,
            "places has 1 m after 1 m; each must be above the one before",
        ),
        ({"velocity": {"kind": "unifrom", "value": [1, 1]}}, OIL, 'did you mean "uniform"?'),
        ({"stress": {"kind": "hydrostatic", "load": 1e9}}, OIL, "would press the fluid to less than half"),
    ],
)
def test_a_wrong_field_has_its_sentence(initial, material, sentence):
    with pytest.raises(CaseError) as error:
        Simulation(a_case(initial, material))
    assert sentence in str(error.value)


def test_two_velocities_are_refused():
    data = copy.deepcopy(TANK)
    data["bodies"][0] |= {"velocity": [1, 0], "initial": {"velocity": {"kind": "uniform", "value": [1, 0]}}}
    with pytest.raises(CaseError, match=r"bodies\.0 has both velocity and initial\.velocity"):
        parse_case(data)
