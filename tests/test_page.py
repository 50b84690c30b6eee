"""The page of a run: its content, and its packed flow, which equals that of the run up to quantisation."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mpmkit.case import load_case
from mpmkit.errors import GuardStop, Interrupted
from mpmkit.output import RunDirectory, read_frame, read_frames
from mpmkit.output.flow import Moment, arrays_of, moments_of_arrays, read_flow
from mpmkit.output.netcdf import read_dataset
from mpmkit.output.summary import TRUSTED
from mpmkit.report.page import MOST_BYTES, page_of
from mpmkit.report.page.packing import LEVELS_8, LEVELS_16, Packed, Scale, packed, unpacked
from mpmkit.report.page.thinning import fitting
from mpmkit.running.flow_record import LOOKS, MOMENTS, FlowRecord
from mpmkit.running.runner import resume, run
from mpmkit.solver.simulation import Simulation

CASES = Path(__file__).parents[1] / "cases"
COARSE = ["grid.cell_size=0.04", 'grid.domain={"r": [0, 0.36], "z": [0, 0.32]}', "until=0.3"]


def a_slump(directory: Path, *changes: str) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mpmkit.report.draw_pictures", lambda directory: [])  # they take longer than all else
        run(load_case(CASES / "slump_fast.json", [*COARSE, *changes]), directory, threads=1)
    return directory


@pytest.fixture(scope="module")
def slump(tmp_path_factory) -> Path:
    """The directory of a coarse slump."""
    return a_slump(tmp_path_factory.mktemp("run") / "slump")


def data_of(page: str) -> dict:
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)[1])


def text_of(page: str) -> str:
    """The words of a page, without its scripts and tags."""
    bare = re.sub(r"<(script|style)\b.*?</\1>", " ", page, flags=re.S)
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", bare))


def test_a_run_writes_a_page_that_needs_no_network(slump):
    file = RunDirectory(slump).page
    page = file.read_text(encoding="utf-8")
    assert file.stat().st_size < MOST_BYTES
    assert "default-src 'none'" in page
    assert not re.findall(r'(?:src|href)="(?!#|data:)[^"]*"', page)


def test_the_headline_comes_first_and_says_what_never_happened(slump):
    text = text_of(page_of(slump))
    summary = json.loads(RunDirectory(slump).summary.read_text())
    assert summary["t500"] is None
    assert "T500 never the spread never reached 500 mm; the largest was" in text
    titles = re.findall(r'<h2 id="\w+-title">(.*?)</h2>', page_of(slump))
    assert titles == [
        "Results",
        "Flow",
        "Histories",
        "Materials",
        "Balances",
        "Forces of the walls",
        "Numerics and cautions",
        "How the run was made",
    ]
    assert f"{1e3 * summary['final_spread']:.0f} mm" in text


def test_the_flow_of_a_page_is_that_of_the_frames(slump):
    """At the times of both, a position is within half of its 16 bits, and a value within half of its 8."""
    flow = data_of(page_of(slump))["flow"]
    moments = unpacked(Packed(flow["blob"], flow["packing"]))
    times = [moment["time"] for moment in flow["packing"]["moments"]]
    extent, low, high = (
        np.array(flow["packing"]["extent"]),
        *(flow["quantities"][0][k] for k in ("low", "high")),
    )
    compared = 0
    for time, path in read_frames(slump / "frames"):
        if time not in times:
            continue
        frame, moment = read_frame(path), moments[times.index(time)]
        order = np.argsort(frame["particle"])
        position, speed = frame["position"][order, :2], frame["speed"][order]
        np.testing.assert_array_equal(moment["number"], frame["particle"][order])
        allowed = 0.5 * extent / LEVELS_16 + 1e-7
        assert (np.abs(moment["position"] - position) <= allowed).all()
        shown = low + (high - low) * moment["speed"] / LEVELS_8
        assert np.abs(shown - np.minimum(speed, high)).max() <= 0.5 * (high - low) / LEVELS_8 + 1e-3 * high
        compared += 1
    assert compared >= 3  # at 0, 0.1 and 0.2 s, and at the end


def test_the_histories_of_a_page_are_the_runs(slump):
    chart = data_of(page_of(slump))["histories"]["charts"]["shape"]
    history = read_dataset(slump / "history.nc")
    np.testing.assert_allclose(chart["x"], history.time, rtol=1e-6)
    np.testing.assert_allclose(chart["curves"][0]["values"], 1e3 * history.spread_diameter, rtol=1e-6)
    assert chart["unit"] == "mm"


def test_a_page_can_be_made_during_a_run(slump, tmp_path):
    for name in ("case.json", "history.nc", "flow.npz", "run.log"):
        (tmp_path / name).write_bytes((slump / name).read_bytes())
    page = page_of(tmp_path, live=True)
    assert "The run is in progress: t = 0.300 s of 0.300 s." in text_of(page)
    assert "connect-src 'self'" in page
    assert data_of(page)["flow"]["packing"]["moments"]


def test_a_page_of_a_run_without_a_flow_shows_its_frames(slump, tmp_path):
    for name in ("case.json", "history.nc", "summary.json"):
        (tmp_path / name).write_bytes((slump / name).read_bytes())
    (tmp_path / "frames").symlink_to(slump / "frames")
    moments = data_of(page_of(tmp_path))["flow"]["packing"]["moments"]
    assert [moment["time"] for moment in moments] == [time for time, _ in read_frames(slump / "frames")]


def test_a_page_needs_no_plugin_of_the_run(slump, tmp_path):
    for name in ("case.json", "history.nc", "summary.json", "flow.npz"):
        (tmp_path / name).write_bytes((slump / name).read_bytes())
    case = json.loads((tmp_path / "case.json").read_text())
    case["bodies"][0]["material"]["law"] = "not-installed"
    (tmp_path / "case.json").write_text(json.dumps(case))
    page = page_of(tmp_path)
    assert "the case names a plug-in that is not installed" in text_of(page)
    assert data_of(page)["flow"]["packing"]["moments"]


def test_a_text_of_the_case_cannot_break_a_page(slump, tmp_path):
    for name in ("case.json", "history.nc", "summary.json"):
        (tmp_path / name).write_bytes((slump / name).read_bytes())
    case = json.loads((tmp_path / "case.json").read_text()) | {"description": "</script><img src=x>&"}
    (tmp_path / "case.json").write_text(json.dumps(case))
    page = page_of(tmp_path)
    assert "<img" not in page
    assert "&lt;/script&gt;&lt;img src=x&gt;&amp;" in page


@pytest.mark.parametrize("why", TRUSTED)
def test_only_a_guard_makes_a_page_warn_of_the_last_state(slump, tmp_path, why):
    """A run that ended at rest, or by a condition, was said to be stopped by a guard."""
    shutil.copytree(slump, tmp_path / "run")
    path = tmp_path / "run" / "summary.json"
    summary = json.loads(path.read_text())
    path.write_text(json.dumps(summary | {"stopped_because": why}))
    said = text_of(page_of(tmp_path / "run"))
    assert "A guard" not in said
    assert "do not trust" not in said


def test_a_run_that_was_interrupted_before_its_first_step_has_not_moved(slump, tmp_path):
    for name in ("case.json", "history.nc", "flow.npz"):
        (tmp_path / name).write_bytes((slump / name).read_bytes())
    summary = json.loads((slump / "summary.json").read_text())
    changed = {"stopped_because": "interrupted", "simulated_time": 0.0, "at_rest_since": None}
    (tmp_path / "summary.json").write_text(json.dumps(summary | changed))
    text = text_of(page_of(tmp_path))
    assert "The run was interrupted at t = 0 s. The material had not moved yet." in text


def test_a_run_that_a_guard_stopped_has_a_page_that_says_so(tmp_path, monkeypatch):
    advance = Simulation.advance

    def spoilt(self, *arguments):
        if self.steps == 45:
            self.particles.velocity[:] = np.nan
        return advance(self, *arguments)

    monkeypatch.setattr(Simulation, "advance", spoilt)
    with pytest.raises(GuardStop):
        a_slump(tmp_path / "run")
    page = RunDirectory(tmp_path / "run").page.read_text(encoding="utf-8")
    assert "A guard stopped the run" in text_of(page)
    assert "Final spread none the material did not reach a final shape" in text_of(page)
    assert data_of(page)["flow"]["packing"]["moments"]


def test_the_flow_does_not_depend_on_a_stop(slump, tmp_path, monkeypatch):
    monkeypatch.setattr("mpmkit.report.draw_pictures", lambda directory: [])
    advance = Simulation.advance

    def stopped(self, *arguments):
        if self.steps == 300:
            raise KeyboardInterrupt
        return advance(self, *arguments)

    case = load_case(CASES / "slump_fast.json", COARSE)
    with monkeypatch.context() as patch:
        patch.setattr(Simulation, "advance", stopped)
        with pytest.raises(Interrupted):
            run(case, tmp_path / "stopped", threads=1, checkpoint_every=0.05)
    resume(tmp_path / "stopped", threads=1)
    before, after = (arrays_of(read_flow(d / "flow.npz")) for d in (slump, tmp_path / "stopped"))
    for name, array in before.items():
        np.testing.assert_array_equal(array, after[name], err_msg=name)


def test_a_run_without_a_report_keeps_no_flow(tmp_path):
    directory = a_slump(tmp_path / "run", "output.report=false", "until=0.02")
    assert not (directory / "flow.npz").exists()
    assert not (directory / "report").exists()


def test_a_run_in_the_place_of_another_leaves_nothing_of_its_page(tmp_path):
    directory = a_slump(tmp_path / "run", "until=0.02")
    assert (directory / "flow.npz").exists()
    case = load_case(CASES / "slump_fast.json", [*COARSE, "until=0.02", "output.report=false"])
    run(case, directory, overwrite=True, threads=1)
    assert not (directory / "flow.npz").exists()
    assert not (directory / "report").exists()


def moment(time: float, number: np.ndarray, x: float = 0.0, share: float = 1.0) -> Moment:
    """Particles in a row along x, one cell of 1 m each, at z = 1 m."""
    count = len(number)
    place = np.stack([np.arange(count) + x, np.ones(count)], axis=1).astype(np.float32)
    zeros = np.zeros(count, dtype=np.uint8)
    ones = np.ones(count, dtype=np.float32)
    return Moment(
        time, share, number.astype(np.uint32), zeros, zeros, place, 0.5 + 0 * place, time * ones, ones, ones
    )


def test_particles_that_come_and_go_keep_their_numbers():
    numbers = [np.arange(5), np.arange(5), np.array([0, 2, 3, 4, 9, 70_000]), np.array([2, 70_000])]
    moments = [moment(float(k), number, x=0.1 * k) for k, number in enumerate(numbers)]
    packing = packed(moments, {"speed": Scale(0.0, 3.0)}, np.eye(2), 0.5)
    assert [m["same"] for m in packing.description["moments"]] == [False, True, False, False]
    for found, given in zip(unpacked(packing), moments, strict=True):
        np.testing.assert_array_equal(found["number"], given.number)
        np.testing.assert_allclose(found["position"], given.position, atol=5.1 / LEVELS_16)
        np.testing.assert_allclose(found["half_size"], 0.5)
        np.testing.assert_allclose(3.0 * found["speed"] / LEVELS_8, given.speed, atol=1.6 / LEVELS_8)


def test_what_is_too_large_is_thinned_and_stands_for_the_rest():
    generator = np.random.default_rng(1)
    moments = []
    for k in range(40):
        whole = moment(0.1 * k, np.arange(20_000))
        moments.append(replace(whole, position=generator.random((20_000, 2)).astype(np.float32)))

    def pack(chosen):
        return packed(chosen, {}, np.eye(2), 0.5)

    room = len(pack(moments).text) // 20
    thinned = fitting(moments, pack, room)
    assert len(thinned.packed.text) <= room
    assert thinned.moments[-1].time == moments[-1].time
    for kept in thinned.moments:
        assert len(kept) == pytest.approx(20_000 * kept.share, rel=0.02)
    assert len(thinned.moments) < 40  # fewer than 2500 particles would show too little


def recorded(falls: float) -> FlowRecord:
    """A record of a run of 1 s in which a body falls by its height in ``falls`` s, and then lies still."""
    simulation = Simulation(load_case(CASES / "slump_fast.json", [*COARSE, "until=1.0"]))
    record, start = FlowRecord(simulation), simulation.particles.position.copy()
    for step in range(LOOKS):
        simulation.steps, simulation.time = step, step / LOOKS
        fallen = min(1.0, simulation.time / falls)
        simulation.particles.position = start + np.array([0, 0.3 * fallen])
        simulation.particles.velocity[:] = [0, 0.3 / falls if fallen < 1 else 0]
        record.look(simulation)
    record.add(simulation)
    return record


def test_a_record_is_closer_in_time_where_more_moves():
    times = np.array([moment.time for moment in recorded(falls=0.1).moments])
    assert (times[0], times[-1]) == (0.0, 1 - 1 / LOOKS)
    assert np.count_nonzero(times <= 0.1) >= 38  # every look of the fall
    assert 0.02 < np.diff(times).max() < 0.08  # and few of the rest


def test_a_record_never_has_too_many_moments():
    """A fall through the whole run: of 400 looks every fourth is kept, more or less."""
    times = np.array([moment.time for moment in recorded(falls=1.0).moments])
    assert len(times) <= MOMENTS
    assert (times[0], times[-1]) == (0.0, 1 - 1 / LOOKS)
    assert np.diff(times).max() < 0.03


def test_moments_come_back_from_their_arrays():
    moments = [moment(0.0, np.arange(3)), moment(1.0, np.array([1, 7]), share=0.5)]
    for found, given in zip(moments_of_arrays(arrays_of(moments)), moments, strict=True):
        assert (found.time, found.share) == (given.time, given.share)
        np.testing.assert_array_equal(found.number, given.number)
        np.testing.assert_array_equal(found.position, given.position)


def test_the_balance_says_that_the_floor_carries_the_weight(tmp_path):
    """A coarse slump at rest after 1.5 s: the floor carries its weight to within a percent."""
    text = text_of(page_of(a_slump(tmp_path / "run", "until=1.5")))
    weight = float(re.search(r"Weight ([\d.]+) N", text)[1])
    carried = float(re.search(r"Walls carry ([\d.]+) N upwards", text)[1])
    assert weight == pytest.approx(9.81 * float(re.search(r"Mass ([\d.]+) kg", text)[1]), rel=2e-3)
    assert carried == pytest.approx(weight, rel=0.01)
    assert "unchanged from start to end" in text
