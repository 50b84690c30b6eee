"""Walls in a case: the sentences about wrong ones."""

import copy
import re
from itertools import islice, product

import pytest
from wall_case import ABSENT, FLOOR, FRUSTUM, MOTION, MOULD, SHAPE, SURFACE, changed, sentence

from mpmkit.case import parse_case
from mpmkit.errors import CaseError
from mpmkit.solver.scene import make_particles

BALL = {"kind": "sphere", "centre": [0, 0.1], "radius": 0.4}
BAD = [
    # numbers
    (
        f"{MOTION}.velocity",
        [0, 1e300],
        "motion.velocity.1 is 1e+300; it must be between -1e+09 and 1e+09",
    ),
    (f"{MOTION}.velocity", [0, 1e7], "walls.mould.surface moves at 1e+07 m/s; it must be at most 1e+06 m/s"),
    (f"{SHAPE}.height", 1e-300, "the frustum is so flat that a shell of it has no end"),
    (
        MOTION,
        {"kind": "table", "times": [0, 1e-300], "positions": [[0, 0], [0, 1]]},
        "positions go from [0.0, 0.0] to [0.0, 1.0] in 1e-300 s, which is too fast",
    ),
    # names
    ("walls.z_min", MOULD, "a wall called 'z_min', which is the name of a face of the grid"),
    ("walls.my mould", MOULD, "a wall called \"my mould\"; its name must be of letters, digits, '_' and '-'"),
    ("walls.", MOULD, 'a wall called ""; its name'),
    ("walls", [MOULD], "it must be an object in which each value is an object with the keys 'surface' and"),
    # kinds
    (
        f"{SURFACE}.kind",
        "bdy",
        'surface.kind is "bdy"; it must be "body" or "plane"; did you mean "body"?',
    ),
    (f"{SURFACE}.kind", ABSENT, "walls.mould.surface.kind is missing"),
    (SURFACE, "plane", "walls.mould.surface.point is missing"),
    ("walls.mould.contact", "no-slip", 'did you mean "stick"?'),
    ("walls.mould.contact", "friction", 'did you mean {"kind": "coulomb", "coefficient": …}?'),
    (
        "walls.mould.contact",
        {"kind": "coulomb"},
        "contact.coefficient is missing; it must be a number",
    ),
    (
        "walls.mould.contact",
        {"kind": "coulomb", "coefficient": -1},
        "is -1; it must be a number of at",
    ),
    ("walls.mould.contact", {"kind": "navier-slip", "slip_lenght": 1}, "did you mean 'slip_length'?"),
    ("walls.mould.contact", ABSENT, "walls.mould.contact is missing"),
    ("walls.mould.contac", "slip", "walls.mould has an unknown key 'contac'; did you mean 'contact'?"),
    (f"{MOTION}.kind", "spin", 'did you mean "rotation"?'),
    # the surface
    (f"{SURFACE}.thickness", 0.019, "walls.mould.surface is 0.019 m thick, less than a cell of 0.02 m"),
    (f"{SURFACE}.thickness", 0, "thickness is 0; it must be a number above 0, in m"),
    (f"{SURFACE}.side", "within", 'it must be "inside" or "outside"'),
    (
        f"{SURFACE}.side",
        "outside",
        "thickness is 0.02 m, but with side 'outside' the wall is",
    ),
    (f"{SURFACE}.open", ["lid"], "open is ['lid']; of this frustum 'bottom', 'top' can be open"),
    (
        f"{SHAPE}.base",
        [0.1, 0],
        "base is [0.1, 0.0], but in the space axisymmetric it must be [0, z]",
    ),
    (f"{SHAPE}.base", [0, 0, 0], "the space axisymmetric needs 2 numbers (r, z)"),
    (
        f"{SHAPE}.base",
        [0, 5.0],
        "walls.mould.surface is outside the domain of the grid at all times",
    ),
    (f"{SURFACE}.thickness", float("nan"), "every number must be finite"),
    # the motion
    (
        f"{MOTION}.velocity",
        [0.1, 0.3],
        "the motion's velocity is [0.1, 0.3], but in the space",
    ),
    (
        f"{MOTION}.velocity",
        [0, 0, 0.3],
        "the motion's velocity is [0.0, 0.0, 0.3], but the",
    ),
    (
        MOTION,
        {"kind": "rotation", "point": [0, 0], "rate": 1},
        "kind is 'rotation', which the space",
    ),
    (f"{MOTION}.end", -1.0, "walls.mould.surface.motion: end is -1 s; it must be above start, 0 s"),
    (MOTION, {"kind": "table", "times": [0, 0], "positions": [[0, 0], [0, 1]]}, "times has 0 s after 0 s"),
    (MOTION, {"kind": "table", "times": [0, 1], "positions": [[0, 0]]}, "positions"),
    (
        f"{SURFACE}.vanishes",
        0.0,
        "surface: vanishes is 0 s; it must be above 0 s, when the wall appears",
    ),
]


@pytest.mark.parametrize(("path", "value", "part"), BAD)
def test_a_bad_wall_is_one_sentence(path, value, part):
    said = sentence(changed(path, value))
    assert part in said


@pytest.mark.parametrize(
    ("wall", "part"),
    [
        ({"kind": "plane", "point": [0, 0, 0], "normal": [0, 1]}, "point is [0.0, 0.0, 0.0], but the space"),
        (
            {"kind": "plane", "point": [0, 0], "normal": [0, 0]},
            "normal is [0.0, 0.0]; it must be a",
        ),
        (
            {
                "kind": "plane",
                "point": [0, 0],
                "normal": [0, 1],
                "motion": {"kind": "rotation", "point": [0, 0], "rate": 1},
            },
            "a plane is infinite, and so would be its speed; use a body, such as a box",
        ),
        (
            {
                "kind": "body",
                "shape": BALL | {"radius": 9.0},
                "side": "inside",
            },
            "walls.mould.surface is outside the domain",
        ),
        (
            {
                "kind": "body",
                "shape": BALL,
                "side": "inside",
                "thickness": 0.1,
                "open": ["top"],
            },
            "open is ['top'], but a sphere has no ends that can be open: leave it out",
        ),
        (
            {
                "kind": "body",
                "shape": {"kind": "box", "lower": [0, -0.1], "upper": [0.4, 0.4]},
                "side": "inside",
                "thickness": 0.1,
                "open": ["r_max", "z_min", "z_max"],
            },
            "which leaves no wall: one face must stay closed",
        ),
        (
            {"kind": "body", "shape": FRUSTUM, "side": "inside", "open": ["top"]},
            "open is ['top'], but only a shell has ends that can be open: give its thickness",
        ),
        (
            {
                "kind": "body",
                "shape": {"kind": "box", "lower": [0.4, 0], "upper": [0.415, 0.2]},
                "side": "outside",
            },
            "walls.mould.surface is 0.015 m thick, less than a cell of 0.02 m",
        ),
        (
            {
                "kind": "body",
                "shape": {"kind": "cylinder", "radius": 0.009, "height": 0.2},
                "side": "outside",
            },
            "walls.mould.surface is 0.018 m thick",
        ),
        ({"kind": "body", "shape": {"kind": "mesh", "file": "x.stl"}, "side": "inside"}, "only in 3d"),
    ],
)
def test_a_surface_that_cannot_be(wall, part):
    surface = changed(
        "walls.mould.surface", wall, "space", "plane-strain", "grid.domain", {"x": [0, 0.5], "z": [0, 1]}
    )
    for data in (surface, changed("walls.mould.surface", wall)):
        try:
            parse_case(data)
        except CaseError as error:
            if part in str(error):
                return
    pytest.fail(f"nothing says {part!r}: {sentence(data)}")


def places(value, path=()):
    """Of all that stands in a part of a case."""
    yield path
    if isinstance(value, dict | list):
        for key in value if isinstance(value, dict) else range(len(value)):
            yield from places(value[key], (*path, key))


JUNK = [
    *(
        None,
        True,
        0,
        -1,
        1e300,
        -1e300,
        1e-300,
        "",
        "x",
        "body",
        "slip",
        [],
        [0],
        [0, 0],
        [0, 0, 0],
        [1e308] * 2,
    ),
    *(
        [1e308] * 3,
        {},
        {"kind": "x"},
        {"kind": "velocity"},
        [[0, 0], [1, 1]],
        [None] * 2,
        ["top"],
        ["z_max"] * 2,
    ),
    *({"kind": "rotation", "point": [0, 0], "rate": 1}, MOULD),
]
CRATE = {"kind": "box", "lower": [-0.3, -0.3, -0.3], "upper": [0.3, 0.3, 0.3]}
TURN = {"kind": "rotation", "point": [0, 0, 0], "axis": [0, 0, 1], "rate": 2}
TABLE = {"kind": "table", "times": [0, 1.0], "positions": [[0, 0], [0, 0.1]]}
SCENES = {
    "axisymmetric": {
        "mould": MOULD,
        "floor": FLOOR | {"surface": FLOOR["surface"] | {"motion": TABLE}},
        "ball": {
            "surface": {
                "kind": "body",
                "shape": BALL | {"centre": [0.3, 0.2], "radius": 0.05},
                "side": "outside",
            },
            "contact": {"kind": "coulomb", "coefficient": 0.3},
        },
    },
    "3d": {
        "crate": {
            "surface": {"kind": "body", "shape": CRATE, "side": "inside", "thickness": 0.06, "motion": TURN},
            "contact": {"kind": "navier-slip", "slip_length": 0.1},
        }
    },
}


@pytest.mark.parametrize("space", SCENES)
def test_any_value_in_a_wall_is_read_or_has_its_sentence(space):
    """A sixth of all wrong values at all places, extreme numbers included; NumPy must not warn."""
    walls = {"walls": SCENES[space]}
    data = changed() | walls
    if space == "3d":
        ball = {"kind": "sphere", "centre": [0, 0, 0], "radius": 0.2}
        grid = {"cell_size": 0.05, "domain": {axis: [-0.5, 0.5] for axis in "xyz"}}
        data |= {"space": "3d", "grid": grid, "bodies": [data["bodies"][0] | {"shape": ball}]}
    told = []
    for path, junk in islice(product(places(walls), JUNK), len(JUNK), None, 6):
        bad = copy.deepcopy(data)
        here = bad
        for key in path[:-1]:
            here = here[key]
        here[path[-1]] = copy.deepcopy(junk)
        try:
            make_particles(parse_case(bad))
        except CaseError as error:
            told.append(str(error))
    assert len(told) > 100
    assert not [said for said in told if re.search("\n|Input should|pydantic|union_tag", said)]
