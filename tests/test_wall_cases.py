"""Walls in a case: overlaps with bodies, and reading and writing."""

import json
import pickle

import numpy as np
import pytest
from wall_case import ABSENT, FLOOR, SHAPE, SLUMP, SURFACE, changed, sentence

from mpmkit.case import case_schema, load_case, parse_case
from mpmkit.case.forewarnings import forewarnings
from mpmkit.case.plugins import cautions, plugins_of
from mpmkit.case.resolved import resolved
from mpmkit.cli import main
from mpmkit.registry import installed
from mpmkit.running.case_files import from_copies, named_files, portable
from mpmkit.solver.scene import make_particles

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
    assert used[-3:] == [("surface", "body"), ("contact", "slip"), ("body_shape", "frustum")]


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
