"""Studies: members, dataset, failed members, and members that are not run again."""

import json
from concurrent.futures import BrokenExecutor, Future, ThreadPoolExecutor

import numpy as np
import pytest
import xarray
from studies import CASE, LEAVES, NOTHING, Now, status, study

import mpmkit
from mpmkit.case import parse_case
from mpmkit.study import collect, execute, members_of
from mpmkit.study.execute import Unfinished
from mpmkit.study.store import Store


def run(path, given, executor=None, overwrite=False, **options):
    """Run a study into a directory; returns its dataset, as it is read from there, and its executor."""
    executor = executor or Now()
    members, store = members_of(given), Store(path, overwrite)
    store.open(given)
    execute(members, store, executor=executor, **options)
    store.write(collect(given, members, store))
    with xarray.open_dataset(store.results) as dataset:
        return dataset.load(), executor


@pytest.fixture(scope="module")
def grid(tmp_path_factory):
    """Two orders by two viscosities by two sets of values, one of which a guard stops."""
    given = study(
        description="what it is for",
        common={"bodies.0.material.density": 1200},
        vary={
            "scheme.order": ["usl", "usf"],
            "bodies.0.material.viscosity": [5, 10.5],
            "wall": {"closed": {}, "open": LEAVES},
        },
    )
    path = tmp_path_factory.mktemp("grid")
    return run(path, given)[0], path


def test_the_dataset_has_a_dimension_for_each_varied_parameter(grid):
    dataset, _ = grid
    assert dict(dataset.spread_diameter.sizes) == {
        "scheme.order": 2, "bodies.0.material.viscosity": 2, "wall": 2, "time": 201,
    }  # fmt: skip
    assert dataset["scheme.order"].values.tolist() == ["usl", "usf"]
    assert dataset["bodies.0.material.viscosity"].values.tolist() == ["5", "10.5"]
    assert dataset["wall"].values.tolist() == ["closed", "open"]
    assert dataset.attrs["title"] == "tiny"
    assert dataset.attrs["description"] == "what it is for"
    assert json.loads(dataset.attrs["study"])["common"] == {"bodies.0.material.density": 1200}
    assert dataset.height.attrs["units"] == "m"


def test_histories_and_figures_are_those_of_a_run_of_their_own(grid):
    dataset, path = grid
    member = dataset.sel({"scheme.order": "usf", "bodies.0.material.viscosity": "10.5", "wall": "closed"})
    changes = ["scheme.order=usf", "bodies.0.material.viscosity=10.5", "bodies.0.material.density=1200"]
    direct = mpmkit.run(parse_case(CASE, changes), threads=1)
    for name in ("spread_diameter", "height", "kinetic_energy", "total_mass"):
        expected = np.interp(member.time, direct.time, direct[name])
        np.testing.assert_allclose(member[name], expected, rtol=1e-12)
    assert float(member.final_spread) == pytest.approx(float(direct.spread_diameter[-1]), rel=1e-12)
    (kept,) = path.glob("members/usf-10.5-closed-*/history.nc")
    with xarray.open_dataset(kept) as history:
        np.testing.assert_array_equal(history.height, direct.height)


def test_every_member_has_its_cost_and_its_fate(grid):
    dataset, _ = grid
    closed, opened = dataset.sel(wall="closed"), dataset.sel(wall="open")
    assert (closed.fate == "finished").all()
    assert (closed.sentence == "").all()
    np.testing.assert_allclose(closed.simulated_time, 0.02)
    np.testing.assert_allclose(closed.particle_steps, 64 * closed.steps)
    for name in ("wall_seconds", "cpu_seconds", "steps", "memory_bytes"):
        assert (dataset[name] > 0).all()
    assert (opened.fate == "particle-outside").all()
    assert all("left the grid at x = 1.0" in str(said) for said in opened.sentence.values.flat)
    assert ((opened.simulated_time > 0) & (opened.simulated_time < 0.01)).all()
    known = opened.height.notnull()
    assert known[..., 0].all(), "the history up to its end is kept"
    assert not known.where(opened.time > 0.01, False).any(), "and no more than that"


def test_the_directory_has_table_figures_and_cases(grid):
    dataset, path = grid
    names = {entry.name for entry in path.iterdir()}
    assert names == {
        "study.json",
        "results.nc",
        "table.md",
        "histories.png",
        "differences.png",
        "index.html",
        "members",
    }
    for picture in path.glob("*.png"):
        assert picture.read_bytes().startswith(b"\x89PNG")
        assert picture.stat().st_size > 10_000
    heading, rule, *rows = (path / "table.md").read_text().splitlines()
    assert heading.startswith("| scheme.order | bodies.0.material.viscosity | wall | T500, s |")
    assert set(rule) == {"|", "-"}
    assert len(rows) == dataset.fate.size
    assert rows[0].startswith("| usl | 5 | closed |")
    assert rows[0].endswith("| finished |")
    assert "| particle-outside at 0.00" in rows[1]
    (case,) = path.glob("members/usl-5-open-*/case.json")
    assert json.loads(case.read_text())["bodies"][0]["velocity"] == [200, 0]


def test_a_list_of_members_and_those_that_fail_among_them(tmp_path):
    given = study(members={"bad": NOTHING, "a|b": {}, "gone": LEAVES, "short": {"until": 0.005}})
    said = []
    dataset, _ = run(
        tmp_path, given, listen=lambda member, outcome: said.append((member.title, outcome.fate))
    )
    assert dataset.fate.dims == ("member",)
    assert dataset.fate.values.tolist() == ["failed", "finished", "particle-outside", "finished"]
    assert dict(said) == dict(zip(dataset.member.values, dataset.fate.values, strict=True))
    assert "bodies.0.shape holds no particle" in str(dataset.sel(member="bad").sentence.item())
    assert np.isnan(dataset.sel(member="bad").height).all()
    short = dataset.sel(member="short")
    np.testing.assert_array_equal(short.height.notnull(), short.time <= 0.005 * (1 + 1e-9))
    rows = (tmp_path / "table.md").read_text().splitlines()[2:]
    assert rows[1].startswith(r"| a\|b | ")
    assert (tmp_path / "differences.png").exists()


@pytest.mark.usefixtures("undrawn")
def test_what_has_finished_is_not_run_again_and_what_has_changed_or_failed_is(tmp_path):
    members = {"one": {}, "two": {"until": 0.01}, "gone": LEAVES, "bad": NOTHING}
    first, executor = run(tmp_path, study(members=members))
    assert len(executor.ran) == 4
    again, executor = run(tmp_path, study(members=members))
    assert [data["bodies"][0]["shape"]["upper"] for data in executor.ran] == [[0.201, 0.001]]
    kept = {"member": ["one", "two", "gone"]}
    xarray.testing.assert_equal(first.sel(kept), again.sel(kept))
    changed, executor = run(
        tmp_path, study(members=members | {"two": {"until": 0.012}, "bad": {}}), overwrite=True
    )
    assert sorted(data["until"] for data in executor.ran) == [0.012, 0.02]
    assert changed.fate.values.tolist() == ["finished", "finished", "particle-outside", "finished"]
    assert float(changed.sel(member="two").simulated_time) == pytest.approx(0.012)
    # Another order of the same members, or another name of theirs, is another matter.
    _, executor = run(tmp_path, study(members={"gone": LEAVES, "one": {}, "uno": {}}), overwrite=True)
    assert len(executor.ran) == 1


@pytest.mark.usefixtures("undrawn")
def test_another_version_runs_again(tmp_path, monkeypatch):
    given = study(members={"one": {"until": 0.002}})
    run(tmp_path, given)
    monkeypatch.setattr("mpmkit.study.members.__version__", "99")
    assert len(run(tmp_path, given)[1].ran) == 1


def test_what_was_not_run_is_not_a_number(tmp_path):
    given = study(vary={"scheme.order": ["usl", "usf"]})
    dataset = collect(given, members_of(given), Store(tmp_path))
    assert (dataset.fate == "").all()
    assert np.isnan(dataset.wall_seconds).all()
    Store(tmp_path).write(dataset)
    assert (tmp_path / "table.md").read_text().count("not run") == 2
    assert not list(tmp_path.glob("*.png"))


@pytest.mark.usefixtures("undrawn")
def test_threads_take_turns(tmp_path):
    """Numba's threads, NetCDF's library and the CPU's clock are of the process, not of a thread."""
    with ThreadPoolExecutor(3) as executor:
        dataset, _ = run(tmp_path, study(vary={"until": [0.2, 0.21, 0.22]}), executor)
    assert (dataset.fate == "finished").all()
    assert (dataset.cpu_seconds < 1.5 * dataset.wall_seconds + 0.05).all()


class Clumsy(Now):
    """Loses the first pieces of work with its workers."""

    def submit(self, work, /, *arguments, **options):
        future = super().submit(work, *arguments, **options)
        if len(self.ran) <= self.losses:
            if self.at_once:
                raise BrokenExecutor
            future = type(future)()
            future.set_exception(BrokenExecutor())
        return future


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("at_once", [True, False])
@pytest.mark.parametrize(("losses", "fate"), [(2, "finished"), (3, "failed")])
def test_an_executor_that_breaks_is_given_members_again_but_not_for_ever(tmp_path, at_once, losses, fate):
    executor = Clumsy()
    executor.at_once, executor.losses = at_once, losses
    dataset, _ = run(tmp_path, study(members={"one": {"until": 0.002}}), executor)
    assert len(executor.ran) == 3
    assert dataset.fate.item() == fate


@pytest.mark.usefixtures("undrawn")
def test_an_error_on_the_way_is_the_fate_of_its_member(tmp_path):
    class Refuses(Now):
        def submit(self, work, /, *arguments, **options):
            if len(self.ran) == 0:
                return super().submit(lambda *_: {}["no such key"], *arguments)
            return super().submit(work, *arguments, **options)

    dataset, _ = run(tmp_path, study(members={"one": {"until": 0.002}, "two": {"until": 0.003}}), Refuses())
    assert dataset.fate.values.tolist() == ["failed", "finished"]
    assert dataset.sentence.values.tolist()[0] == "KeyError: 'no such key'"


@pytest.mark.usefixtures("undrawn")
def test_an_executor_that_gives_up_leaves_its_members_to_the_next_time(tmp_path):
    """As that of a cluster whose scheduler has died."""

    class GivesUp(Now):
        def submit(self, work, /, *arguments, **options):
            if len(self.ran) < 1:
                return super().submit(work, *arguments, **options)
            future = Future()
            future.cancel()
            future.set_running_or_notify_cancel()
            return future

    given = study(vary={"until": [0.001, 0.002, 0.003]})
    with pytest.raises(Unfinished, match=r"gave up 2 of 3 members \(0\.002, 0\.003\)") as stop:
        run(tmp_path, given, GivesUp())
    assert stop.value.exit_status == 1
    dataset, executor = run(tmp_path, given)
    assert sorted(data["until"] for data in executor.ran) == [0.002, 0.003]
    assert (dataset.fate == "finished").all()


@pytest.mark.usefixtures("undrawn")
def test_loading_code_is_not_part_of_the_cost(tmp_path):
    """What a process does once is not the member's: the first one takes as long as the second."""
    dataset, _ = run(tmp_path, study(members={"one": {}, "two": {"scheme.order": "usl"}}))
    assert float(dataset.cpu_seconds.max()) < 5 * float(dataset.cpu_seconds.min())


def test_a_directory_that_holds_something_else(tmp_path, monkeypatch):
    """A directory with something else in it is refused, and left as it is."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.tex").write_text("years of work")
    (tmp_path / "s.json").write_text(json.dumps({"case": CASE, "vary": {"until": [0.001]}}))
    assert status("study", "s.json", "--out", "other", "--quiet") == 2
    assert [path.name for path in (tmp_path / "other").iterdir()] == ["thesis.tex"]
    assert status("study", "s.json", "--out", "s.json", "--quiet") == 4


@pytest.mark.usefixtures("undrawn")
def test_members_are_kept_as_they_end(tmp_path):
    """The result of a member is written when it ends, so that a study that dies loses no results."""
    given, seen = study(vary={"until": [0.001, 0.002, 0.003]}), []

    def listen(member, outcome):
        seen.append(len(list(tmp_path.glob("members/*/member.json"))))
        if len(seen) == 2:
            raise KeyboardInterrupt

    with ThreadPoolExecutor(1) as executor, pytest.raises(KeyboardInterrupt):
        run(tmp_path, given, executor, listen=listen)
    assert seen == [1, 2]
    assert len(run(tmp_path, given)[1].ran) == 1
