"""Case files: how they are read, overridden and written out; the memory and the height of their scenes."""

import copy
import json
import os
from pathlib import Path

import pytest
from case_sentences import GOOD, changed, sentence

from mpmkit.case import case_schema, load_case, parse_case
from mpmkit.case.allowed import Place
from mpmkit.case.resolved import resolved
from mpmkit.registry import installed
from mpmkit.solver.memory import require_memory

CASES = sorted((Path(__file__).parent.parent / "cases").glob("*.json"))


def test_too_much_memory_is_refused_before_anything_is_made():
    for path, value in (("grid.cell_size", 1e-6), ("grid.cell_size", 1e-8)):
        text = sentence(require_memory, parse_case(changed(path, value)))
        assert "GiB" in text
        assert "use larger cells" in text
    kept = changed("output.particle_history", ["stress"])
    kept["grid"]["cell_size"] = 1e-4
    kept["output"]["history_interval"] = 2e-6
    assert "fewer rows" in sentence(require_memory, parse_case(kept))


def test_the_sentence_about_bodies_far_apart_names_the_cause():
    far = changed("grid.domain", {"x": [-25_000, 25_000], "z": [0, 25_000]})
    other = copy.deepcopy(far["bodies"][0])
    other["shape"] |= {"lower": [20_000, 20_000], "upper": [20_000.4, 20_000.4]}
    far["bodies"].append(other)
    text = sentence(require_memory, parse_case(far))
    assert "the window over all bodies, the gap between them included, spans 2e+04 × 2e+04 m: its" in text
    assert "or bring the bodies closer together" in text


def test_a_resolved_case_says_where_a_body_stands_and_can_be_run():
    body = {
        "shape": {"kind": "cylinder", "radius": 0.2, "height": 0.4},
        "material": GOOD["bodies"][0]["material"],
    }
    grid = {"cell_size": 0.1, "domain": {"x": [-1, 1], "z": [0, 1]}}
    case = resolved(parse_case(GOOD | {"bodies": [body], "grid": grid}))
    assert case["bodies"][0]["shape"]["base"] == [0.0, 0.0]
    assert resolved(parse_case(case)) == case


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("", "the case file is empty"),
        ("[]", "a case must be a JSON object, not []"),
        ("{,}", "is not valid JSON: at line 1, column 2, there is a comma too many"),
        ('{"until": 1, "until": 2}', "the key 'until' appears twice in one object"),
        ('{"a": {"b": 1, "b": 1}}', ": a: the key 'b' appears twice"),
        ('{"a": [{"b": 1}, {"b": {"c": 1, "c": 1}}], "d": NaN}', ": a.1.b: the key 'c' appears twice"),
        ('{"until": NaN}', ": until: NaN is not a number that a case can have"),
        ('{"a": [1, [2, NaN]]}', ": a.1.1: NaN is not a number"),
        ('{"until": -Infinity}', ": until: -Infinity is not a number"),
        ('{"until": 1e999}', "1e999 is not a number"),
        ('{"until": 1' + "0" * 5000 + "}", "has 5001 digits"),
        ("[" * 100_000, "nested too deeply"),
        ('{"a":' * 400 + "1" + "}" * 400, "nested too deeply"),
        (b"\x80\x81", "is not a UTF-8 text file"),
        ("\0\0", "is not valid JSON"),
        ('{"space": "\\ud800"}', "is not valid JSON"),
    ],
)
def test_a_bad_file_has_its_sentence(content, expected, tmp_path):
    path = tmp_path / "case.json"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    assert expected in sentence(load_case, path)


def test_a_file_that_cannot_be_read_has_its_sentence(tmp_path):
    assert "No such file" in sentence(load_case, tmp_path / "missing.json")
    assert "Is a directory" in sentence(load_case, tmp_path)
    assert "cannot be read" in sentence(load_case, "a\0b")
    locked = tmp_path / "locked.json"
    locked.write_text("{}")
    locked.chmod(0)
    if not os.access(locked, os.R_OK):  # root reads everything
        assert "Permission denied" in sentence(load_case, locked)


def test_a_byte_order_mark_and_an_editors_schema_do_no_harm(tmp_path):
    path = tmp_path / "case.json"
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps(GOOD | {"$schema": "mpmkit.schema.json"}).encode())
    assert load_case(path).name == "case"


@pytest.mark.parametrize(
    ("file", "name"), [("my case.json", "my-case"), ("übung.json", "bung"), ("-.json", "case")]
)
def test_the_name_comes_from_the_file(file, name, tmp_path):
    path = tmp_path / file
    path.write_text(json.dumps(GOOD))
    assert load_case(path).name == name


def test_overrides():
    case = parse_case(
        GOOD,
        [
            "until=0.5",
            "scheme.shape.domain=stretch",
            "bodies.0.material.yield_stress=7",
            "grid.faces.x_min=stick",
        ],
    )
    assert case.until == 0.5
    assert case.scheme.shape.domain == "stretch"
    assert case.bodies[0].material.yield_stress == 7
    assert case.grid.faces["x_min"] == "stick"
    assert "until" in GOOD
    assert GOOD["until"] == 0.1


@pytest.mark.parametrize(
    ("override", "expected"),
    [
        ("until", "--set until: it must read path.to.key=value, such as scheme.order=usf"),
        ("=3", "it must read path.to.key=value"),
        ("..until=3", "it must read path.to.key=value"),
        (".".join("a" * 500) + "=3", "it must read path.to.key=value"),
        ("until.x=3", "--set until.x=3: until is 0.1, so that it has no 'x' in it"),
        ("bodies.5.shape=3", "--set bodies.5.shape=3: bodies is a list of 1, so that '5' must be 0"),
        ("bodies.²=3", "so that '²' must be 0"),
        ("until=NaN", "--set until=NaN: NaN is not a number"),
        ("until=1e999", "--set until=1e999: 1e999 is not a number"),
        ("until=" + "[" * 100_000, "nested too deeply"),
        ('until={"a":1,"a":2}', "the key 'a' appears twice"),
        ("until=", 'until is ""; it must be a number above 0, in s'),
        ("untill=3", "unknown key 'untill'; did you mean 'until'?"),
        (
            "grid.faces.z_min.coefficient=1",
            "grid.faces.z_min is \"slip\", so that it has no 'coefficient' in it",
        ),
    ],
)
def test_a_bad_override_has_its_sentence(override, expected):
    assert expected in sentence(parse_case, GOOD, [override])


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_the_cases_of_the_repository_are_valid(path):
    load_case(path)


def test_the_resolved_case_is_a_case():
    case = parse_case(GOOD)
    resolved = case.model_dump(mode="json")
    assert parse_case(resolved).model_dump(mode="json") == resolved


def test_the_schema_has_units_descriptions_and_every_plugin():
    schema = case_schema(installed())
    json.dumps(schema)
    assert schema["$schema"].endswith("2020-12/schema")
    assert Place(schema, {}, ["until"]).unit == "s"
    assert Place(schema, GOOD, ["bodies", 0, "material", "yield_stress"]).unit == "Pa"
    assert Place(schema, {}, ["grid", "cell_size"]).unit == "m"
    for kind in ("shape", "order", "velocity", "volumetric", "redistribution", "refinement"):
        place = Place(schema, {}, ["scheme", kind])
        names = list(installed().of_kind(kind))
        assert sorted(place.choices()) == names  # the shorthand, for completion
        assert place.selector() == ("name", place.choices())
    for kind in ("surface", "contact"):
        place = Place(schema, {}, ["walls", "mould", kind])
        assert place.selector() == ("kind", list(installed().of_kind(kind)))
    assert sorted(Place(schema, {}, ["walls", "mould", "contact"]).choices()) == ["slip", "stick"]
    laws = Place(schema, GOOD, ["bodies", 0, "material"])
    assert sorted(laws.selector()[1]) == list(installed().of_kind("law"))
    for kind, plugins in installed().plugins.items():
        for entry in plugins.values():
            for name, parameter in entry.plugin.model_json_schema().get("properties", {}).items():
                assert name == entry.plugin.named_by or parameter.get("description"), (kind, entry.name, name)


@pytest.mark.parametrize("sound_speed", [{"factor": 10}, {"mach": 0.1}], ids=["factor", "mach"])
def test_the_height_of_a_scene_is_along_gravity(sound_speed):
    """Fault 40: a column turned on its side, gravity with it, had 19.8 for 62.6 m/s of sound."""

    def column(along, across):
        order = sorted((along, across), key="xz".index)
        vector = {along: -9.81, across: 0.0}
        body = {along: 2.0, across: 0.2}
        data = {
            "space": "plane-strain",
            "until": 0.1,
            "gravity": [vector[axis] for axis in order],
            "grid": {"cell_size": 0.05, "domain": {along: [0, 3], across: [0, 0.2]}},
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [0, 0], "upper": [body[axis] for axis in order]},
                    "material": {
                        "law": "bingham-evp", "density": 2574, "sound_speed": sound_speed,
                        "yield_stress": 50.0, "plastic_viscosity": 20.0,
                    },
                }
            ],
        }  # fmt: skip
        return parse_case(data)

    for case in (column("z", "x"), column("x", "z")):
        assert case.height == pytest.approx(2.0, rel=1e-12)
        assert case.largest_energy == pytest.approx(9.81 * 2.0, rel=1e-12)
        assert case.sound_speed(case.bodies[0].material) == pytest.approx(62.64, rel=1e-4)


def test_the_height_of_a_scene_on_a_slope_is_across_it():
    """Along a periodic axis gravity has nothing to fall to; without gravity the last axis stands for it."""
    data = {
        "space": "plane-strain",
        "until": 0.1,
        "gravity": [3.0, -9.0],
        "grid": {
            "cell_size": 0.05,
            "domain": {"x": [0, 1], "z": [0, 1]},
            "faces": {"x_min": "periodic", "x_max": "periodic"},
        },
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0, 0], "upper": [1, 0.2]},
                "material": {"law": "newtonian", "density": 1000, "viscosity": 1, "sound_speed": 10},
            }
        ],
    }
    assert parse_case(data).height == pytest.approx(0.2, rel=1e-12)
    assert parse_case(data | {"gravity": [3.0, 0.0]}).height == pytest.approx(0.2, rel=1e-12)
    assert parse_case(data | {"gravity": [0.0, 0.0]}).height == pytest.approx(0.2, rel=1e-12)
    del data["grid"]["faces"]
    tilted = (3.0 * 1.0 + 9.0 * 0.2) / (90.0**0.5)  # from the lowest corner to the highest
    assert parse_case(data).height == pytest.approx(tilted, rel=1e-12)
