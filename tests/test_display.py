"""Display of a run and of a study: compiling, a progress bar that fits, pictures, and times."""

import io
import json
import logging
from pathlib import Path
from types import SimpleNamespace

import pytest
from numba.core import event
from rich.console import Console
from studies import CASE, status, study

import mpmkit
from mpmkit.cli import display, progress
from mpmkit.cli.display import Display
from mpmkit.cli.duration import duration
from mpmkit.plan.rough import rough_seconds
from mpmkit.study import members_of
from mpmkit.study.work import Outcome

CASES = Path(__file__).parents[1] / "cases"
COMPILING = "compiling kernels"


def terminal(monkeypatch, width):
    """A terminal of a width instead of the standard error; returns what is written to it."""
    shown = io.StringIO()
    console = Console(file=shown, width=width, force_terminal=True, color_system=None)
    for module in (display, progress):
        monkeypatch.setattr(module, "console", console)
    return shown


def test_compiling_is_said_when_something_is_compiled_and_once(monkeypatch):
    shown = terminal(monkeypatch, 100)
    with Display("slump"):
        logging.getLogger("mpmkit").info("the first line")
        assert COMPILING not in shown.getvalue()
        for _ in range(3):
            with event.trigger_event("numba:compile"):
                pass
    assert shown.getvalue().count(COMPILING) == 1
    with event.trigger_event("numba:compile"):  # no listener is left
        pass
    assert shown.getvalue().count(COMPILING) == 1


def test_a_run_whose_kernels_are_there_says_nothing_of_compiling(tmp_path, capfd):
    (tmp_path / "c.json").write_text(json.dumps(CASE | {"output": {"report": False}}))
    for out in ("first", "second"):
        assert status("run", tmp_path / "c.json", "--out", tmp_path / out) == 0
        said = capfd.readouterr().err
    assert "finished after" in said
    assert COMPILING not in said


@pytest.mark.parametrize("width", [40, 60, 80, 100, 200])
@pytest.mark.parametrize("name", ["slump", "a-case-whose-name-is-far-too-long-for-a-narrow-terminal"])
def test_the_bar_fits(monkeypatch, width, name):
    shown = terminal(monkeypatch, width)
    with Display(name) as seen:
        logging.getLogger("mpmkit").info("x")
        seen(SimpleNamespace(
            time=0.5, until=1.0, steps=10, particle_steps_per_second=3.2e6, seconds_left=83.0,
            ends_earlier=False,
        ))  # fmt: skip
        seen._bar.refresh()
    line = next(line for line in reversed(shown.getvalue().splitlines()) if "50%" in line)
    assert line.count("━") >= 4  # half of the narrowest bar: what is left to do has no colour here
    assert len(line.removeprefix("\x1b[2K")) <= width
    assert ("1:23 left" in line) == (width >= 60 or name == "slump")
    assert ("3.20 M particle-steps/s" in line) == (width >= (80 if name == "slump" else 100))


@pytest.mark.parametrize(
    ("speed", "words"), [(3.2e6, "3.20 M"), (1.5e5, "0.15 M"), (3742.6, "3,743"), (0.0, "0")]
)
def test_a_small_speed_is_not_shown_as_zero(speed, words):
    assert f" {words} particle-steps/s " in display._lines(0.1, 1.0, speed, 10.0)[0]


def test_drawing_is_said_and_the_pictures_named(tmp_path, capfd, monkeypatch):
    monkeypatch.setattr("mpmkit.report.write_report", lambda path: [path / "report" / "outline.png"])
    (tmp_path / "c.json").write_text(json.dumps(CASE | {"output": {"report": True}}))
    assert status("run", tmp_path / "c.json", "--out", tmp_path / "run") == 0
    said = capfd.readouterr().err
    assert "drawing the report" in said
    picture = tmp_path / "run" / "report" / "outline.png"
    assert said.index("finished after") < said.index("drawing the report") < said.index(f"picture: {picture}")


def test_a_rough_time_goes_with_particles_steps_and_threads():
    slump = mpmkit.load_case(CASES / "slump.json")
    assert 5 < rough_seconds(slump) < 300  # measured: 25 to 130 s
    longer = mpmkit.load_case(CASES / "slump.json", ["until=8"])
    assert rough_seconds(longer) == pytest.approx(2 * rough_seconds(slump))
    changes = ["grid.cell_size=0.0025", "grid.domain.z=[0,0.305]"]
    finer = mpmkit.load_case(CASES / "slump.json", changes)
    assert 6 < rough_seconds(finer) / rough_seconds(slump) < 8.1
    regularised = '{"law": "bingham", "density": 2574, "yield_stress": 188.91, "plastic_viscosity": 77.64, '
    regularised += '"sound_speed": {"factor": 10}}'
    viscous = mpmkit.load_case(CASES / "slump.json", [f"bodies.0.material={regularised}"])
    assert rough_seconds(viscous) > 100 * rough_seconds(slump)
    assert rough_seconds(slump, threads=2) < rough_seconds(slump)


def test_a_study_says_how_long_it_takes(monkeypatch):
    """Two members of 100 s, then what the first has really taken: twice as long."""
    shown = terminal(monkeypatch, 120)
    monkeypatch.setattr(progress, "rough_seconds", lambda case, threads: 100.0)
    members = members_of(study(vary={"scheme.order": ["usl", "usf", "musl"]}))
    said = []
    monkeypatch.setattr(progress, "say", said.append)
    with progress.StudyProgress("tiny", members[1:], 1, at_once=1, threads=1) as bar:
        assert said[0] == "1 of 3 members have run before and are kept"
        assert said[1].startswith(f"2 members to run, 1 at once: about {duration(200)} left")
        bar(members[1], Outcome("finished", "", {}, {"wall_seconds": 200.0}, b""))
        bar._bar.refresh()
    assert f"about {duration(200)} left" in shown.getvalue()
    assert said[-1] == "usf: finished, 200.0 s"
