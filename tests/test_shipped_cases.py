"""The cases that ship: all are valid, `mpmkit cases` lists them, `mpmkit init` writes one of them."""

import json
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from mpmkit.case import load_case, parse_case
from mpmkit.case.load import read_json
from mpmkit.case.parameters import fine, has_fine, parameters
from mpmkit.case.shipped import LABORATORY, shipped
from mpmkit.cli import main
from mpmkit.plan.shipped_times import shipped_seconds

LAB = [name for name, path in shipped().items() if path.parent.name == LABORATORY]


def status(*arguments) -> int:
    with pytest.raises(SystemExit) as ended:
        main([str(argument) for argument in arguments])
    return ended.value.code


@pytest.mark.parametrize("name", LAB)
def test_an_apparatus_is_a_valid_case_with_a_fine_variant(name):
    data = read_json(shipped()[name])
    assert next(iter(data)) == "description"
    assert list(data)[1] == "parameters"
    assert has_fine(data)
    coarse, finer = parse_case(data), parse_case(fine(data))
    assert finer.grid.cell_size < coarse.grid.cell_size
    assert coarse.measurements or coarse.walls
    for name, entry in parameters(data).items():
        assert len(entry.description.split()) > 1, name


def test_the_list_has_every_case_with_one_line_and_its_times(capsys):
    assert status("cases") == 0
    printed = capsys.readouterr().out
    for name in shipped():
        assert re.search(rf"^{name} +(\d+:\d\d|[\d.]+ days)", printed, re.MULTILINE), name
    assert max(len(line) for line in printed.splitlines()) < 150


def test_the_list_is_data_too(capsys):
    assert status("cases", "--json") == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in rows] == list(shipped())
    assert all(row["expected_seconds"] > 0 for row in rows)


def test_every_shipped_case_has_a_time_and_a_fine_one_where_it_has_a_fine_variant():
    known = shipped_seconds()
    for name, path in shipped().items():
        assert (name, "coarse") in known
        assert ((name, "fine") in known) == has_fine(read_json(path))


def test_init_writes_a_case_whose_parameters_are_at_the_top(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert status("init", "slump_test", "--set", "yield_stress=700", "--set", "scheme.order=usf") == 0
    said = capsys.readouterr().out
    assert re.search(r"^yield_stress +700 Pa +yield stress of the material$", said, re.MULTILINE)
    case = load_case("slump_test.json")
    assert case.bodies[0].material.yield_stress == 700
    assert case.scheme.order.name == "usf"
    text = Path("slump_test.json").read_text()
    assert text.index('"yield_stress": {"value": 700') < text.index('"grid"')
    # it goes on following its parameters
    again = load_case("slump_test.json", ["parameters.mould_height=0.2"])
    assert again.walls["mould"].surface.shape.height == 0.2


def test_init_writes_the_fine_variant(tmp_path):
    file = tmp_path / "mine.json"
    assert status("init", "l_box", "--fine", "--out", file) == 0
    assert load_case(file).grid.cell_size < load_case(shipped()["l_box"]).grid.cell_size


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["slumptest"], 2, "there is no shipped case \"slumptest\"; did you mean 'slump_test'?"),
        (["mini_cone"], 2,
         "\"mini_cone\"; did you mean 'mini_cone_haegermann' or 'mini_cone_kantro'? mpmkit cases lists them"),
        (["abrasion"], 2, 'there is no shipped case "abrasion"; mpmkit cases lists them'),
        (["slump_test", "--set", "top_radius=0.2"], 2,
         "parameters.top_radius (radius of the mould at its top) is 0.2 m; it must be at most 0.1 m, which "
         "is bottom_radius"),
        (["film", "--fine"], 2, "the case 'film' has no fine variant"),
        (["slump_test", "--out", "there.json"], 4, "there.json exists"),
        (["slump_test", "--set", "lifting_sped=1"], 2, "'lifting_sped'; did you mean 'lifting_speed'?"),
    ],
)  # fmt: skip
def test_a_sentence_says_what_init_cannot_do(tmp_path, monkeypatch, capsys, arguments, code, words):
    monkeypatch.chdir(tmp_path)
    Path("there.json").write_text("mine")
    assert status("init", *arguments) == code
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1
    assert Path("there.json").read_text() == "mine"
    assert [path.name for path in tmp_path.iterdir()] == ["there.json"]


@pytest.mark.slow
def test_a_wheel_holds_them(tmp_path):
    root = Path(__file__).parents[1]
    pip = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "-q"]
    subprocess.run([*pip, "-w", tmp_path, root], check=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as file:
        names = set(file.namelist())
    assert {f"mpmkit/cases/lab/{name}.json" for name in LAB} <= names
    assert "mpmkit/plan/shipped_work.csv" in names
