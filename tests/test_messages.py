"""Messages about cases with synonyms of the right words, or with text that is not quite JSON."""

import copy
import json
import re
import time
import tomllib
from pathlib import Path

import pytest
from case_sentences import GOOD, MATERIAL, changed, sentence

from mpmkit.case import load_case, parse_case
from mpmkit.case.synonyms import WORDS, meant
from mpmkit.errors import CaseError
from mpmkit.registry import Registry, installed

FACE = "grid.faces.z_min"
STICK = "no-slip, noslip, no_slip, No Slip, non-slip, no-slipp, rough, fixed, wall, sticky, closed, solid"
SLIP = "frictionless, free-slip, freeslip, free_slip, slipp, perfect slip, smooth"
FRICTION = '{"kind": "friction", "coefficient": 0.4}'

MEANT = [
    *((FACE, word, '"stick"') for word in STICK.split(", ")),
    *((FACE, word, '"slip"') for word in SLIP.split(", ")),
    (FACE, "free", '"slip" or "open"'),
    (FACE, "coulomb", '{"kind": "friction", "coefficient": …}'),
    ("space", "2d", '"plane-strain" or "axisymmetric"'),
    ("space", "axisymmetry", '"axisymmetric"'),
    ("space", "3D", '"3d"'),
    (f"{MATERIAL}.law", "bingham-papanastasiou", '"bingham"'),
    (f"{MATERIAL}.law", "hb", '"herschel-bulkley-evp" or "herschel-bulkley"'),
    (f"{MATERIAL}.law", "power-law", '"herschel-bulkley-evp" or "herschel-bulkley"'),
    (f"{MATERIAL}.law", "non-newtonian", '"herschel-bulkley-evp" or "herschel-bulkley"'),
    (f"{MATERIAL}.law", "linear-elastic", '"neo-hookean"'),
    ("scheme.velocity", "PIC/FLIP", '"blend"'),
    ("scheme.shape", "gimp", '"cpgimp"'),
    ("scheme.volumetric", "b-bar", '"nodal-average"'),
    ("scheme.volumetric", "none", '"own"'),
    ("scheme.order", "update stress first", '"usf"'),
    ("scheme.time_step.ignore", ["viscosity"], '"viscous"'),
    ("bodies.0.shape", {"kind": "cone"}, '"frustum"'),
    (f"{MATERIAL}.tau0", 100, "'yield_stress'"),
    ("grid.dx", 0.1, "'cell_size'"),
    ("grid.faces.floor", "slip", "'z_min'"),
    ("grid.faces.y_min", "slip", "'z_min'"),
    (FACE, {"kind": "friction", "mu": 0.4}, "'coefficient'"),
    (f"{MATERIAL}.yield_stress", "188,91", "188.91"),
    (f"{MATERIAL}.yield_stress", "188.91", "188.91"),
]


@pytest.mark.parametrize(("path", "word", "name"), MEANT, ids=lambda value: str(value)[:30])
def test_a_word_of_the_field_is_met_with_the_name_that_it_means(path, word, name):
    text = sentence(parse_case, changed(path, word))
    assert f"; did you mean {name}?" in text


@pytest.mark.parametrize(
    ("path", "word"),
    [
        (FACE, "non-periodic"),
        (FACE, "asymmetry"),
        (FACE, "moving"),
        ("space", "plane-stress"),
        ("scheme.velocity", "xpic"),
        ("scheme.shape", "cpdi"),
        ("boundaries", {}),
    ],
)
def test_where_no_name_has_the_meaning_none_is_proposed(path, word):
    assert "did you mean" not in sentence(parse_case, changed(path, word))


def test_every_name_means_itself_and_every_synonym_something_else():
    for names, words in WORDS.items():
        for name in names:
            assert meant(name, [name, "other"]) == [name]
        for word in words.split(", "):
            assert set(meant(word, names)) == set(names)


OBJECTS = [
    ({"friction": 0.4}, FRICTION),
    ({"coefficient": 0.4}, FRICTION),
    ({"friction": {"coefficient": 0.4}}, FRICTION),
    ({"type": "friction", "mu": 0.4}, FRICTION),
    ({"kind": "slip"}, '"slip"'),
    ({"kind": "no-slip"}, '"stick"'),
    ({"kind": "stick"}, '"stick"'),
    ({"slip": True}, '"slip"'),
]


@pytest.mark.parametrize(("value", "right"), OBJECTS, ids=json.dumps)
def test_an_object_for_a_face_is_met_with_what_to_write(value, right):
    expected = f"{FACE}: {json.dumps(value)} must be written as {right}"
    assert sentence(parse_case, changed(FACE, value)) == f"case: {expected}"
    parse_case(changed(FACE, json.loads(right)))  # it is what may stand there


def test_an_unknown_kind_of_face_is_refused_with_the_kinds_there_are():
    text = sentence(parse_case, changed(FACE, {"kind": "moving", "velocity": [1, 0]}))
    assert 'there is no kind of face "moving"; it must be "slip", "stick", "periodic", "open"' in text
    assert FRICTION in text


NEARLY_JSON = {
    "a comment": ('{\n  "until": 1, // s\n  "space": "3d"\n}', "line 2, column 15", "a comment begins"),
    "a shell's comment": ("# slump\n{}", "line 1, column 1", "a comment begins"),
    "a C comment": ('{"until": 1 /* s */}', "line 1, column 13", "a comment begins"),
    "a trailing comma": (
        '{\n  "until": 1,\n}',
        "line 2, column 13",
        "a comma too many: nothing follows it but '}'",
    ),
    "one in a list": ('{"gravity": [0, 1,]}', "line 1, column 18", "a comma too many"),
    "a decimal comma": ('{"yield_stress": 188,91}', "line 1, column 18", "decimal sign must be a point"),
    "another": ('{"a": 0,005, "b": 1}', "line 1, column 7", "not a comma: 0.005"),
    "single quotes": ("{'until': 1}", "line 1, column 2", "in single quotes; JSON has double quotes"),
    "typographic quotes": ("{“until”: 1}", "line 1, column 2", "JSON has double quotes"),
    "YAML": ("space: 3d\nuntil: 4\n", "line 1, column 1", "YAML begins, and JSON is needed"),
    "YAML with a comment": ("# a\n\nspace: 3d\n", "line 1, column 1", "YAML begins, and JSON is needed"),
    "YAML with a directive": ("%YAML 1.2\n---\nspace: 3d\n", "line 1, column 1", "YAML begins, and JSON"),
    "a list in YAML": ("- space: 3d\n", "line 1, column 1", "convert the file, or write braces around all"),
    "TOML": ("[grid]\ncell_size = 0.1\n", "line 1, column 1", "TOML begins, and JSON is needed"),
    "no quotes": ("{until: 1}", "line 1, column 2", 'must stand in double quotes: "until"'),
    "Python's True": ('{"a": True}', "line 1, column 7", "True must be written as true"),
    "half a number": ('{"a": .5}', "line 1, column 7", ".5 is not a JSON number"),
    "a unit": ('{"a": 5 mm}', "line 1, column 9", "'mm' follows a number; all numbers are in SI units"),
    "a fraction": ('{"a": 1/10}', "line 1, column 8", "'/' follows a number; JSON does not calculate"),
    "a product": ('{"a": [2 * 3]}', "line 1, column 10", "'*' follows a number"),
    "a percentage": ('{"a": 10%}', "line 1, column 9", "'%' follows a number"),
    "no comma": ('{"a": 1\n"b": 2}', "line 1, column 8", "a comma or a closing bracket is missing"),
    "no end": ('{"a": [1, 2', "line 1, column 12", "1 '}' and 1 ']' must still come"),
}


@pytest.mark.parametrize(("text", "place", "why"), NEARLY_JSON.values(), ids=NEARLY_JSON)
def test_each_way_to_miss_json_has_a_sentence_of_its_own(tmp_path, text, place, why):
    file = tmp_path / "c.json"
    file.write_text(text, encoding="utf-8")
    said = sentence(load_case, file)
    assert place in said
    assert why in said


@pytest.mark.parametrize(
    ("where", "number"), [((), 300_000), (("bodies", 0, "material"), 100_000), ((), 9_000)]
)
def test_very_many_unknown_keys_are_one_sentence_at_once(where, number):
    data = copy.deepcopy(GOOD)
    here = data
    for key in where:
        here = here[key]
    here |= {f"yield_stres{k}": 1 for k in range(number)}
    begin = time.perf_counter()
    with pytest.raises(CaseError) as refused:
        parse_case(data)
    assert time.perf_counter() - begin < 2
    assert len(str(refused.value)) < 300
    assert "yield_stres0" in str(refused.value) or f"{number + len(GOOD):,} keys" in str(refused.value)


def test_a_key_that_stands_twice_among_many_is_found_at_once(tmp_path):
    file = tmp_path / "c.json"
    file.write_text("{" + ", ".join(f'"k{k}": 1' for k in range(100_000)) + ', "k99999": 2}')
    begin = time.perf_counter()
    assert "'k99999' appears twice" in sentence(load_case, file)
    assert time.perf_counter() - begin < 2


def test_a_file_without_an_end_is_refused(tmp_path, monkeypatch):
    """/dev/zero was read until the memory was full."""
    monkeypatch.setattr("mpmkit.case.load.LARGEST", 1000)
    file = tmp_path / "c.json"
    for size, said in ((1000, "is not valid JSON"), (1001, "has more than 1,000 characters")):
        file.write_text("x" * size)
        assert said in sentence(load_case, file)


def test_what_is_said_to_install_is_what_the_extras_hold():
    """By the names of the packages, so that it works outside a registry that has mpmkit."""
    root = Path(__file__).parents[1]
    extras = tomllib.loads((root / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    pages = (*root.glob("docs/**/*.md"), root / "README.md")
    texts = {file: file.read_text(encoding="utf-8") for file in pages}
    texts |= {file: file.read_text(encoding="utf-8") for file in root.glob("mpmkit/**/*.py")}
    assert not [str(file) for file, text in texts.items() if re.search(r"pip install\s+'?mpmkit\[", text)]
    for extra, requirements in extras.items():
        if extra in ("mesh", "cluster", "movie"):
            said = [text for text in texts.values() if f"pip install '.[{extra}]'" in text]
            assert said, extra
            names = " ".join(re.split(r"[><=]", requirement)[0] for requirement in requirements)
            assert all(f"pip install {names}" in text for text in said), extra


WALLED = GOOD | {
    "walls": {"w": {"surface": {"kind": "plane", "point": [0, 0.05], "normal": [0, 1]}, "contact": "slip"}}
}
WHERE = {
    "surface": 'walls.w.surface is {"kind": "plane", "point": [0, 0.05], "normal": [0, 1]}',
    "contact": 'walls.w.contact is "slip"',
    "law": f"{MATERIAL} is ",
    "equation_of_state": f"{MATERIAL}.equation_of_state is missing",
    "shape": 'scheme.shape is "cpgimp"',
    "velocity": "scheme.velocity is missing",
}


@pytest.mark.parametrize("kind", WHERE)
def test_where_no_plugin_of_a_kind_is_installed_the_sentence_says_so(kind):
    """Of a part that the case leaves to its defaults too. No text may stand there."""
    others = [entry for own, found in installed().plugins.items() if own != kind for entry in found.values()]
    registry = Registry(others, [])
    said = sentence(parse_case, WALLED, registry=registry)
    assert said.startswith(f"case: {WHERE[kind]}")
    assert said.endswith(f"; it must be a plug-in of the kind '{kind}', but none is installed")
    if kind == "contact":
        worded = json.loads(json.dumps(WALLED))
        worded["walls"]["w"]["contact"] = "none is installed"
        assert "but none is installed" in sentence(parse_case, worded, registry=registry)


def test_a_part_at_its_default_is_named_in_full():
    case = {key: value for key, value in GOOD.items() if key != "scheme"}
    others = [
        e for found in installed().plugins.values() for e in found.values() if e.plugin.name != "cpgimp"
    ]
    assert sentence(parse_case, case, registry=Registry(others, [])) == (
        "case: scheme.shape is missing; it must be \"linear\", or an object with such a 'name'"
    )


def test_a_sound_speed_has_one_choice():
    slump, changes = (
        Path(__file__).parents[1] / "cases/slump.json",
        ["bodies.0.material.sound_speed.factor=50"],
    )
    said = sentence(load_case, slump, changes)
    assert 'it has mach and factor; it must have one of them, such as {"factor": 10}' in said
