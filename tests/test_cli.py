"""The command line: exit statuses, options, and what is printed where."""

import json
import os
import re
import signal
import subprocess
import sys
import time

import pytest
import xarray

import mpmkit
from mpmkit.cli import main
from mpmkit.cli.duration import duration

CASE = {
    "space": "plane-strain",
    "until": 0.02,
    "grid": {
        "cell_size": 0.1,
        "domain": {"x": [0, 1], "z": [0, 1]},
        "faces": {"z_min": "slip", "x_min": "slip", "x_max": "slip"},
    },
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]},
            "material": {"law": "newtonian", "density": 1000, "viscosity": 10, "sound_speed": 20},
        }
    ],
    "output": {"report": False},
}


@pytest.fixture
def case(tmp_path, monkeypatch):
    """A tiny case file in the working directory."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.json").write_text(json.dumps(CASE), encoding="utf-8")
    return "tiny.json"


def status(*arguments):
    with pytest.raises(SystemExit) as stop:
        main([str(argument) for argument in arguments])
    return stop.value.code


def test_a_run_into_the_directory_of_its_name(case, tmp_path, capsys):
    assert status("run", case) == 0
    directory = tmp_path / "runs" / "tiny"
    assert {p.name for p in directory.iterdir()} == {
        "case.json",
        "checkpoints",
        "history.nc",
        "summary.json",
        "frames",
        "run.log",
    }
    shown = capsys.readouterr()
    assert "final spread" in shown.out
    assert "results in runs/tiny" in shown.out
    assert "64 particles" in shown.err
    assert not any(ord(character) < 32 and character != "\n" for character in shown.out + shown.err)


def test_quiet_prints_nothing(case, capfd):
    assert status("run", case, "--quiet", "--until", "0.002") == 0
    assert capfd.readouterr() == ("", "")


def test_options_reach_the_run(case, tmp_path):
    arguments = ("--set", "scheme.order=usf", "--set", "bodies.0.material.viscosity=20", "--until", "0.001")
    assert status("run", case, "--out", "elsewhere", "--threads", "1", "--quiet", *arguments) == 0
    resolved = json.loads((tmp_path / "elsewhere" / "case.json").read_text())
    assert resolved["scheme"]["order"] == {"name": "usf"}
    assert resolved["bodies"][0]["material"]["viscosity"] == 20
    assert resolved["until"] == 0.001


def test_a_run_is_overwritten_only_if_asked(case, capsys):
    short = ("run", case, "--quiet", "--until", "0.001")
    assert status(*short) == 0
    assert status(*short) == 2
    assert "--overwrite" in one_line(capsys)
    assert status(*short, "--overwrite") == 0


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["tiny.json", "--until", "-1"], "until is -1.0; it must be a number above 0, in s"),
        (["tiny.json", "--until", "nan"], 'until is "nan"; it must be a number above 0, in s'),
        (["tiny.json", "--until", "soon"], "Invalid value for '--until': 'soon' is not a valid float"),
        (["tiny.json", "--threads", "0"], "Invalid value for '--threads'"),
        (["tiny.json", "--set", "until"], "it must read path.to.key=value"),
        (["tiny.json", "--set", "scheme.order=uls"], 'did you mean "usl"?'),
        (["tiny.json", "--set", "grid.cell_size=1e-6"], "GiB is left for this run"),
        (["tiny.json", "--set", "bodies.0.shape.upper=[0.21,0.01]"], "holds no particle"),
        (["tiny.json", "--set", "bodies.0.material.sound_speed=1e160"], "sound_speed is 1e+160"),
        (["tiny.json", "--set", "name=../up"], 'name is "../up"'),
        (["tiny.json", "--untill", "1"], "see mpmkit run --help"),
        (["missing.json"], "No such file"),
        (["."], "Is a directory"),
        ([], "Missing argument 'CASE'"),
    ],
)
def test_bad_input_is_one_sentence_and_writes_nothing(arguments, expected, case, tmp_path, capsys):
    assert status("run", *arguments) == 2
    assert expected in one_line(capsys)
    assert [path.name for path in tmp_path.iterdir()] == ["tiny.json"]


def test_an_unknown_command(capsys):
    assert status("rum") == 2
    assert "'rum'" in one_line(capsys)


@pytest.mark.parametrize("out", ["tiny.json", "tiny.json/below", "/proc/nowhere"])
def test_what_cannot_be_written_is_status_4(out, case, capsys):
    assert status("run", case, "--out", out, "--quiet") == 4
    assert f"cannot write '{out}" in one_line(capsys)


def test_help_and_version(capsys):
    assert status("--version") == 0
    assert capsys.readouterr().out == f"mpmkit, version {mpmkit.__version__}\n"
    assert status() == 0
    listing = capsys.readouterr().out
    for command in ("run", "plan", "plugins", "schema"):
        assert f"  {command} " in listing
        assert status(command, "-h") == 0
        assert f"Usage: mpmkit {command}" in capsys.readouterr().out
    assert "130 interrupted" in listing


def test_python_m_mpmkit_and_what_it_loads():
    """The help needs none of the libraries that take their time to load."""
    code = "import sys; sys.argv = ['mpmkit', '--help']; import runpy, atexit; "
    code += "slow = ('numpy', 'numba', 'pydantic', 'xarray', 'rich'); "
    code += "atexit.register(lambda: print([name for name in slow if name in sys.modules])); "
    code += "runpy.run_module('mpmkit', run_name='__main__')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "Usage: mpmkit" in done.stdout
    assert done.stdout.endswith("[]\n")


def _has_moved_on(directory):
    """Whether a run has done steps: before the first one it loads its kernels, and has no state to keep."""
    return any(directory.glob("checkpoints/*.checkpoint"))


def test_an_interrupted_run_keeps_its_history(case, tmp_path):
    """In a process of its own, as in a terminal; ``test_signals`` sends the other signals."""
    command = [sys.executable, "-m", "mpmkit", "run", case, "--until", "1e4"]
    command += ["--checkpoint-every", "0.1s"]
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Started in the background, this process may ignore the signal, and its children with it.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    directory = tmp_path / "runs" / "tiny"
    try:
        deadline = time.monotonic() + 60
        while not _has_moved_on(directory) and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(0.5)
        os.kill(process.pid, signal.SIGINT)
        _, said = process.communicate(timeout=30)
    finally:
        process.kill()
    assert process.returncode == 130, said
    last = said.splitlines()[-1]
    assert last.startswith("mpmkit: interrupted at t = ")
    assert last.endswith(
        "; the results up to then are in 'runs/tiny'; go on with: mpmkit run --resume runs/tiny"
    )
    assert "Traceback" not in said
    assert json.loads((directory / "summary.json").read_text())["stopped_because"] == "interrupted"
    with xarray.open_dataset(directory / "history.nc") as history:
        assert len(history.time) >= 1
        assert history.attrs["stopped_because"] == "interrupted"


def test_an_interrupt_while_the_libraries_load_is_one_sentence(capsys, monkeypatch):
    import builtins

    load = builtins.__import__

    def interrupt(name, *arguments, **options):
        if name == "commands":
            raise KeyboardInterrupt
        return load(name, *arguments, **options)

    monkeypatch.setattr(builtins, "__import__", interrupt)
    assert status("plugins") == 130
    assert one_line(capsys) == "mpmkit: interrupted"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="a device of Linux")
@pytest.mark.parametrize("arguments", [["run", "tiny.json", "--until", "1e-3"], ["schema"], ["--help"]])
def test_an_output_that_is_full_is_status_4(case, arguments):
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-m", "mpmkit", *arguments]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 4
    last = done.stderr.splitlines()[-1]
    assert last == "mpmkit: cannot write to the standard output: No space left on device"
    assert "Traceback" not in done.stderr


def test_a_run_without_end_can_be_planned(case, capsys, monkeypatch):
    monkeypatch.setattr("mpmkit.plan.cost.PILOT_SECONDS", 0.2)  # a pilot takes all that it may
    assert status("plan", case, "--until", "1e300") == 0
    out = capsys.readouterr().out
    assert "years on this machine" in out
    rows = [line for line in out.splitlines() if re.search(r"\S {2,}\S", line)]  # sentences are longer
    assert len(rows) > 5
    assert max(map(len, rows)) < 100
    assert status("plan", case, "--until", "1.7e308") == 2
    assert "the number of steps is too large" in one_line(capsys)


@pytest.mark.parametrize(
    ("seconds", "said"),
    [
        (0.2, "0:00"),
        (65, "1:05"),
        (7265, "2:01:05"),
        (90_000, "1 day, 1:00:00"),
        (1e6, "11 days, 13:46:40"),
        (1e10, "317 years"),
        (float("inf"), "for ever"),
    ],
)
def test_durations(seconds, said):
    assert duration(seconds) == said


def test_plan(case, capsys):
    assert status("plan", case) == 0
    text = capsys.readouterr().out
    assert "particles      64" in text
    assert "acoustic" in text
    assert status("plan", case, "--json", "--until", "0.04") == 0
    cost = json.loads(capsys.readouterr().out)
    keys = {"particles", "nodes", "steps", "time_step", "limits", "memory_bytes", "expected_seconds"}
    assert keys <= cost.keys()


def one_line(capsys):
    """What was said on standard error, which must be one line, and nothing on standard output."""
    out, err = capsys.readouterr()
    assert out == ""
    (line,) = err.splitlines()
    assert line.startswith("mpmkit: ")
    return line
