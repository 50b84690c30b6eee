"""Walls in a case: what is read, and the sentence for what cannot be."""

import copy
import json
import pickle
import re
from itertools import islice, product

import numpy as np
import pytest

from mpmkit.case import case_schema, load_case, parse_case
from mpmkit.case.forewarnings import forewarnings
from mpmkit.case.plugins import cautions, plugins_of
from mpmkit.case.resolved import resolved
from mpmkit.cli import main
from mpmkit.errors import CaseError
from mpmkit.registry import installed
from mpmkit.running.case_files import from_copies, named_files, portable
from mpmkit.solver.scene import make_particles

FRUSTUM = {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": 0.3}
BALL = {"kind": "sphere", "centre": [0, 0.1], "radius": 0.4}
BOX = {"kind": "box", "lower": [0.4, 0], "upper": [0.5, 0.2]}
ROD = {"kind": "cylinder", "radius": 0.009, "height": 0.2}
LIFT = {"kind": "velocity", "velocity": [0, 0.3], "start": 0}
MOULD = {
    "surface": {"kind": "body", "shape": dict(FRUSTUM), "side": "inside", "thickness": 0.02, "motion": LIFT},
    "contact": "slip",
}
FLOOR = {"surface": {"kind": "plane", "point": [0, 0], "normal": [0, 1]}, "contact": "stick"}
SLUMP = {
    "space": "axisymmetric",
    "until": 0.1,
    "grid": {"cell_size": 0.02, "domain": {"r": [0, 0.5], "z": [0, 0.32]}, "faces": {"z_min": "slip"}},
    "bodies": [
        {
            "shape": FRUSTUM,
            "material": {
                "law": "bingham-evp",
                "density": 2400,
                "sound_speed": {"mach": 0.1},
                "yield_stress": 200,
                "plastic_viscosity": 50,
            },
        }
    ],
    "walls": {"mould": MOULD},
}
ABSENT = object()


def changed(*changes):
    """The slump with other values at paths; what is ``ABSENT`` is taken out."""
    data = copy.deepcopy(SLUMP)
    for path, value in zip(changes[::2], changes[1::2], strict=True):
        *keys, last = path.split(".")
        here = data
        for key in keys:
            here = here[int(key) if isinstance(here, list) else key]
        if value is ABSENT:
            del here[last]
        else:
            here[last] = value
    return data


def sentence(data, overrides=()):
    with pytest.raises(CaseError) as caught:
        make_particles(parse_case(data, overrides))
    assert "\n" not in str(caught.value)
    return str(caught.value)


SURFACE, SHAPE, MOTION = "walls.mould.surface", "walls.mould.surface.shape", "walls.mould.surface.motion"
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
            "a plane has no end, and its speed would have none; use a body, such as a box",
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
def test_whatever_stands_in_a_wall_is_read_or_told_of(space):
    """Every sixth of all junk at all places: numbers beyond reason as well, and no warning of NumPy."""
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


# --- What is in the way -----------------------------------------------------------------------------------


def test_a_body_in_its_mould_touches_it_and_no_more():
    particles = make_particles(parse_case(SLUMP))
    assert len(particles) > 100


def test_a_body_that_overlaps_a_wall_is_refused():
    """The mould stands 60 mm too low: by its slope the wall is in the body, up to 10 mm deep."""
    said = sentence(changed(f"{SHAPE}.base", [0, -0.06]))
    assert "bodies.0.shape overlaps the wall 'mould': about " in said
    assert "m³" in said
    assert "deepest at (0." in said
    assert said.endswith("a body may touch a wall but not overlap it")


def test_the_volume_that_is_shared_is_about_right():
    """An obstacle 0.15 m high reaches a third of the height of a block."""
    wall = {"kind": "body", "shape": {"kind": "cylinder", "radius": 0.3, "height": 0.15}, "side": "outside"}
    body = {"kind": "cylinder", "radius": 0.1, "height": 0.15, "base": [0, 0.1]}
    said = sentence(changed("walls.mould.surface", wall, "bodies.0.shape", body))
    assert "0.33 of it, is in the wall, deepest at (" in said
    shared = float(said.split("about ")[1].split(" m³")[0])
    assert shared == pytest.approx(np.pi * 0.1**2 * 0.05, rel=0.03)


def test_a_wall_that_appears_later_may_be_where_a_body_is():
    make_particles(parse_case(changed(f"{SHAPE}.base", [0, -0.06], f"{SURFACE}.appears", 0.05)))


def test_a_wall_that_comes_into_the_domain_is_allowed():
    plunger = {"kind": "plane", "point": [0, 0.6], "normal": [0, -1]}
    plunger["motion"] = {"kind": "velocity", "velocity": [0, -5.0]}
    parse_case(changed("walls.plunger", {"surface": plunger, "contact": "slip"}))
    parse_case(changed("walls.plunger", {"surface": plunger | {"appears": 0.08}, "contact": "slip"}))
    assert "walls.plunger.surface is outside" in sentence(
        changed("walls.plunger", {"surface": plunger | {"vanishes": 0.04}, "contact": "slip"})
    )
    plunger["motion"] = {"kind": "velocity", "velocity": [0, -1.0]}
    assert "walls.plunger.surface is outside" in sentence(
        changed("walls.plunger", {"surface": plunger, "contact": "slip"})
    )


# --- What is read -----------------------------------------------------------------------------------------


def test_a_case_without_walls_has_none():
    case = parse_case(changed("walls", ABSENT))
    assert case.walls == {}
    assert resolved(case)["walls"] == {}


def test_a_case_with_walls_can_go_to_another_process():
    case = parse_case(SLUMP)
    assert pickle.loads(pickle.dumps(case)) == case


def test_the_resolved_case_is_the_same_case():
    data = resolved(parse_case(SLUMP))
    assert data["walls"]["mould"]["contact"] == {"kind": "slip"}
    assert data["walls"]["mould"]["surface"]["kind"] == "body"
    assert data["walls"]["mould"]["surface"]["shape"]["base"] == [0.0, 0.0]
    assert resolved(parse_case(data)) == data


def test_a_parameter_of_a_contact_that_is_named_by_a_word_can_be_set():
    case = parse_case(changed("walls.mould.contact", "coulomb"), ["walls.mould.contact.coefficient=0.4"])
    assert case.walls["mould"].contact.coefficient == 0.4
    case = parse_case(
        SLUMP, ["walls.mould.surface.motion.velocity=[0,0.1]", "walls.mould.surface.motion.start=0.02"]
    )
    assert case.walls["mould"].surface.motion.velocity == [0, 0.1]


def test_its_plug_ins_are_named():
    used = [(kind, plugin.name) for kind, plugin in plugins_of(parse_case(SLUMP))]
    assert used[-2:] == [("surface", "body"), ("contact", "slip")]


def test_the_schema_has_every_surface_and_contact():
    text = json.dumps(case_schema(installed()))
    for kind in ("surface", "contact"):
        for name in installed().of_kind(kind):
            assert f'"kind": {{"const": "{name}"}}' in text


def test_a_floor_that_is_a_wall_holds_what_is_above_it():
    open_below = changed("grid.faces", {}, "walls", {})
    assert any("has no floor" in said for said in forewarnings(parse_case(open_below)))
    data = changed("grid.faces", {}, "grid.domain.z", [-0.04, 0.32], "walls", {"floor": FLOOR})
    assert not any("has no floor" in said for said in forewarnings(parse_case(data)))


def test_the_mesh_of_a_wall_goes_with_the_run(tmp_path):
    import trimesh

    trimesh.creation.box(extents=(0.2, 0.2, 0.3)).export(tmp_path / "box.stl")
    body = {"kind": "box", "lower": [-0.1, -0.1, -0.1], "upper": [0.1, 0.1, 0.1]}
    mesh = {"kind": "mesh", "file": "box.stl"}
    data = changed(
        "space",
        "3d",
        "bodies.0.shape",
        body,
        "grid.faces",
        {},
        "grid.domain",
        {a: [-0.2, 0.2] for a in "xyz"},
    )
    data["walls"] = {"box": {"surface": {"kind": "body", "shape": mesh, "side": "inside"}, "contact": "slip"}}
    (tmp_path / "case.json").write_text(json.dumps(data))
    case = load_case(tmp_path / "case.json")
    (file,) = named_files(case)
    assert file.where == "walls.box.surface.shape.file"
    assert portable(case)["walls"]["box"]["surface"]["shape"]["file"] == f"meshes/{file.name}"
    (tmp_path / "copies").mkdir()
    (tmp_path / "copies" / file.name).write_bytes(file.content())
    (tmp_path / "box.stl").unlink()
    copied = from_copies(case, [file], tmp_path / "copies")
    assert copied.walls["box"].surface.shape.file == str(tmp_path / "copies" / file.name)
    assert len(make_particles(copied)) > 0


def test_status_2(tmp_path, capsys):
    (tmp_path / "case.json").write_text(json.dumps(changed(f"{SURFACE}.thickness", 0.01)))
    with pytest.raises(SystemExit) as stop:
        main(["run", str(tmp_path / "case.json"), "--out", str(tmp_path / "out")])
    assert stop.value.code == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("kind", "side", "contact", "said"),
    [
        ("mesh", "inside", "slip", True),
        ("mesh", "inside", "stick", False),
        ("mesh", "outside", "slip", False),
        ("box", "inside", "slip", False),
    ],
)
def test_inner_edges_of_a_mesh_are_cautioned_against_where_material_slips(
    tmp_path, kind, side, contact, said
):
    """Other shapes have a part for each face."""
    import trimesh

    trimesh.creation.box(bounds=[[0.2] * 3, [0.8] * 3]).export(tmp_path / "tub.stl")
    box = {"kind": "box", "lower": [0.2] * 3, "upper": [0.8] * 3}
    shape = box if kind == "box" else {"kind": "mesh", "file": str(tmp_path / "tub.stl")}
    lower = 0.3 if side == "inside" else 0.85
    case = parse_case(
        {
            "space": "3d",
            "until": 0.1,
            "grid": {"cell_size": 0.05, "domain": {a: [0, 1] for a in "xyz"}},
            "walls": {"tub": {"surface": {"kind": "body", "shape": shape, "side": side}, "contact": contact}},
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [lower] * 3, "upper": [lower + 0.1] * 3},
                    "material": {"law": "newtonian", "density": 1000, "viscosity": 1, "sound_speed": 10},
                }
            ],
        }
    )
    assert any("walls.tub is a mesh" in sentence for sentence in cautions(case)) == said
