"""What ``mpmkit fit`` prints: a line for each run, then parameters, measured and fitted values with units."""

import json
import re
from contextlib import nullcontext

import numpy as np
import pytest
from fits import CASE, PARAMETERS, VISCOSITY, YIELD_STRESS, Pretend, curve, final_spread
from test_cli import status

FINAL = {"variable": "final_spread", "value": final_spread(150), "uncertainty": 0.005}


@pytest.fixture
def fitted(tmp_path, monkeypatch, capsys):
    """A function that runs the command on measurements; returns the lines of both outputs."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("mpmkit.cli.many_runs.ManyRuns.cluster", lambda how: nullcontext(Pretend()))

    def fitted(*measurements, parameters=PARAMETERS):
        test = {"case": CASE, "measurements": list(measurements), "stages": [{}], "model_error": 0.0}
        fit = {
            "name": "slump",
            "tests": {"slump": test},
            "parameters": parameters,
            "budget": {"runs": 60},
            "pages": False,
        }
        (tmp_path / "fit.json").write_text(json.dumps(fit), encoding="utf-8")
        assert status("fit", "fit.json") == 0
        printed = capsys.readouterr()
        return printed.out.splitlines(), printed.err.splitlines()

    return fitted


def test_each_run_has_a_line_with_its_number_the_largest_number_and_its_values(fitted):
    results, log = fitted(FINAL, parameters={YIELD_STRESS: PARAMETERS[YIELD_STRESS]})
    runs = [line for line in log if line.startswith("fit: run ")]
    line = rf"fit: run (\d+) of at most 60, {YIELD_STRESS} = [\d.]+, cells of 20 mm: finished in 1\.0 s"
    numbers = [int(re.fullmatch(line, run)[1]) for run in runs]
    assert numbers == list(range(1, len(runs) + 1))
    # The last run finds the shear rates of the flow curve; the parameters do not depend on it.
    assert results[-1].startswith(f"based on {len(runs) - 1} runs; results in runs/slump;")


def test_the_lines_at_the_end_have_value_interval_and_unit(fitted):
    results, _ = fitted(FINAL, parameters={YIELD_STRESS: PARAMETERS[YIELD_STRESS]})
    number = r"([\d.]+)"
    line = f"{YIELD_STRESS} = {number} Pa, from {number} to {number} Pa at 90 %"
    value, low, high = map(float, re.fullmatch(line, results[0]).groups())
    assert low < 150 < high
    assert value == pytest.approx(150, rel=0.01)


def test_a_measured_number_stands_beside_its_fitted_value(fitted, tmp_path):
    results, _ = fitted(FINAL, parameters={YIELD_STRESS: PARAMETERS[YIELD_STRESS]})
    assert results[1] == (
        "slump, final spread: fitted 0.5533 m, measured 0.5533 m (standard uncertainty, model error "
        "included: 0.005 m)"
    )
    page = (tmp_path / "runs/slump/fit.html").read_text(encoding="utf-8")
    row = re.search(r'<tr><th scope="row">slump</th>(.*?)</tr>', page)[1]
    cells = re.findall(r"<td>(.*?)</td>", row)
    assert cells[:4] == ["final spread (m)", "0.5533", "0.5533", "0.005"]
    assert float(cells[4]) == pytest.approx(0, abs=0.05)


def test_a_measured_curve_has_its_differences_with_units(fitted, tmp_path):
    measured = curve(tmp_path / "d.csv", 150, 40, noise=0.01)
    results, _ = fitted(measured)
    number = r"([\d.e-]+) m"
    said = "slump, spread over time: 40 measured values; the RMS difference of the fitted curve is"
    found = re.fullmatch(rf"{said} {number}, the largest is {number}", results[2])
    rms, largest = map(float, found.groups())
    rows = np.loadtxt(tmp_path / "d.csv", delimiter=",", skiprows=2)
    assert rms == pytest.approx(0.01 * np.sqrt(np.mean(rows[:, 1] ** 2)), rel=0.3)  # the noise of the curve
    assert rms < largest < 4 * rms
    assert results[0].startswith(f"{YIELD_STRESS} = ")
    assert results[1].startswith(f"{VISCOSITY} = ")
    page = (tmp_path / "runs/slump/fit.html").read_text(encoding="utf-8")
    assert f"<li>{results[2]}.</li>" in page
