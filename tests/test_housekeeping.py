"""Files about the project itself: their programs can read them, and each fact is in one place."""

import re
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

import mpmkit

yaml = pytest.importorskip("yaml")
ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
TEMPLATES = sorted((ROOT / ".github/ISSUE_TEMPLATE").glob("*.yml"))


def _yaml(path):
    return yaml.safe_load((ROOT / path).read_text(encoding="utf-8"))


def test_the_version_is_in_one_place():
    assert mpmkit.__version__ == version("mpmkit")
    for path in ("mpmkit/version.py", "mpmkit/__init__.py", "docs/conf.py", "CITATION.cff", "README.md"):
        assert PROJECT["version"] not in (ROOT / path).read_text(encoding="utf-8"), path


def test_the_citation_has_what_the_format_requires():
    citation = _yaml("CITATION.cff")
    assert citation["cff-version"] == "1.2.0"
    assert citation["type"] == "software"
    assert citation["license"] == PROJECT["license"]
    assert [author["name"] for author in citation["authors"]] == [
        author["name"] for author in PROJECT["authors"]
    ]
    assert set(citation) <= {
        "abstract", "authors", "cff-version", "keywords", "license", "message", "title", "type",
    }  # fmt: skip
    assert all(isinstance(citation[key], str) for key in ("abstract", "message", "title"))


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: path.stem)
def test_an_issue_template_is_a_form(path):
    form = _yaml(path)
    assert {"name", "description", "body"} <= set(form)
    fields = [field for field in form["body"] if field["type"] != "markdown"]
    assert fields
    assert all(field["id"] and field["attributes"]["label"] for field in fields)


def test_the_workflow_calls_what_continuous_integration_calls():
    (job,) = _yaml(".github/workflows/ci.yml")["jobs"].values()
    assert job["steps"][-1] == {"run": ".ci/run"}
    assert (ROOT / ".ci/run").stat().st_mode & 0o111
    assert job["strategy"]["matrix"]["python"][0] == re.search(r"[\d.]+", PROJECT["requires-python"])[0]


def test_pre_commit_runs_the_checks_of_continuous_integration():
    hooks = {hook["id"]: hook for repo in _yaml(".pre-commit-config.yaml")["repos"] for hook in repo["hooks"]}
    assert {"ruff", "ruff-format", "docs", "check-json", "trailing-whitespace", "end-of-file-fixer"} <= set(
        hooks
    )
    ci = (ROOT / ".ci/run").read_text(encoding="utf-8")
    for hook in ("ruff", "docs"):
        assert hooks[hook]["entry"].removesuffix(" --force-exclude") in ci


def test_continuous_integration_tests_the_packages_outside_the_checkout():
    ci = (ROOT / ".ci/run").read_text(encoding="utf-8")
    assert "python -m build" in ci
    assert 'cd "$environment/user"' in ci
    assert "sphinx-build -W" in ci
    assert "docs/run_blocks.py README.md docs/tutorial.md" in ci
