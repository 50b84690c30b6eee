"""A failure of the report gives a sentence, and does not change the result of the run."""

import json

import numpy as np
import pytest

from mpmkit import report
from mpmkit.cli import main
from mpmkit.errors import OutputError
from mpmkit.solver.simulation import Simulation

CASE = {
    "space": "plane-strain",
    "until": 0.02,
    "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]},
            "material": {"law": "newtonian", "density": 1000, "viscosity": 10, "sound_speed": 20},
        }
    ],
}


def run(tmp_path):
    (tmp_path / "case.json").write_text(json.dumps(CASE), encoding="utf-8")
    with pytest.raises(SystemExit) as stop:
        main(["run", str(tmp_path / "case.json"), "--out", str(tmp_path / "run"), "--threads", "1"])
    return stop.value.code


def spoil(monkeypatch, value):
    """Let a run turn non-finite on its way."""
    advance = Simulation.advance

    def spoilt(self, *arguments):
        if self.steps == 5:
            self.particles.velocity[:] = value
        return advance(self, *arguments)

    monkeypatch.setattr(Simulation, "advance", spoilt)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e8])
def test_a_run_that_diverges_ends_with_status_3_and_its_pictures(tmp_path, capsys, monkeypatch, value):
    spoil(monkeypatch, value)
    assert run(tmp_path) == 3
    said = capsys.readouterr().err
    assert said.splitlines()[-1].startswith("mpmkit: stopped at step ")
    assert "Traceback" not in said
    assert "warning" not in said
    assert (tmp_path / "run" / "report" / "outline.png").exists()
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["final_spread"] is None


@pytest.mark.parametrize(
    "error", [ZeroDivisionError("division by zero"), OutputError("cannot write 'o.png'")]
)
@pytest.mark.parametrize(("value", "expected"), [(0.0, 0), (np.nan, 3)])
def test_a_report_that_fails_is_a_warning(tmp_path, capsys, monkeypatch, error, value, expected):
    def fail(directory):
        raise error

    monkeypatch.setattr(report, "write_report", fail)
    spoil(monkeypatch, value)
    assert run(tmp_path) == expected
    said = capsys.readouterr().err
    assert "warning: the report was not drawn: " in said
    assert str(error) in said
    assert "Traceback" not in said
    assert "Traceback" in (tmp_path / "run" / "run.log").read_text()  # for the person who must repair it
