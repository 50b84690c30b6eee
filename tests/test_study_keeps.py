"""Results of a study are not replaced by another study, and damaged results are run again."""

import json
from contextlib import nullcontext

import pytest
import xarray
from studies import CASE, NOTHING, Now, one_line, status, study

from mpmkit.errors import CaseError
from mpmkit.study import collect, execute, members_of
from mpmkit.study.store import Store

pytestmark = pytest.mark.usefixtures("undrawn")


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A working directory with a tiny case, and an executor in this process."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.json").write_text(json.dumps(CASE | {"until": 0.002}), encoding="utf-8")
    monkeypatch.setattr("mpmkit.cli.many_runs.ManyRuns.cluster", lambda how: nullcontext(Now()))
    return tmp_path


def everything(directory):
    return {path: path.read_bytes() for path in directory.rglob("*") if path.is_file()}


ORDERS = ("--vary", "scheme.order=usl,usf")
OTHERS = {
    "another value": ("--vary", "scheme.order=usl,musl"),
    "fewer of them": ("--vary", "scheme.order=usl"),
    "another key": ("--vary", "scheme.velocity=flip,apic"),
    "another case": (*ORDERS, "--set", "bodies.0.material.density=900"),
    "another end": (*ORDERS, "--until", "0.003"),
}


@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS)
def test_a_second_comparison_of_a_case_leaves_the_first_alone(other, here, capsys):
    assert status("compare", "tiny.json", *ORDERS, "--quiet") == 0
    before = everything(here)
    capsys.readouterr()
    assert status("compare", "tiny.json", *other, "--quiet") == 2
    said = one_line(capsys)
    assert "'runs/compare-tiny' holds results that this study would replace, those of the member 'us" in said
    assert "give --overwrite to replace them, or --out DIR to write elsewhere" in said
    assert everything(here) == before


def test_overwriting_and_writing_elsewhere(here):
    assert status("compare", "tiny.json", *ORDERS, "--quiet") == 0
    first = everything(here)
    other = ("compare", "tiny.json", "--vary", "scheme.order=usl,musl", "--quiet")
    assert status(*other, "--out", "elsewhere") == 0
    assert {path: content for path, content in everything(here).items() if path in first} == first
    (here / "runs/compare-tiny/chart.png").write_bytes(b"of the first")
    assert status(*other, "--overwrite") == 0
    with xarray.open_dataset(here / "runs/compare-tiny/results.nc") as dataset:
        assert dataset["scheme.order"].values.tolist() == ["usl", "musl"]
    assert sorted(path.name[:3] for path in (here / "runs/compare-tiny/members").iterdir()) == ["mus", "usl"]
    assert not (here / "runs/compare-tiny/chart.png").exists()
    assert status(*other) == 0  # it is this study's now


def test_a_study_that_goes_on_keeps_its_members(here, tmp_path):
    """The same members and more, or one instead of a failed one, lose nothing."""
    members = {"one": {"until": 0.002}, "bad": NOTHING}
    for more in ({}, {"two": {"until": 0.003}}, {"bad": {"until": 0.001}}):
        members |= more
        given = study(members=members)
        store = Store(tmp_path / "s")
        store.open(given)
        executor = Now()
        execute(members_of(given), store, executor=executor)
        assert not more or 0.002 not in [data["until"] for data in executor.ran]


def spoil(path, content):
    path.write_bytes(content(path.read_bytes()) if callable(content) else content)


DAMAGE = {
    "a history that is cut off": ("history.nc", lambda content: content[: len(content) // 2]),
    "an empty history": ("history.nc", b""),
    "a history with one bit that is another": ("history.nc", lambda c: c[:-1] + bytes([c[-1] ^ 1])),
    "a record that is cut off": ("member.json", lambda content: content[: len(content) // 2]),
    "a record that is another's": ("member.json", b'["a list"]'),
}


@pytest.mark.parametrize(("name", "content"), DAMAGE.values(), ids=DAMAGE)
def test_a_member_that_is_damaged_is_run_again(name, content, here, capsys):
    command = ("compare", "tiny.json", *ORDERS)
    assert status(*command) == 0
    with xarray.open_dataset(here / "runs/compare-tiny/results.nc") as dataset:
        before = dataset.load()
    (file,) = here.glob(f"runs/compare-tiny/members/usf-*/{name}")
    spoil(file, content)
    spoil(here / "runs/compare-tiny/results.nc", lambda content: content[:100])
    capsys.readouterr()
    assert status(*command) == 0
    said = capsys.readouterr().err
    assert f"usf: '{file.relative_to(here)}' is damaged; the member is run again" in said
    assert "1 of 2 members have run before and are kept" in said
    with xarray.open_dataset(here / "runs/compare-tiny/results.nc") as dataset:
        xarray.testing.assert_equal(dataset.height, before.height)
        assert (dataset.fate == "finished").all()


def test_collecting_leaves_out_what_is_damaged(tmp_path):
    given = study(members={"one": {"until": 0.002}})
    members, store = members_of(given), Store(tmp_path)
    store.open(given)
    execute(members, store, executor=Now())
    (file,) = tmp_path.glob("members/*/history.nc")
    spoil(file, lambda content: content[:1000])
    assert collect(given, members, store).fate.values.tolist() == [""]
    assert not store.settled(members[0])


def test_from_python_another_study_is_refused_too(tmp_path):
    first = study(members={"one": {"until": 0.002}})
    store = Store(tmp_path)
    store.open(first)
    execute(members_of(first), store, executor=Now())
    with pytest.raises(CaseError, match="those of the member 'one'"):
        store.open(study(members={"two": {"until": 0.002}}))
