"""Case files: every bad one gives one sentence with the field, the value and what is allowed."""

import copy
import json
import os
from pathlib import Path

import pytest

from mpmkit.case import case_schema, load_case, parse_case
from mpmkit.case.allowed import Place
from mpmkit.case.resolved import resolved
from mpmkit.errors import CaseError
from mpmkit.registry import installed
from mpmkit.solver.memory import require_memory
from mpmkit.solver.scene import make_particles

CASES = sorted((Path(__file__).parent.parent / "cases").glob("*.json"))
GOOD = {
    "space": "plane-strain",
    "until": 0.1,
    "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]},
            "material": {
                "law": "bingham",
                "density": 2000,
                "yield_stress": 100,
                "plastic_viscosity": 50,
                "sound_speed": {"factor": 10},
            },
        }
    ],
    "scheme": {"shape": "cpgimp", "time_step": {"fraction": 0.3, "ignore": ["viscous"]}},
}
ABSENT = object()
MATERIAL, SHAPE = "bodies.0.material", "bodies.0.shape"
PYDANTICS = (
    "Input should",
    "valid",
    "Extra inputs",
    "Field required",
    "tag",
    "pydantic",
    "Literal",
    "Traceback",
)

BAD = [
    # keys
    ("untill", 1, "the case has an unknown key 'untill'; did you mean 'until'?"),
    ("bogus", 1, "unknown key 'bogus'; it may have name, description, space, until,"),
    ("grid.cellsize", 0.1, "grid has an unknown key 'cellsize'; did you mean 'cell_size'?"),
    ("grid.faces.z_mni", "slip", "are x_min, x_max, z_min, z_max; did you mean 'z_min'?"),
    ("grid.faces.floor", "slip", "the faces of the space 'plane-strain' are x_min, x_max, z_min, z_max"),
    ("grid.domain.Z", [0, 1], "has the axes x, z; did you mean 'z'?"),
    ("bodies.0.shap", {}, "bodies.0 has an unknown key 'shap'; did you mean 'shape'?"),
    (f"{SHAPE}.lowr", [0, 0], "bodies.0.shape has an unknown key 'lowr'; did you mean 'lower'?"),
    (f"{MATERIAL}.densty", 1, "bodies.0.material has an unknown key 'densty'; did you mean 'density'?"),
    (f"{MATERIAL}.flow_index", 1, "unknown key 'flow_index'; it may have law, density, sound_speed,"),
    (
        f"{MATERIAL}.sound_speed",
        {"facto": 1},
        "sound_speed has an unknown key 'facto'; did you mean 'factor'?",
    ),
    ("scheme.shap", "linear", "scheme has an unknown key 'shap'; did you mean 'shape'?"),
    ("scheme.shape", {"name": "cpgimp", "domian": "stretch"}, "unknown key 'domian'; did you mean 'domain'?"),
    ("scheme.time_step.frac", 0.2, "scheme.time_step has an unknown key 'frac'; did you mean 'fraction'?"),
    ("output.histroy_interval", 1, "unknown key 'histroy_interval'; did you mean 'history_interval'?"),
    ("line\nbreak", 1, "unknown key 'line break'"),
    (
        MATERIAL,
        {"law": "bingham-evp", "density": 1, "sound_speed": 1, "yield_stress": 1, "plastic_viscosity": 1}
        | {"shear_modulus": 1e308},
        "bodies.0.material makes waves of",
    ),
    # missing
    ("until", ABSENT, "until is missing; it must be a number above 0, in s"),
    (
        "grid",
        ABSENT,
        "it must be an object with the keys 'cell_size' and 'domain', and optionally the key 'faces'",
    ),
    ("bodies", ABSENT, "bodies is missing; it must be a list of one or more objects"),
    (
        f"{SHAPE}.kind",
        ABSENT,
        'shape.kind is missing; it must be "frustum", "cylinder", "box", "sphere" or "mesh"',
    ),
    (f"{MATERIAL}.law", ABSENT, 'material.law is missing; it must be "bingham", "'),
    (f"{MATERIAL}.density", ABSENT, "density is missing; it must be a number above 0, in kg/m^3"),
    (f"{MATERIAL}.sound_speed", ABSENT, "sound_speed is missing; the law 'bingham' needs it, in m/s"),
    ("grid.domain.z", ABSENT, "grid.domain lacks the axis 'z'; it needs x, z, each as [lower, upper]"),
    # types
    (f"{MATERIAL}.density", "2000", 'density is "2000"; it must be a number above 0, in kg/m^3'),
    (f"{MATERIAL}.density", True, "density is true; it must be a number above 0, in kg/m^3"),
    (f"{MATERIAL}.density", None, "density is null; it must be a number above 0"),
    ("bodies", {}, "bodies is {}; it must be a list of objects"),
    ("bodies", [], "bodies is []; it must be a list of one or more objects"),
    (
        "bodies.0",
        3,
        "bodies.0 is 3; it must be an object with the keys 'shape' and 'material', and optionally",
    ),
    (SHAPE, "box", "bodies.0.shape is \"box\"; it must be an object with a 'kind' that is"),
    (f"{SHAPE}.lower", [0.2, "a"], 'bodies.0.shape.lower.1 is "a"; it must be a number, in m'),
    (
        "bodies.0.particles_per_cell",
        2.5,
        "is 2.5; it must be a whole number above 0 and at most 1000, or a list",
    ),
    ("bodies.0.particles_per_cell", [2, 0], "particles_per_cell.1 is 0; it must be a whole number above 0"),
    (
        "bodies.0.velocity",
        1,
        "velocity is 1; it must be a list of numbers, in m/s, or an object with the keys",
    ),
    (
        "grid.faces.z_min",
        3,
        'z_min is 3; it must be "slip", "stick", "periodic", "open" or "symmetry", or an object',
    ),
    (
        "scheme.time_step",
        1e-5,
        "scheme.time_step is 1e-05; it must be an object that may have the keys 'fraction' and 'ignore'",
    ),
    ("scheme.time_step.ignore", "viscous", 'it must be a list of "acoustic", "viscous" or "advective"'),
    ("output.report", "yes", 'output.report is "yes"; it must be true or false'),
    # values
    ("until", -1, "until is -1; it must be a number above 0, in s"),
    ("until", 10**399, "it must be finite"),
    ("space", "2d", 'space is "2d"; it must be "3d", "plane-strain" or "axisymmetric"'),
    ("grid.cell_size", 0, "grid.cell_size is 0; it must be a number above 0, in m"),
    (
        "grid.cell_size",
        1e-300,
        "grid.domain.x has 1e+300 cells of 1e-300 m; at most 1,073,741,824 are possible",
    ),
    ("grid.domain.x", [1, 0], "grid.domain.x is [1, 0]; the lower end must be below the upper one"),
    ("grid.domain.x", [-1.7e308, 1.7e308], "grid.domain.x has inf cells"),
    ("grid.domain.y", [0, 1], "grid.domain has an axis 'y'; the space 'plane-strain' has the axes x, z"),
    (
        "grid.faces.z_min",
        "friction",
        'or "symmetry"; did you mean {"kind": "friction", "coefficient": …}?',
    ),
    ("grid.faces.z_min", "slipp", '"open" or "symmetry"; did you mean "slip"?'),
    (
        "grid.faces.z_min",
        {"kind": "friction", "coefficient": -1},
        "coefficient is -1; it must be a number of at least 0",
    ),
    ("grid.faces.x_min", "periodic", "x_min and x_max must both be 'periodic' if one of them is"),
    ("gravity", [0], "gravity is [0.0]; in the space 'plane-strain' it needs 2 numbers, along x, z"),
    (
        "gravity",
        [0, 0],
        "sound_speed is a factor of √(2 g h), but gravity is [0.0, 0.0]; give the speed itself, in m/s",
    ),
    (
        "name",
        "../x",
        "name is \"../x\"; it must be at most 100 letters, digits, '_', '.' and '-', first a letter",
    ),
    (f"{SHAPE}.upper", [0.6, 2], "reaches z = 2 m, outside the grid, whose domain along z is [0, 1] m"),
    (f"{SHAPE}.lower", [-0.6, 0], "only a face with 'symmetry' may cut a body"),
    (
        f"{SHAPE}.lower",
        [0.7, 0.1],
        "bodies.0.shape: upper is [0.6, 0.4], but it must be above lower, [0.7, 0.1]",
    ),
    (
        SHAPE,
        {"kind": "box", "lower": [0.51, 0.51], "upper": [0.52, 0.52]},
        "holds no particle at a cell size of 0.1 m",
    ),
    (
        "bodies.0.particles_per_cell",
        5,
        "particles_per_cell is 5; one number must be a square (1, 4, 9, 16, …)",
    ),
    ("scheme.time_step.fraction", 2, "fraction is 2; it must be a number above 0 and at most 1"),
    ("scheme.time_step.ignore", ["viscous", "acoustic"], "it must not contain 'acoustic'"),
    ("output.frame_interval", 1e-9, "output.frame_interval is 1e-09 s; it must be at least 1e-06 s"),
    # plug-ins
    (f"{MATERIAL}.law", "bingam", '.law is "bingam"; it must be "bingham", "'),
    (f"{MATERIAL}.law", ["bingham"], '.law is ["bingham"]; it must be "bingham", "'),
    (
        "scheme.shape",
        "cpgim",
        'scheme.shape is "cpgim"; it must be "cpgimp" or "linear"; did you mean "cpgimp"?',
    ),
    (
        "scheme.shape",
        3,
        'scheme.shape is 3; it must be "cpgimp" or "linear", or an object with such a \'name\'',
    ),
    ("scheme.shape", None, "scheme.shape is null; it must be"),
    ("scheme.shape", [], "scheme.shape is []; it must be"),
    ("scheme.shape", {}, 'scheme.shape.name is missing; it must be "cpgimp" or "linear"'),
    ("scheme.order", "USL", 'scheme.order is "USL"; it must be "musl", "usf" or "usl"; did you mean "usl"?'),
    (
        "scheme.shape",
        {"name": "cpgimp", "domain": "strech"},
        '"strech"; it must be "strain", "fixed", "stretch" or "volume"',
    ),
    (
        f"{MATERIAL}.equation_of_state",
        {"name": "linear", "foo": 1},
        "equation_of_state has an unknown key 'foo'",
    ),
]


RADIAL = {
    "space": "axisymmetric",
    "grid": {"cell_size": 0.1, "domain": {"r": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
}


def changed(path, value):
    data = copy.deepcopy(GOOD)
    here = data
    *above, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    for key in above:
        here = here.setdefault(key, {}) if isinstance(here, dict) else here[key]
    if value is ABSENT:
        del here[last]
    else:
        here[last] = value
    return data


def sentence(action, *arguments, **options):
    with pytest.raises(CaseError) as refused:
        action(*arguments, **options)
    text = str(refused.value)
    assert "\n" not in text
    assert not any(word in text.replace("not valid JSON", "").replace("shape", "") for word in PYDANTICS), (
        text
    )
    return text


@pytest.mark.parametrize(
    ("path", "value", "expected"), BAD, ids=[f"{path}-{k}" for k, (path, *_) in enumerate(BAD)]
)
def test_a_bad_value_is_told_of(path, value, expected):
    def prepare():
        make_particles(parse_case(changed(path, value)))

    assert expected in sentence(prepare)


@pytest.mark.parametrize("faces", [{"r_max": "periodic"}, {"r_min": "periodic", "r_max": "periodic"}])
def test_the_radial_axis_has_no_period(faces):
    data = GOOD | RADIAL | {"grid": RADIAL["grid"] | {"faces": faces}}
    assert f'grid.faces.{next(iter(faces))} is "periodic"; the radial axis has no' in sentence(
        parse_case, data
    )


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_what_python_can_say_and_json_cannot_is_told_with_its_place(value):
    expected = f"{value} is not a number that a case can have"
    assert f"until: {expected}" in sentence(parse_case, changed("until", value))
    assert f"bodies.0.shape.lower.1: {expected}" in sentence(
        parse_case, changed(f"{SHAPE}.lower", [0, value])
    )


ANYTHING = (None, True, -7, "nonsense", [], {}, [None], {"name": None}, {"kind": {}}, [[]])
SCENE = "until space gravity grid grid.cell_size grid.domain grid.domain.x grid.faces grid.faces.z_min bodies"
BODY = "shape shape.kind shape.lower velocity material material.law material.density material.sound_speed"
REST = (
    "scheme scheme.shape scheme.order scheme.time_step scheme.time_step.ignore output output.snapshot_times "
    "output.report output.particle_history name description bodies.0 bodies.0.material.equation_of_state"
)
PLACES = [*SCENE.split(), *(f"bodies.0.{place}" for place in BODY.split()), *REST.split()]
MAY_BE = {
    "gravity": [None],
    "grid.faces": [{}],
    "bodies.0.velocity": [None],
    "scheme": [{}],
    "scheme.time_step": [{}],
    "scheme.time_step.ignore": [[]],
    "output": [{}],
    "output.snapshot_times": [[]],
    "output.report": [True],
    "output.particle_history": [[]],
    "name": ["nonsense"],
    "description": ["nonsense"],
}


@pytest.mark.parametrize("place", PLACES)
def test_whatever_stands_wherever_gives_one_sentence(place):
    for value in ANYTHING:
        if value in MAY_BE.get(place, []):
            parse_case(changed(place, value))
        else:
            assert place.split(".")[0] in sentence(parse_case, changed(place, value))


def test_more_errors_are_counted_not_listed():
    data = changed("until", -1) | {"space": "2d"}
    text = sentence(parse_case, data)
    assert text.endswith("(and 1 more)")


def test_what_a_misspelling_leaves_missing_is_not_counted():
    data = changed("grid.cellsize", 0.1)
    del data["grid"]["cell_size"]
    assert sentence(parse_case, data).endswith("did you mean 'cell_size'?")


def test_too_much_memory_is_refused_before_anything_is_made():
    for path, value in (("grid.cell_size", 1e-6), ("grid.cell_size", 1e-8)):
        text = sentence(require_memory, parse_case(changed(path, value)))
        assert "GiB" in text
        assert "use larger cells" in text
    kept = changed("output.particle_history", ["stress"])
    kept["grid"]["cell_size"] = 1e-4
    kept["output"]["history_interval"] = 2e-6
    assert "fewer rows" in sentence(require_memory, parse_case(kept))


def test_bodies_far_apart_are_told_what_takes_the_memory():
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
        ('{"until": 1, "until": 2}', "the key 'until' stands twice in one object"),
        ('{"a": {"b": 1, "b": 1}}', ": a: the key 'b' stands twice"),
        ('{"a": [{"b": 1}, {"b": {"c": 1, "c": 1}}], "d": NaN}', ": a.1.b: the key 'c' stands twice"),
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
def test_a_bad_file_is_told_of(content, expected, tmp_path):
    path = tmp_path / "case.json"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    assert expected in sentence(load_case, path)


def test_a_file_that_cannot_be_read_is_told_of(tmp_path):
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
        ('until={"a":1,"a":2}', "the key 'a' stands twice"),
        ("until=", 'until is ""; it must be a number above 0, in s'),
        ("untill=3", "unknown key 'untill'; did you mean 'until'?"),
        (
            "grid.faces.z_min.coefficient=1",
            "grid.faces.z_min is \"slip\", so that it has no 'coefficient' in it",
        ),
    ],
)
def test_a_bad_override_is_told_of(override, expected):
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
