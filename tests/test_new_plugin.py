"""``mpmkit new-plugin``: the written distribution passes its tests; after a refusal there are no files."""

import json
import os
import re

import pytest
from distributions import run_their_tests

from mpmkit import contracts
from mpmkit.cli import main
from mpmkit.registry.scaffold import KINDS

LEAST = {
    "volumetric": 12,
    "equation_of_state": 9,
    "contact": 11,
    "body_force": 14,
    "initial_field": 6,
    "sink": 10,
    "source": 8,
    "particle_field": 9,
}
"""Tests of a distribution: those of the kit, and one of the case."""
FILES = {"README.md", "case.json", "pyproject.toml", "src/mpmkit_my_own.py", "tests/test_my_own.py"}


def new_plugin(*arguments):
    with pytest.raises(SystemExit) as stop:
        main(["new-plugin", *map(str, arguments)])
    return stop.value.code


def files_in(directory):
    return {str(path.relative_to(directory)) for path in directory.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A distribution of each kind, and what pytest said of their tests: all in one process, to save time."""
    folder = tmp_path_factory.mktemp("written")
    distributions = {}
    for kind in KINDS:
        name = f"my-{kind.replace('_', '-')}"
        distributions[kind] = folder / f"mpmkit-{name}"
        assert new_plugin(name, "--kind", kind, "--out", distributions[kind]) == 0
    done = run_their_tests(list(distributions.values()), folder / "site")
    return distributions, done.stdout + done.stderr


@pytest.mark.slow  # continuous integration runs the tests of every kind, each in its own folder
@pytest.mark.parametrize("kind", KINDS)
def test_what_is_written_passes_its_own_tests(kind, written):
    distributions, said = written
    distribution = distributions[kind]
    assert files_in(distribution) == {name.replace("my_own", f"my_{kind}") for name in FILES}
    assert not any("$" in path.read_text(encoding="utf-8") for path in distribution.rglob("*.*"))
    verdicts = re.findall(rf"^{distribution.name}/tests/\S+::.* ([A-Z]+)\b", said, flags=re.MULTILINE)
    assert set(verdicts) == {"PASSED"}, said
    assert len(verdicts) >= LEAST.get(kind, 14)


def test_where_it_is_written(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert new_plugin("my-own", "--kind", "law") == 0
    assert "mpmkit-my-own" in capsys.readouterr().out
    assert os.listdir(tmp_path) == ["mpmkit-my-own"]
    assert files_in(tmp_path / "mpmkit-my-own") == FILES


def test_there_is_a_template_for_every_kind():
    assert set(KINDS) == set(contracts.KINDS)


def test_the_distribution_may_be_named_in_full(tmp_path):
    assert new_plugin("mpmkit-my-own", "--kind", "law", "--out", tmp_path / "a" / "b") == 0
    assert files_in(tmp_path / "a" / "b") == FILES
    case = json.loads((tmp_path / "a" / "b" / "case.json").read_text(encoding="utf-8"))
    assert case["bodies"][0]["material"]["law"] == "my-own"


@pytest.mark.parametrize(
    "name",
    ["My-Own", "2phase", "my_own", "my--own", "my-", "mpmkit-", "", "true", "none", "λ", "../up", "x" * 51],
)
def test_a_bad_name_is_refused(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert new_plugin("--kind", "law", "--", name) == 2
    said = capsys.readouterr().err
    assert f"'{name}'" in said
    assert "lower-case letters, digits" in said
    assert said.count("\n") == 1
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("name", "kind", "reason"),
    [
        ("bingham", "law", "of mpmkit"),
        ("usl", "order", "of mpmkit"),
        ("linear", "equation_of_state", "of mpmkit"),
        ("plugins", "law", "module mpmkit_plugins"),
    ],
)
def test_a_name_that_is_taken_is_refused(name, kind, reason, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert new_plugin(name, "--kind", kind) == 2
    said = capsys.readouterr().err
    assert reason in said
    assert "choose another name" in said
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("what", ["directory", "file", "dangling link"])
def test_what_exists_is_left_alone(what, tmp_path, capsys):
    out = tmp_path / "taken"
    if what == "directory":
        out.mkdir()
    elif what == "file":
        out.write_text("mine", encoding="utf-8")
    else:
        out.symlink_to(tmp_path / "nowhere")
    assert new_plugin("my-own", "--kind", "shape", "--out", out) == 2
    assert "exists already" in capsys.readouterr().err
    assert os.listdir(tmp_path) == ["taken"]
    assert what != "directory" or os.listdir(out) == []


def test_an_unknown_kind_is_refused(tmp_path, capsys):
    assert new_plugin("my-own", "--kind", "pump", "--out", tmp_path / "new") == 2
    kinds = ", ".join(f"'{kind}'" for kind in KINDS)
    assert kinds in capsys.readouterr().err
    assert not (tmp_path / "new").exists()


def test_where_nothing_can_be_written(tmp_path, capsys):
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    assert new_plugin("my-own", "--kind", "law", "--out", tmp_path / "file" / "new") == 4
    assert "cannot write" in capsys.readouterr().err
    assert os.listdir(tmp_path) == ["file"]
