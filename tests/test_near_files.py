"""The message about a misspelt file name proposes the nearest file."""

import pytest

from mpmkit.case import load_case
from mpmkit.case.near_files import near_file
from mpmkit.cli import main
from mpmkit.errors import CaseError
from mpmkit.study import load_study


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for name in ("cases/slump.json", "cases/slump_fast.json", "cases/studies/shapes.json", "own/pipe.json"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("{}")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("cases/slmup.json", "cases/slump.json"),
        ("cases/Slump.json", "cases/slump.json"),
        ("slump", "cases/slump.json"),
        ("slump.json", "cases/slump.json"),
        ("cases/slump", "cases/slump.json"),
        ("slumpfast", "cases/slump_fast.json"),
        ("own/pip.json", "own/pipe.json"),
        ("shape", "cases/studies/shapes.json"),
        ("nowhere/slump.json", "cases/slump.json"),
    ],
)
def test_the_nearest_file_is_named(folder, typed, meant):
    assert str(near_file(typed)) == meant
    with pytest.raises(CaseError, match=rf"No such file or directory; did you mean '{meant}'[?]$"):
        load_case(typed)


@pytest.mark.parametrize("typed", ["channel", "cases/x.json", "own", "", "a\0b"])
def test_a_name_unlike_any_other_gets_no_proposal(folder, typed):
    assert near_file(typed) is None


def test_a_study_is_answered_likewise(folder):
    with pytest.raises(CaseError, match=r"the study file .* did you mean 'cases/studies/shapes.json'[?]"):
        load_study("shpaes.json")


def test_a_run_directory_is_answered_with_its_case(folder):
    (folder / "runs/slump").mkdir(parents=True)
    (folder / "runs/slump/case.json").write_text("{}")
    with pytest.raises(CaseError, match=r"the case of the run in it is 'runs/slump/case.json'$"):
        load_case("runs/slump")


@pytest.fixture
def runs(folder):
    for name in ("runs/slump", "runs/slump_fast", "elsewhere/pipe"):
        (folder / name).mkdir(parents=True)
        (folder / name / "case.json").write_text("{}")
    (folder / "runs/slmu").mkdir()  # no run
    return folder


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("runs/slmup", "runs/slump"),
        ("slump", "runs/slump"),
        ("runs/slump_fst", "runs/slump_fast"),
        ("elsewhere/pip", "elsewhere/pipe"),
    ],
)
@pytest.mark.parametrize("command", ["report", "movie", "rerun"])
def test_a_misspelt_run_directory_gets_the_nearest_run(runs, capsys, command, typed, meant):
    with pytest.raises(SystemExit) as ended:
        main([command, typed])
    assert ended.value.code == 2
    assert f"there is no such directory; did you mean '{meant}'?" in capsys.readouterr().err


def test_a_directory_unlike_any_other_gets_no_proposal(runs, capsys):
    with pytest.raises(SystemExit):
        main(["report", "channel"])
    assert capsys.readouterr().err.endswith("results of a run: there is no such directory\n")
