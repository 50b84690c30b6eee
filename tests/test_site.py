"""The documentation site: what is made from its sources is complete, and blocks of pages are run."""

import importlib.util
import json
import re
import sys
from pathlib import Path

import pytest

from mpmkit.case import case_schema, parse_case
from mpmkit.case.load import read_case
from mpmkit.registry import installed

ROOT = Path(__file__).parents[1]
pytest.importorskip("sphinx", reason="the extra 'docs' is not installed")


def _module(path: Path, name: str):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def run_blocks():
    return _module(ROOT / "docs/run_blocks.py", "run_blocks")


@pytest.fixture(scope="module")
def site():
    return _module(ROOT / "docs/site_parts/__init__.py", "site_parts")


@pytest.fixture(scope="module")
def schema():
    return case_schema(installed())


def _fields(schema):
    """Every key of every object of a case, with its place."""
    for name, model in {"Case": schema, **schema["$defs"]}.items():
        for variant in (model, *model.get("anyOf", ())):
            for key, node in variant.get("properties", {}).items():
                if "const" not in node and key != "$schema":
                    yield f"{name}.{key}", node


def test_every_key_of_a_case_says_what_it_means(schema):
    assert [place for place, node in _fields(schema) if not node.get("description")] == []


def test_every_number_of_a_case_has_a_unit(schema):
    lacking = [
        place for place, node in _fields(schema) if re.search(r'"type": "(number|integer)"', json.dumps(node))
        and "unit" not in node
    ]  # fmt: skip
    assert lacking == []


def test_the_case_reference_has_every_key_with_its_unit(site, schema):
    rows = re.findall(
        r"^\| `(\w+)` \| (.*?) \| (.*?) \| (.*?) \|", site.filled("<!-- made: case-reference -->"), re.M
    )
    named = {key for key, *_ in rows}
    assert {place.partition(".")[2] for place, _ in _fields(schema)} <= named
    assert ("cell_size", "number > 0", "m", "*required*") in rows
    assert ("yield_stress", "number ≥ 0", "Pa", "*required*") in rows
    assert ("regularisation", "number > 0", "s", "`1000.0`") in rows


def test_the_command_reference_has_every_command_and_its_options(site):
    text = site.filled("<!-- made: command-reference -->")
    assert "## mpmkit run\n" in text
    assert "## mpmkit stability\n" in text
    assert "--checkpoint-every" in text


def test_the_gallery_shows_every_case(site):
    text = site.filled("<!-- made: gallery -->")
    for case in sorted((ROOT / "cases").glob("*.json")):
        assert f"## {case.stem}\n" in text


def test_every_guard_is_in_the_failures_and_cures():
    code = (ROOT / "mpmkit/solver/guards.py").read_text(encoding="utf-8")
    errors = (ROOT / "mpmkit/errors.py").read_text(encoding="utf-8")
    names = set(re.findall(r'_stopped\(\s*s, "([\w-]+)"', code)) | set(
        re.findall(r'guard(?:, what)? = \(?\s*"([\w-]+)"', code)
    )
    names |= set(re.findall(r'__init__\("([\w-]+)"', errors))
    assert {"non-finite", "energy", "mass-drift", "plug-in-error", "splitting"} <= names
    page = (ROOT / "docs/faq.md").read_text(encoding="utf-8")
    assert [name for name in sorted(names) if f"| `{name}` |" not in page] == []


def test_the_schema_that_is_published_is_current(schema):
    published = json.loads((ROOT / "docs/schema/case.schema.json").read_text(encoding="utf-8"))
    assert published == json.loads(json.dumps(schema)), (
        "mpmkit schema --no-plugins > docs/schema/case.schema.json"
    )


@pytest.mark.parametrize("path", sorted((ROOT / "cases").glob("*.json")), ids=lambda path: path.stem)
def test_a_shipped_case_names_the_published_schema_and_it_changes_nothing(path):
    data = read_case(path)
    assert (path.parent / data["$schema"]).resolve() == ROOT / "docs/schema/case.schema.json"
    plain = {key: value for key, value in data.items() if key != "$schema"}
    assert parse_case(data) == parse_case(plain)


PAGE = """\
Save this as `a.json`:

```json
{"n": 1}
```

    cat a.json

<!-- prints: 2 -->

    cat a.json

<!-- fails with 3: no -->

```bash
exit 4
```

<!-- not run: it takes long -->

    exit 1

```python
raise SystemExit(1)
```
"""


def test_blocks_of_a_page_are_run_and_what_is_wrong_is_named(run_blocks, tmp_path):
    page = tmp_path / "page.md"
    page.write_text(PAGE, encoding="utf-8")
    folder = tmp_path / "folder"
    folder.mkdir()
    found = list(run_blocks.blocks(page))
    assert [block.language for block in found] == ["json", "", "", "bash", "", "python"]
    problems = [run_blocks.run(block, folder) for block in found]
    assert problems[:2] == [None, None]
    assert problems[2] == "cat a.json: does not say '2', but: {\"n\": 1}\n"
    assert problems[3].startswith("exit 4: ends with status 4")
    assert problems[4] is None
    assert problems[5].startswith("ends with status 1")


def test_json_of_a_page_must_be_json_and_a_case_a_valid_one(run_blocks):
    assert run_blocks._json_problem('{"a": 1}') is None
    assert run_blocks._json_problem('"a": {"b": 1}') is None
    assert "Expecting" in run_blocks._json_problem("{a: 1}")
    assert run_blocks._json_problem('{"space": "4d"}').startswith('case: space is "4d"')


@pytest.mark.slow
@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "docs/tutorial.md",
        *sorted(p.relative_to(ROOT).as_posix() for p in ROOT.glob("docs/howto/*.md")),
    ],
)
def test_every_block_of_a_page_does_what_the_page_says(run_blocks, page):
    assert list(run_blocks.failures(ROOT / page)) == []


def test_what_the_failures_and_cures_quote_is_what_the_program_says():
    """Each quotation, in pieces between the '…', stands in a string of the code."""
    code = "".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "mpmkit").rglob("*.py")))
    said = re.sub(r'"\s*\n\s*f?"', "", code).replace('\\"', '"')
    said = re.sub(r"\{[^{}]*\}", "…", said)
    rows = re.findall(r"^\|(.*)\|.*\|.*\|$", (ROOT / "docs/faq.md").read_text(encoding="utf-8"), re.M)
    quoted = [quote for row in rows for quote in re.findall(r"`([^`]+ [^`]+)`", row)]
    assert len(quoted) > 40
    pieces = {piece for quote in quoted for piece in re.split("…", quote) if len(piece.split()) >= 3}
    assert [piece for piece in sorted(pieces) if piece.strip(" ;:,") not in said] == []
