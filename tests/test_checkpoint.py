"""A restored state continues to the same bits, with every case, law and scheme."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
from coarse import CASES, COARSE
from pairwise import every_pair

from mpmkit.case import load_case, parse_case
from mpmkit.solver.simulation import CONTROL_INTERVAL, Simulation

LAWS = {
    "newtonian": {"viscosity": 30.0},
    "bingham": {"yield_stress": 50.0, "plastic_viscosity": 30.0, "regularisation": 10.0},
    "herschel-bulkley": {
        "yield_stress": 50.0,
        "consistency": 30.0,
        "flow_index": 1.2,
        "regularisation": 10.0,
    },
    "bingham-evp": {"yield_stress": 50.0, "plastic_viscosity": 30.0},
    "herschel-bulkley-evp": {"yield_stress": 50.0, "consistency": 30.0, "flow_index": 1.2},
    "neo-hookean": {"youngs_modulus": 1e5, "poisson_ratio": 0.3},
}


def written_and_read(state):
    """A state after writing it to a file and reading it."""
    content = io.BytesIO()
    np.savez(content, allow_pickle=False, **state)
    with np.load(io.BytesIO(content.getvalue()), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def assert_same(a: Simulation, b: Simulation):
    left, right = a.state(), b.state()
    assert left.keys() == right.keys()
    for name, array in left.items():
        np.testing.assert_array_equal(array, right[name], err_msg=name)
        assert array.dtype == right[name].dtype, name


def stopped_at_half(case, steps=45):
    """Two simulations after as many steps, one of them stopped in between."""
    whole = Simulation(case)
    for _ in range(steps // 2):
        whole.advance()
    again = Simulation(case)
    again.restore(written_and_read(whole.state()))
    assert_same(again, whole)
    for _ in range(steps - steps // 2):
        whole.advance()
        again.advance()
    return whole, again


ORDERS, SHAPES, REDISTRIBUTIONS = ("usl", "usf", "musl"), ("cpgimp", "linear"), ("none", "even")
OF_EACH_SPACE = ("slump_fast", "slump_quarter", "film")


@every_pair("name, order, shape, redistribution", COARSE, ORDERS, SHAPES, REDISTRIBUTIONS)
def test_every_case_with_every_order_and_shape(name, order, shape, redistribution):
    kinds = {"order": order, "shape": shape, "redistribution": redistribution}
    schemes = [f"scheme.{kind}={chosen}" for kind, chosen in kinds.items()]
    case = load_case(CASES / f"{name}.json", [*COARSE[name], *schemes])
    assert_same(*stopped_at_half(case))


@pytest.mark.parametrize("name", COARSE)
def test_stopped_where_the_limits_and_the_guards_are_looked_at_next(name):
    """No step has been made since the run was continued: the nodes are empty and cannot be checked."""
    case = load_case(CASES / f"{name}.json", COARSE[name])
    assert_same(*stopped_at_half(case, steps=4 * CONTROL_INTERVAL))


@every_pair("law, name, order, shape", LAWS, OF_EACH_SPACE, ORDERS, SHAPES)
def test_every_law_with_every_order_and_shape(name, law, order, shape):
    data = json.loads((CASES / f"{name}.json").read_text())
    for body in data["bodies"]:
        body["material"] = {"law": law, "density": 2000, **LAWS[law]}
        if law != "neo-hookean":
            body["material"]["sound_speed"] = {"mach": 0.1}
    schemes = [f"scheme.order={order}", f"scheme.shape={shape}"]
    assert_same(*stopped_at_half(parse_case(data, [*COARSE[name], *schemes])))


def test_the_shipped_cases_are_all_there():
    assert {path.stem for path in CASES.glob("*.json")} == set(COARSE)


WALL = {"kind": "friction", "coefficient": 0.3}


@pytest.mark.parametrize(
    "changes",
    [
        [f'grid.faces={{"z_min": {json.dumps(WALL)}, "r_max": "stick"}}'],
        ['scheme.shape={"name": "cpgimp", "domain": "stretch"}'],
        ['scheme.shape={"name": "cpgimp", "domain": "volume"}'],
        ["scheme.velocity=flip", "scheme.volumetric=own"],
        ["scheme.velocity=blend"],
    ],
    ids=lambda changes: changes[0],
)
def test_memory_of_walls_domains_and_velocities_is_restored(changes):
    """As it falls, with particles that are split: 300 steps, so that the window moves on."""
    case = load_case(CASES / "slump_fast.json", [*COARSE["slump_fast"], *changes])
    whole, again = stopped_at_half(case, 300)
    assert len(whole.particles) > 56 or "stick" in changes[0]
    assert_same(whole, again)


def test_memory_of_a_redistribution_is_restored():
    """The shear since the last time, and the parts of their volumes that particles keep in between."""
    changes = ["scheme.redistribution=even", "scheme.splitting=false"]
    case = load_case(CASES / "slump_fast.json", [*COARSE["slump_fast"], *changes])
    whole, again = stopped_at_half(case, 300)
    assert np.ptp(whole.particles.quadrature) > 0.01
    assert whole.operations.stage.shear > 0
    assert_same(whole, again)
