"""Study files and ``--vary``: valid ones, and one sentence for each wrong one."""

import json
import math
import re
from contextlib import nullcontext
from pathlib import Path

import pytest
import xarray
from studies import CASE, Now, one_line, status, study

from mpmkit.errors import CaseError, OutputError
from mpmkit.study import load_study, members_of, parse_study
from mpmkit.study.store import Store
from mpmkit.study.vary import parse_vary


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A working directory with a tiny case in it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.json").write_text(json.dumps(CASE), encoding="utf-8")
    return tmp_path


ORDERS = {"scheme.order": ["usl", "usf"]}
BAD = {
    "no JSON": ('{"case": 1,', "s.json: the study file is not valid JSON: "),
    "an empty file": (" ", "s.json: the study file is empty; it must hold a JSON object"),
    "a list": ("[]", "s.json: a study must be a JSON object"),
    "a key twice": ('{"case": "a", "case": "b"}', "the key 'case' appears twice"),
    "no case": ({"vary": ORDERS}, "case is missing; it must be the path of a case file, or a case itself"),
    "a number for a case": ({"case": 3, "vary": ORDERS}, "case is 3; it must be the path of a case file"),
    "a case that is not there": (
        {"case": "gone.json", "vary": ORDERS},
        '"gone.json": the case file cannot be read: No such file',
    ),
    "a case that is none": (
        {"case": {}, "vary": ORDERS},
        "study 's', member scheme.order = usl: its case: space is missing",
    ),
    "nothing varied": ({"case": "tiny.json"}, "a study has either vary or members, and neither is given"),
    "both": (
        {"case": "tiny.json", "vary": ORDERS, "members": {"a": {}}},
        "a study has either vary or members, and both are given",
    ),
    "a key that is not known": (
        {"case": "tiny.json", "vary": ORDERS, "thread": 2},
        "the study has an unknown key 'thread'; did you mean 'threads'?",
    ),
    "no threads": (
        {"case": "tiny.json", "vary": ORDERS, "threads": 0},
        "threads is 0; it must be a whole number of at least 1",
    ),
    "a name that is a path": (
        {"case": "tiny.json", "vary": ORDERS, "name": "../up"},
        'name is "../up"; it must be at most 100 letters',
    ),
    "one value for a list": (
        {"case": "tiny.json", "vary": {"scheme.order": "usl"}},
        'vary.scheme.order is "usl"; it must be a list of values, or an object in which each value is',
    ),
    "no value": (
        {"case": "tiny.json", "vary": {"scheme.order": []}},
        "vary.scheme.order is empty; it must list at least one value",
    ),
    "a value twice": (
        {"case": "tiny.json", "vary": {"until": [1, 2, 1]}},
        "vary.until has the value 1 twice; keep one of them",
    ),
    "values that look alike": (
        {"case": "tiny.json", "vary": {"until": [1, "1"]}},
        "vary.until has the value 1 twice; keep one of them",
    ),
    "a value that no case has": (
        {"case": "tiny.json", "vary": {"scheme.order": ["usl", "usk"]}},
        'member scheme.order = usk: its case: scheme.order is "usk"; it must be "musl", "usf" or "usl"',
    ),
    "a key that no case has": (
        {"case": "tiny.json", "vary": {"scheme.ordr": ["usl"]}},
        "member scheme.ordr = usl: its case: scheme has an unknown key 'ordr'; did you mean 'order'?",
    ),
    "a path that leads nowhere": (
        {"case": "tiny.json", "vary": {"bodies.3.material.law": ["bingham"]}},
        "member bodies.3.material.law = bingham: bodies is a list of 1, so that '3' must be 0",
    ),
    "a path that is none": (
        {"case": "tiny.json", "members": {"a": {"scheme..order": "usl"}}},
        "study 's', member member = a: 'scheme..order' is not a path",
    ),
    "members that are a list": (
        {"case": "tiny.json", "members": [{}]},
        "members is [{}]; it must be an object in which each value is an object of values by their paths",
    ),
    "a member that is a number": (
        {"case": "tiny.json", "members": {"a": 3}},
        "members.a is 3; it must be an object of values by their paths in the case",
    ),
    "the name of a result": (
        {"case": "tiny.json", "vary": {"height": {"low": {}, "high": {}}}},
        "vary.height has the name of a result; it must be called something else",
    ),
    "a name that NetCDF has not": (
        {"case": "tiny.json", "vary": {"a/b": {"low": {}, "high": {}}}},
        'vary has "a/b"; it must be named by letters, digits',
    ),
    "too many members": (
        {"case": "tiny.json", "vary": {"until": list(range(1, 201)), "gravity": list(range(200))}},
        "the study has 40000 members; it may have 10,000 at most",
    ),
    "two changes of one place": (
        {
            "case": "tiny.json",
            "vary": {"scheme.shape.domain": ["fixed", "stretch"], "scheme.shape": ["cpgimp"]},
        },
        "vary.scheme.shape.domain and vary.scheme.shape change the same place of the case: "
        "scheme.shape.domain is a part of scheme.shape; vary it in one of them only",
    ),
    "a named set and a dimension": (
        {
            "case": "tiny.json",
            "vary": {"until": [1, 2], "end": {"late": {"gravity": [0, -1], "until": 3}, "early": {}}},
        },
        "vary.until and vary.end change the same place of the case: both set until",
    ),
    "two named sets": (
        {
            "case": "tiny.json",
            "vary": {
                "one": {"a": {"bodies.0.velocity": [1, 0]}},
                "two": {"b": {"until": 1}, "c": {"bodies.00": {}}},
            },
        },
        "vary.one and vary.two change the same place of the case: bodies.0.velocity is a part of bodies.00",
    ),
    "a common value that none would have": (
        {
            "case": "tiny.json",
            "common": {"scheme.shape.domain": "stretch"},
            "vary": {"scheme.shape": ["cpgimp", "linear"]},
        },
        "common.scheme.shape.domain is a part of vary.scheme.shape, which replaces it in every member",
    ),
    "numbers that are not finite": (
        '{"case": "tiny.json", "vary": {"until": [NaN]}}',
        "vary.until.0: NaN is not",
    ),
}


@pytest.mark.parametrize(("content", "sentence"), BAD.values(), ids=BAD)
def test_a_bad_study_is_one_sentence_and_writes_nothing(content, sentence, here, capsys):
    text = content if isinstance(content, str) else json.dumps(content)
    (here / "s.json").write_text(text, encoding="utf-8")
    assert status("study", "s.json") == 2
    assert sentence in one_line(capsys)
    assert {path.name for path in here.iterdir()} == {"tiny.json", "s.json"}


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["gone.json"], '"gone.json": the study file cannot be read: No such file'),
        ([], "Missing argument 'STUDY'"),
        (["s.json", "--workers", "0"], "Invalid value for '--workers'"),
        (["s.json", "--threads", "none"], "Invalid value for '--threads'"),
    ],
)
def test_bad_options_of_study(arguments, sentence, here, capsys):
    assert status("study", *arguments) == 2
    assert sentence in one_line(capsys)


def test_a_study_is_read_from_where_it_lies_and_named_after_its_file(here, monkeypatch):
    (here / "cases").mkdir()
    (here / "tiny.json").rename(here / "cases" / "tiny.json")
    (here / "my study.json").write_text(json.dumps({"case": "cases/tiny.json", "vary": ORDERS}))
    monkeypatch.chdir("/")
    study = load_study(here / "my study.json")
    assert study.name == "my-study"
    assert [member.case.scheme.order.name for member in members_of(study)] == ["usl", "usf"]


def test_the_study_of_the_documentation(tmp_path):
    root = Path(__file__).parents[1]
    (text,) = re.findall(
        r"```json\n(.*?)```", (root / "docs" / "studies.md").read_text(encoding="utf-8"), re.S
    )
    (tmp_path / "orders.json").write_text(text.replace("cases/", f"{root}/cases/"), encoding="utf-8")
    members = members_of(load_study(tmp_path / "orders.json"))
    assert [member.title for member in members] == ["usl, coarse", "usl, fine", "usf, coarse", "usf, fine"]


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        (["scheme.order=usl,usf"], {"scheme.order": ["usl", "usf"]}),
        (["a=1,2.5,true,null"], {"a": [1, 2.5, True, None]}),
        (["a=[1,2],[3,[4,5]]"], {"a": [[1, 2], [3, [4, 5]]]}),
        (['a={"factor": 10, "b": [1, 2]},20'], {"a": [{"factor": 10, "b": [1, 2]}, 20]}),
        (['a="x,y",z'], {"a": ["x,y", "z"]}),
        (["a=x=1"], {"a": ["x=1"]}),
        (["a= 1 , two "], {"a": [1, "two"]}),
        (["a=1", "b=2,3"], {"a": [1], "b": [2, 3]}),
    ],
)
def test_vary(options, expected):
    assert parse_vary(options) == expected


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["scheme.order"], "--vary scheme.order: it must read path.to.key=a,b"),
        (["=usl"], "--vary =usl: it must read"),
        (["a="], "--vary a=: it must read"),
        (["a=1,,2"], "--vary a=1,,2: it must read"),
        (["a=1", "a=2"], "--vary a=2: a is varied already; give all its values at once"),
        (["a=1,NaN"], "--vary: NaN: NaN is not a number that a case can have"),
        (['a={"b": 1, "b": 2}'], "the key 'b' appears twice in one object"),
    ],
)
def test_bad_vary(options, sentence):
    with pytest.raises(CaseError) as error:
        parse_vary(options)
    assert sentence in str(error.value)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["tiny.json"], "Missing option '--vary'"),
        (["tiny.json", "--vary", "scheme.order"], "it must read path.to.key=a,b"),
        (["tiny.json", "--vary", "until=0.1,0.1"], "--vary: vary.until has the value 0.1 twice"),
        (["tiny.json", "--vary", "scheme.order=usl,usk"], 'scheme.order is "usk"; it must be'),
        (
            ["tiny.json", "--vary", "until=1", "--set", "bodies.7=1"],
            "--set bodies.7=1: bodies is a list of 1",
        ),
        (["gone.json", "--vary", "until=1"], "the case file cannot be read"),
        (
            ["tiny.json", "--vary", "scheme.shape.domain=fixed,stretch", "--vary", "scheme.shape=cpgimp"],
            "--vary: vary.scheme.shape.domain and vary.scheme.shape change the same place of the case",
        ),
        (
            ["tiny.json", "--vary", "scheme.shape=cpgimp", "--set", "scheme.shape.domain=stretch"],
            "--set scheme.shape.domain is a part of --vary scheme.shape, which replaces it in every member",
        ),
    ],
)
def test_bad_input_of_compare(arguments, sentence, here, capsys):
    assert status("compare", *arguments) == 2
    assert sentence in one_line(capsys)
    assert [path.name for path in here.iterdir()] == ["tiny.json"]


@pytest.mark.parametrize("turned", [False, True])
def test_the_order_of_changes_does_not_matter(turned):
    """A part of a place stays as it was said, whether it is said before the place or after it."""
    said = [("scheme.shape", "cpgimp"), ("scheme.shape.domain", "fixed")]
    changes = dict(reversed(said) if turned else said)
    (member,) = members_of(study(members={"a": changes}))
    assert member.case.scheme.shape.domain == "fixed"


def test_a_member_overrides_what_all_have():
    given = study(common={"until": 1.0}, members={"a": {}, "long": {"until": 2.0}})
    assert [member.case.until for member in members_of(given)] == [1.0, 2.0]


@pytest.mark.usefixtures("undrawn")
def test_compare(here, capsys, monkeypatch):
    """The grid of the options on the case, with the changes that all have; in one process here."""
    executor = Now()
    monkeypatch.setattr("mpmkit.cli.many_runs.ManyRuns.cluster", lambda how: nullcontext(executor))
    (here / "tiny.json").rename(here / "a case.json")
    changes = ["--until", "0.004", "--set", "bodies.0.material.density=900"]
    axes = ["--vary", "scheme.order=usl,usf", "--vary", "bodies.0.velocity=[0,0],[200,0]"]
    arguments = ("compare", "a case.json", *axes, *changes, "--set", "grid.faces.x_max=open")
    assert status(*arguments) == 0
    shown = capsys.readouterr()
    assert shown.out.splitlines()[-1] == (
        "results in runs/compare-a-case; open runs/compare-a-case/index.html in a browser"
    )
    assert shown.out.count("| finished |") == 2
    assert shown.out.count("| particle-outside at 0.00") == 2
    assert sum(line.startswith("usl, [0, 0]: finished, ") for line in shown.err.splitlines()) == 1
    with xarray.open_dataset(here / "runs" / "compare-a-case" / "results.nc") as dataset:
        assert dict(dataset.fate.sizes) == {"scheme.order": 2, "bodies.0.velocity": 2}
        assert dataset["bodies.0.velocity"].values.tolist() == ["[0, 0]", "[200, 0]"]
        assert float(dataset.total_mass[0, 0, 0]) == pytest.approx(0.16 * 900)
    assert status(*arguments) == 0
    assert "4 of 4 members have run before and are kept" in capsys.readouterr().err
    assert status(*arguments, "--quiet") == 0
    assert capsys.readouterr() == ("", "")
    assert len(executor.ran) == 4


def test_two_studies_into_one_directory(tmp_path):
    """The second is refused while the first is at work, and nothing of the first is touched."""
    first, second = study(vary=ORDERS), study(vary=ORDERS, description="another one")
    store = Store(tmp_path / "both")
    with store.claimed(first):
        before = store.study.read_bytes()
        with pytest.raises(OutputError, match="another study is writing there") as refused:
            Store(tmp_path / "both").claimed(second).__enter__()
        assert refused.value.exit_status == 4
        assert store.study.read_bytes() == before
    with store.claimed(second):
        pass  # it is free again
    assert [path.name for path in (tmp_path / "both").iterdir()] == ["study.json"]


def test_a_number_of_a_python_object_that_is_not_finite_is_named():
    with pytest.raises(CaseError) as refused:
        parse_study({"name": "tiny", "case": "tiny.json", "vary": {"until": [0.1, math.nan]}})
    assert str(refused.value) == (
        "study: vary.until.1: nan is not a number that a case can have; every number must be finite"
    )
