"""``mpmkit run --watch``: the page of a run at work, served on the loopback by a process of its own."""

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request

import numpy as np
import pytest
from test_cli import CASE, status

import mpmkit
from mpmkit.case import parse_case
from mpmkit.cli import terminal_plot
from mpmkit.output import History, RunDirectory, Variable, write_json
from mpmkit.watch.pages import Pages
from mpmkit.watch.server import Server
from mpmkit.watch.so_far import MOST_ROWS, NOTHING, SoFar


def write_history(path, rows, name="scene"):
    run = RunDirectory(path)
    path.mkdir(exist_ok=True)
    write_json(run.case, {"name": name, "until": 2.0, "space": "plane-strain"})
    columns = [Variable("height", "m", "largest height"), Variable("slump", "m", "slump")]
    history = History([*columns, Variable("momentum", "kg m/s", "momentum", component=True)], {}, ("x", "z"))
    for row in range(rows):
        history.record(0.001 * row, {"height": 1.0 - 0.0001 * row, "slump": np.nan, "momentum": np.zeros(2)})
    history.write(run.history)


# --- What has been written


def test_the_history_so_far_is_that_of_the_file(tmp_path):
    write_history(tmp_path, 3)
    found = SoFar(tmp_path, resumed=True).history()
    assert found["name"] == "scene"
    assert found["until"] == 2.0
    assert found["time"] == [0.0, 0.001, 0.002]
    assert set(found["series"]) == {"height", "slump"}  # scalars alone
    assert found["series"]["height"] == {
        "label": "largest height",
        "unit": "m",
        "values": [1.0, 0.9999, 0.9998],
    }
    assert found["series"]["slump"]["values"] == [None, None, None]  # JSON has no nan
    json.dumps(found, allow_nan=False)


def test_the_history_of_the_run_that_is_replaced_is_not_shown(tmp_path):
    write_history(tmp_path, 3)
    fresh = SoFar(tmp_path, resumed=False)
    assert fresh.version() == NOTHING
    assert fresh.history()["time"] == []
    write_history(tmp_path, 2)
    assert fresh.version() != NOTHING
    assert len(fresh.history()["time"]) == 2


def test_a_long_history_is_thinned_and_keeps_its_ends(tmp_path):
    write_history(tmp_path, 2 * MOST_ROWS)
    time_ = SoFar(tmp_path, resumed=True).history()["time"]
    assert len(time_) == MOST_ROWS
    assert (time_[0], time_[-1]) == (0.0, 0.001 * (2 * MOST_ROWS - 1))


@pytest.mark.parametrize("content", [b"", b"CDF\1 but cut off"])
def test_a_history_that_cannot_be_read_counts_as_none(tmp_path, content):
    write_history(tmp_path, 1)
    RunDirectory(tmp_path).history.write_bytes(content)
    assert SoFar(tmp_path, resumed=True).history()["time"] == []


# --- The server


@pytest.fixture(scope="module")
def slump(tmp_path_factory):
    """The directory of a run."""
    directory = tmp_path_factory.mktemp("watched") / "run"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mpmkit.report.write_report", lambda _: [])
        mpmkit.run(parse_case(CASE | {"name": "tiny", "output": {}}), directory)
    return directory


@pytest.fixture
def server(slump):
    serving = Server(slump, resumed=True)
    threading.Thread(target=serving.serve_forever, daemon=True).start()
    yield serving
    serving.shutdown()
    serving.server_close()


def get(address, **headers):
    with urllib.request.urlopen(urllib.request.Request(address, headers=headers), timeout=60) as answer:
        return answer.read().decode()


def refused(address, **settings):
    with pytest.raises(urllib.error.HTTPError) as error:
        urllib.request.urlopen(urllib.request.Request(address, **settings), timeout=10)
    return error.value.code


def test_the_server_answers_with_page_history_and_state(server):
    page = get(server.address)
    assert "<title>tiny</title>" in page
    assert "connect-src 'self'" in page  # it may ask for newer data
    history = json.loads(get(server.address + "history.json"))
    assert history["time"][-1] == pytest.approx(0.02)
    state = json.loads(get(server.address + "state.json"))
    assert state["version"] == server.so_far.version()
    assert state["ended"] is False


def test_nothing_else_is_served_and_nothing_can_be_written(server):
    for path in ("case.json", "../secret", "run.log", "static/follow.js"):
        assert refused(server.address + path) == 404
    assert refused(server.address, data=b"x", method="POST") == 501


def test_a_page_from_elsewhere_cannot_reach_it_by_a_name_of_its_own(server):
    assert refused(server.address, headers={"Host": "evil.example"}) == 403
    port = server.server_address[1]
    assert get(f"http://localhost:{port}/state.json", Host=f"localhost:{port}")


def test_it_listens_on_the_loopback_alone(server):
    assert server.socket.getsockname()[0] == "127.0.0.1"


def test_a_run_that_is_being_prepared_has_a_page_that_says_so(tmp_path):
    version, text = Pages(SoFar(tmp_path / "<b>", resumed=False)).latest()
    assert version == NOTHING
    assert "The run is being prepared." in text
    assert "<h1>&lt;b&gt;</h1>" in text
    assert "state.json" in text  # it follows the run


def test_a_page_is_made_once_for_what_has_been_written_and_not_too_often(slump, tmp_path, monkeypatch):
    shutil.copytree(slump, tmp_path / "run")
    pages = Pages(SoFar(tmp_path / "run", resumed=True))
    history = RunDirectory(tmp_path / "run").history
    cold = pages.latest()
    assert pages.latest() is cold
    os.utime(history, (1, 1))
    first = pages.latest()  # what the first one had to load does not count
    assert first[0] != cold[0]
    os.utime(history, (2, 2))
    assert pages.latest() is first  # the run has written more, but the last page is hardly made
    assert pages.version() == first[0]
    later = time.monotonic() + 1000
    monkeypatch.setattr("mpmkit.watch.pages.clock.monotonic", lambda: later)
    assert pages.version() != first[0]
    assert pages.latest()[0] != first[0]


def test_a_page_that_cannot_be_made_says_why(tmp_path):
    write_history(tmp_path, 1)  # its case has no grid
    version, text = Pages(SoFar(tmp_path, resumed=True)).latest()
    assert version == NOTHING
    assert "Its page cannot be made yet: " in text


def test_the_last_page_does_not_wait(slump, tmp_path):
    shutil.copytree(slump, tmp_path / "run")
    pages = Pages(SoFar(tmp_path / "run", resumed=True))
    for moment in (1, 2):
        first = pages.latest()
        os.utime(RunDirectory(tmp_path / "run").history, (moment, moment))
    pages.ended = True
    assert pages.latest()[0] == pages.version() != first[0]


def test_a_watching_browser_gets_the_end_of_the_run(server):
    get(server.address + "state.json")
    ending = threading.Thread(target=server.end)
    ending.start()
    while not server.ended:
        time.sleep(0.01)
    assert json.loads(get(server.address + "state.json"))["ended"] is True
    get(server.address + "farewell")
    ending.join(1)
    assert not ending.is_alive()


def test_without_a_watching_browser_the_end_is_not_delayed(server):
    start = time.monotonic()
    server.end()
    assert time.monotonic() - start < 0.5


# --- Beside a run


@pytest.fixture
def tiny(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.json").write_text(json.dumps(CASE))
    return tmp_path


def start(*arguments):
    """A run that is watched, and the address of its page."""
    command = [sys.executable, "-m", "mpmkit", "run", "tiny.json", "--watch", *arguments]
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    for line in process.stderr:
        found = re.search(r"watch this run at (http://127\.0\.0\.1:\d+/)$", line)
        if found:
            return process, found[1]
    raise AssertionError("no address was said")


def is_gone(address, within=5.0):
    port = int(address.rstrip("/").rpartition(":")[2])
    deadline = time.monotonic() + within
    while time.monotonic() < deadline:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) != 0:
                return True
        time.sleep(0.05)
    return False


def follow(address, rows=1):
    """Wait until the page shows so many rows."""
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        if len(json.loads(get(address + "history.json"))["time"]) >= rows:
            return
        time.sleep(0.1)
    raise AssertionError("the history did not come")


@pytest.mark.parametrize("stop", [signal.SIGINT, pytest.param(signal.SIGKILL, marks=pytest.mark.slow)])
def test_the_page_is_there_while_the_run_is_and_goes_with_it(tiny, stop):
    process, address = start("--until", "1e4")
    try:
        follow(address)
        assert "<title>" in get(address)
        os.kill(process.pid, stop)
        _, said = process.communicate(timeout=30)
    finally:
        process.kill()
    assert process.returncode == (130 if stop == signal.SIGINT else -signal.SIGKILL)
    assert is_gone(address)
    if stop == signal.SIGINT:
        assert said.splitlines()[-1].startswith("mpmkit: interrupted at t = ")
        assert "Traceback" not in said


def test_a_watched_run_leaves_what_any_run_leaves_and_the_same_bits(tiny):
    assert status("run", "tiny.json", "--out", "plain", "--threads", "1") == 0
    process, address = start("--out", "watched", "--threads", "1")
    process.communicate(timeout=60)
    assert process.returncode == 0
    assert is_gone(address)
    plain, watched = (
        {p.relative_to(tiny / name) for p in (tiny / name).rglob("*")} for name in ("plain", "watched")
    )
    assert watched == plain
    frames = sorted((tiny / "plain/frames").glob("*.vtu"))
    assert [f.read_bytes() for f in frames] == [
        (tiny / "watched/frames" / f.name).read_bytes() for f in frames
    ]


def test_a_run_that_is_refused_is_one_sentence_and_has_no_page(tiny, capfd):
    (tiny / "full").mkdir()
    (tiny / "full/file").touch()
    assert status("run", "tiny.json", "--watch", "--out", "full") == 2
    time.sleep(0.5)
    said = capfd.readouterr().err
    assert said.count("\n") == 1
    assert "is not empty" in said


@pytest.mark.parametrize("option", ["--watch", "--open", "--plot"])
def test_quiet_and_watching_contradict_each_other(tiny, capsys, option):
    assert status("run", "tiny.json", "--quiet", option) == 2
    assert "--watch, --open and --plot show something: leave out --quiet" in capsys.readouterr().err


# --- The plot in the terminal


def dots(lines):
    """Dots of a plot, (4 rows, 2 columns a letter)."""
    letters = np.array(
        [[ord(c) - terminal_plot.BLANK for c in line.partition("┤")[2]] for line in lines[1:-1]]
    )
    found = np.zeros((4 * letters.shape[0], 2 * letters.shape[1]), dtype=bool)
    for row in range(4):
        for column in range(2):
            found[row::4, column::2] = letters & terminal_plot.DOTS[row, column] > 0
    return found


def test_a_straight_line_goes_from_corner_to_corner():
    lines = terminal_plot.plot(np.array([0.0, 2.0]), np.array([1.0, 3.0]), 2.0, "height (mm)")
    assert lines[0] == "height (mm)"
    assert lines[1].startswith("3 ┤")
    assert lines[-2].startswith("1 ┤")
    assert lines[-1].endswith("2 s")
    found = dots(lines)
    assert found.sum(axis=0).tolist() == [1] * found.shape[1]  # one dot a column: a line without holes
    heights = found.shape[0] - 1 - found.argmax(axis=0)
    np.testing.assert_allclose(heights, np.linspace(0, found.shape[0] - 1, found.shape[1]), atol=1)


def test_a_run_at_half_its_time_fills_half_of_the_plot():
    found = dots(terminal_plot.plot(np.array([0.0, 1.0]), np.array([1.0, 3.0]), 2.0, ""))
    assert found[:, : found.shape[1] // 2].any(axis=0).all()
    assert not found[:, found.shape[1] // 2 :].any()


def test_what_is_constant_or_not_a_number_can_be_plotted():
    assert dots(terminal_plot.plot(np.arange(3.0), np.ones(3), 2.0, "")).any()
    assert dots(terminal_plot.plot(np.arange(3.0), np.array([1, np.nan, 2]), 2.0, "")).any()


def test_a_run_shows_the_plot_of_its_spread_at_its_end(tiny, capsys):
    assert status("run", "tiny.json", "--plot") == 0
    lines = capsys.readouterr().err.splitlines()
    begin = lines.index("spread (mm)")
    assert dots(lines[begin : begin + terminal_plot.HEIGHT + 2]).any()


def test_a_history_of_what_does_not_spread_is_plotted_by_what_changes(tmp_path):
    history = terminal_plot.HistoryPlot(tmp_path)
    history.look(2.0)
    assert history.lines == []
    write_history(tmp_path, 3)
    history.look(2.0)
    assert history.lines[0] == "height (mm)"


def test_a_run_that_may_end_earlier_is_followed_to_its_latest_end(tmp_path):
    write_history(tmp_path, 2)
    case = json.loads(RunDirectory(tmp_path).case.read_text()) | {
        "until": {"at_most": 3.0, "max_speed": {"at_most": 1e-4}}
    }
    write_json(RunDirectory(tmp_path).case, case)
    assert SoFar(tmp_path, resumed=True).history()["until"] == 3.0
