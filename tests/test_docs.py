"""The docs pass all checks of continuous integration, and each check finds its fault."""

import importlib.util
import json
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
CHECK = ROOT / "docs/check.py"


@pytest.fixture
def checks(tmp_path, monkeypatch):
    """The checks, on a repository of their own that has nothing in it."""
    spec = importlib.util.spec_from_file_location("docs_check", CHECK)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    (tmp_path / "docs/images").mkdir(parents=True)
    monkeypatch.setattr(module, "ROOT", tmp_path)
    monkeypatch.setattr(module, "DOCS", tmp_path / "docs")
    return module


def test_the_docs_are_whole():
    found = subprocess.run([sys.executable, CHECK], capture_output=True, text=True, check=False)
    assert (found.returncode, found.stdout) == (0, "the docs are whole\n")


def test_a_mark_of_a_merge_is_found_in_any_file(checks, tmp_path):
    (tmp_path / "notes.txt").write_text("one\n" + "<" * 7 + " HEAD\ntwo\n")
    assert list(checks.merge_marks()) == ["notes.txt:2: the mark of a merge"]


def test_dead_links_are_found(checks, tmp_path):
    page = (
        "# One heading\n[a](gone.md) [b](#one-heading) [c](#another) [d](https://example.org) `[e](code)`\n"
    )
    (tmp_path / "README.md").write_text(page)
    assert list(checks.dead_links()) == [
        "README.md: there is no 'gone.md'",
        "README.md: there is no heading '#another' in 'README.md'",
    ]


def test_a_file_that_is_named_and_not_there_is_found(checks, tmp_path):
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests/test_there.py").touch()
    page = "`tests/test_there.py` `mpmkit/gone.py` `test_there.py` `test_gone.py`\n"
    (tmp_path / "README.md").write_text(page)
    assert list(checks.files_that_are_not_there()) == [
        "README.md: there is no file 'mpmkit/gone.py'",
        "README.md: there is no test file 'test_gone.py'",
    ]


def test_a_name_on_a_page_that_does_not_exist_is_found(checks, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    page = (
        "`mpmkit run a.json --until 1 --fastt` `mpmkit walk --out b` `--vary a=1` `--gone` `scheme.order`\n"
        "`scheme.time_step.fraction` `scheme.time_stp` `walls.mould.contact` `bodies.0.material.colour`\n"
        "mpmkit simulates the flow.\n"
    )
    (tmp_path / "README.md").write_text(page)
    assert list(checks.names_that_do_not_exist()) == [
        "README.md: 'mpmkit run' has no option --fastt",
        "README.md: there is no command 'mpmkit walk'",
        "README.md: there is no option --gone",
        "README.md: a case has no key 'scheme.time_stp'",
        "README.md: a case has no key 'bodies.0.material.colour'",
    ]


def test_a_phrase_that_few_understand_is_found(checks, tmp_path):
    (tmp_path / "README.md").write_text("The rate is 0.5 unless\ntold.\n")
    assert list(checks.riddles()) == ["README.md: 'unless told' is hard to understand; say it in plain words"]


def test_a_case_that_the_gallery_lacks_is_found(checks, tmp_path):
    (tmp_path / "cases").mkdir()
    (tmp_path / "cases/new.json").write_text("{}")
    (tmp_path / "docs/gallery.json").write_text('{"old": {"picture": "old.png"}}')
    assert list(checks.cases_that_the_gallery_lacks()) == [
        "docs/gallery.json: 'new' is only in cases/",
        "docs/gallery.json: 'old' is only there",
        "docs/gallery.json: there is no 'docs/images/old.png'",
    ]


def test_a_picture_that_no_script_makes_is_found(checks, tmp_path):
    for name in ("made", "unmade"):
        (tmp_path / f"docs/images/{name}.png").touch()
    (tmp_path / "docs/page.md").write_text("![](images/made.png)\n![](images/unmade.png)\n")
    script = '"""Draw docs/images/made.png."""\nif __name__ == "__main__":\n    pass\n'
    (tmp_path / "docs/script.py").write_text(script)
    assert list(checks.figures_without_a_source()) == [
        "docs/images/unmade.png: no script names it in its docstring as what it makes"
    ]


def test_a_script_that_computes_when_asked_for_help_is_found(checks, tmp_path):
    script = 'open("docs/page.md", "w").close()\nif __name__ == "__main__":\n    pass\n'
    (tmp_path / "docs/script.py").write_text(script)
    assert list(checks.scripts_without_help()) == [
        "docs/script.py: --help ends with status 0 and no help",
        "docs/script.py: --help changed files",
    ]


@pytest.mark.parametrize("script", sorted((ROOT / "benchmarks").glob("*.py")), ids=lambda path: path.name)
def test_a_benchmark_that_is_asked_for_its_help_does_not_compute(script, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", [str(script), "--help"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(script), run_name="__main__")
    assert "usage:" in capsys.readouterr().out
    assert ended.value.code == 0


def test_numbers_of_the_readme_that_a_run_does_not_have_are_found(checks, tmp_path):
    (tmp_path / "README.md").write_text((ROOT / "README.md").read_text(encoding="utf-8"), encoding="utf-8")
    said = checks.README_NUMBERS.search((tmp_path / "README.md").read_text(encoding="utf-8")).groups()
    summary = {"t500": float(said[0]), "final_spread": float(said[1])}
    (tmp_path / "summary.json").write_text(json.dumps(summary))
    assert list(checks.numbers_of_readme(tmp_path)) == []
    (tmp_path / "summary.json").write_text(json.dumps(summary | {"t500": 0.7}))
    assert list(checks.numbers_of_readme(tmp_path)) == [f"README.md: says {said[0]}, and it is 0.7000"]
