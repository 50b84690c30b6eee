"""Cheaper models of a scene with walls: offered only if the walls have the symmetry, and with the walls."""

import json

import pytest

from mpmkit.case import parse_case
from mpmkit.plan import cheaper_models

ROUND = {"kind": "cylinder", "radius": 0.1, "height": 0.3, "base": [0.1, 0.2, 0.0]}
FLUID = {
    "law": "bingham-evp",
    "density": 2000,
    "yield_stress": 100,
    "plastic_viscosity": 20,
    "sound_speed": 50,
}
LIFT = {"kind": "velocity", "velocity": [0, 0, 0.3]}
MOULD = {"kind": "body", "shape": ROUND, "side": "inside", "thickness": 0.02, "motion": LIFT}
TABLE = {"kind": "table", "times": [0, 0.2, 0.3], "positions": [[0, 0, 0], [0, 0, 0.1], [0, 0, 0.3]]}
BAR = {"kind": "cylinder", "radius": 0.02, "height": 0.2, "base": [0.3, 0.2, 0.0]}
TRAY = {"kind": "box", "lower": [-0.1, 0.0, 0.0], "upper": [0.3, 0.4, 0.1]}


def models(surface):
    data = {
        "space": "3d",
        "until": 0.5,
        "grid": {"cell_size": 0.01, "domain": {"x": [-0.3, 0.5], "y": [-0.2, 0.6], "z": [-0.05, 0.35]}},
        "bodies": [{"shape": ROUND, "material": FLUID}],
        "walls": {"wall": {"surface": surface, "contact": "slip"}},
    }
    found = {model.name: model.case for model in cheaper_models(parse_case(json.loads(json.dumps(data))))}
    return found.get("a quarter"), found.get("axisymmetric")


@pytest.mark.parametrize("motion", [LIFT, TABLE, None])
def test_a_mould_that_is_lifted(motion):
    quarter, turned = models(MOULD | {"motion": motion})
    assert quarter.walls["wall"].surface.shape.base == [0.1, 0.2, 0.0]
    assert turned.walls["wall"].surface.shape.base == [0.0, 0.0]
    if motion is LIFT:
        assert turned.walls["wall"].surface.motion.velocity == [0.0, 0.3]
    if motion is TABLE:
        assert turned.walls["wall"].surface.motion.positions == [[0.0, 0], [0.0, 0.1], [0.0, 0.3]]
        assert turned.walls["wall"].surface.motion.times == [0, 0.2, 0.3]


def test_a_level_floor():
    quarter, turned = models({"kind": "plane", "point": [3.0, 1.0, 0.0], "normal": [0, 0, 1]})
    assert quarter is not None
    assert turned.walls["wall"].surface.normal == [0.0, 1]


@pytest.mark.parametrize(
    "surface",
    [
        {"kind": "plane", "point": [0, 0, -0.03], "normal": [0.01, 0, 1]},  # an incline
        MOULD | {"motion": {"kind": "velocity", "velocity": [0.1, 0, 0.3]}},  # moves sideways
        MOULD | {"motion": {"kind": "oscillation", "amplitude": [0, 0.01, 0], "frequency": 3.0}},
        {"kind": "body", "shape": BAR, "side": "outside"},  # stands beside the axis
    ],
)
def test_a_wall_without_the_symmetry(surface):
    assert models(surface) == (None, None)


def test_a_tray_has_a_quarter_and_does_not_turn():
    quarter, turned = models(
        {"kind": "body", "shape": TRAY, "side": "inside", "thickness": 0.02, "open": ["z_max"]}
    )
    assert quarter is not None
    assert turned is None


def test_a_drum_that_turns_drags_and_mirrors_nothing():
    turning = {"kind": "rotation", "point": [0.1, 0.2, 0], "axis": [0, 0, 1], "rate": 1.0}
    assert models(MOULD | {"motion": turning}) == (None, None)


def test_a_cone_as_a_mould_turns_about_its_axis():
    cone = {
        "kind": "frustum",
        "bottom_radius": 0.1,
        "top_radius": 0.05,
        "height": 0.3,
        "base": [0.1, 0.2, 0.0],
    }
    quarter, turned = models(MOULD | {"shape": cone})
    assert quarter is not None
    assert turned.walls["wall"].surface.shape.bottom_radius == 0.1


@pytest.mark.parametrize("spell", [{}, {"start": 0.07, "end": 0.09}], ids=["always", "for a moment"])
@pytest.mark.parametrize("shape", ["drum", "vane"])
def test_what_turns_is_not_symmetric_however_short_it_turns(shape, spell):
    """Between 0 and 0.5 s a wall is checked at nine times, and once in each interval between them."""
    turning = {"kind": "rotation", "point": [0.1, 0.2, 0], "axis": [0, 0, 1], "rate": 1.0} | spell
    vane = {"kind": "box", "lower": [0.0, 0.18, -0.02], "upper": [0.2, 0.22, 0.3]}
    of_vane = {"kind": "body", "shape": vane, "side": "outside"}
    assert models((MOULD if shape == "drum" else of_vane) | {"motion": turning}) == (None, None)
