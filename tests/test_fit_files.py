"""Bad fit files: one sentence that names the place, the value and what is allowed, and status 2."""

import copy
import json

import pytest
from fits import CASE, YIELD_STRESS
from test_cli import status

FIT = {
    "tests": {
        "slump": {
            "case": CASE,
            "measurements": [{"variable": "final_spread", "value": 0.56, "uncertainty": 0.005}],
            "stages": [{}],
        }
    },
    "parameters": {YIELD_STRESS: {"low": 20, "high": 1000}},
}
CURVE = {"variable": "spread_diameter", "file": "d.csv", "relative_uncertainty": 0.01}
ROWS = "time_s,spread_diameter_m\n0.1,0.3\n0.5,0.45\n1.0,0.52\n"


def refused(tmp_path, monkeypatch, capsys, change, rows=ROWS):
    """The sentence about a fit file that is changed by a function."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "d.csv").write_text(rows, encoding="utf-8")
    fit = copy.deepcopy(FIT)
    change(fit, fit["tests"]["slump"]["measurements"])
    (tmp_path / "fit.json").write_text(json.dumps(fit), encoding="utf-8")
    assert status("fit", "fit.json") == 2
    assert not (tmp_path / "runs").exists()
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    return told


def parameter(path, **keys):
    return lambda fit, _: fit["parameters"].update({path: {"low": 20, "high": 1000} | keys})


def measurement(**keys):
    return lambda _, measured: measured[0].update(keys)


def another(**keys):
    return lambda _, measured: measured.append(keys)


def instead(**keys):
    return lambda _, measured: measured.__setitem__(0, keys)


BAD = {
    "bounds": (
        parameter(YIELD_STRESS, low=500, high=20),
        "low is 500 and high is 20; low must be below high",
    ),
    "no bounds": (parameter(YIELD_STRESS, low=20, high=20), "low and high are both 20"),
    "log of zero": (parameter(YIELD_STRESS, low=0), "low is 0; on a logarithmic scale it must be above 0"),
    "unknown path": (
        parameter("bodies.0.material.yeld_stress"),
        "parameters.bodies.0.material.yeld_stress: tests.slump.stages.0 has no such place; "
        "bodies.0.material has",
    ),
    "meant": (parameter("bodies.0.material.yeld_stress"), "did you mean 'yield_stress'?"),
    "no such body": (parameter("bodies.7.material.yield_stress"), "bodies is a list of 1"),
    "no number": (
        parameter("scheme.order.name"),
        'it is "usl" in tests.slump.stages.0; a parameter must be',
    ),
    "whole number": (parameter("bodies.0.particles_per_cell.0"), "it is a whole number"),
    "refused by the case": (
        parameter(YIELD_STRESS, low=-5, scale="linear"),
        "yield_stress.low: bodies.0.material.yield_stress is -5.0; it must be a number of at least 0",
    ),
    "slump of more than the cone": (
        instead(variable="final_slump", value=0.31, uncertainty=0.002),
        "measurements.0.value: a slump of 310 mm is impossible from a body of 300 mm in test 'slump'",
    ),
    "height of more than the cone": (
        instead(variable="final_height", value=0.4, uncertainty=0.002),
        "a height of 400 mm is impossible from a body of 300 mm",
    ),
    "spread below the first": (measurement(value=0.15), "it must be at least the spread at the start, 0.2 m"),
    "beyond the domain": (measurement(value=1.5), "the domain of the case ends at a spread of 1.2 m"),
    "millimetres": (measurement(value=560), "that looks like millimetres: write 0.56"),
    "millimetres of uncertainty": (measurement(uncertainty=6), "if it is in millimetres, write 0.006"),
    "milliseconds": (
        instead(variable="t500", value=610, uncertainty=20),
        "610 s, and the case ends at 4 s; if that is in milliseconds, write 0.61",
    ),
    "twice, and not the same": (
        another(variable="final_spread", value=0.50, uncertainty=0.005),
        "contradict each other: the final spread is 0.56 m by the one and 0.5 m by the other, 8.5 times",
    ),
    "a T500 of less than 500 mm": (
        lambda _, m: (
            m[0].update(value=0.45),
            m.append({"variable": "t500", "value": 1, "uncertainty": 0.1}),
        ),
        "contradict each other: a T500 of 1 s needs a spread of 0.5 m, and the final spread is 0.45 m",
    ),
    "a curve beyond the end": (
        lambda _, m: (m[0].update(value=0.45), m.append(CURVE)),
        "contradict each other",
    ),
    "unknown variable": (measurement(variable="final_spred"), "did you mean 'final_spread'?"),
    "no column": (
        instead(**CURVE | {"columns": {"value": "D_mm"}}),
        "measurements.0.columns.value: 'd.csv' has no column 'D_mm'; its columns are time_s, "
        "spread_diameter_m",
    ),
    "no file": (instead(**CURVE | {"file": "nowhere.csv"}), "'nowhere.csv' cannot be read: No such file"),
    "no uncertainty": (
        lambda _, m: m[0].pop("uncertainty"),
        "must have one of uncertainty, relative_uncertainty and columns.uncertainty",
    ),
    "neither value nor file": (lambda _, m: m[0].pop("value"), "either value or file, and neither is given"),
    "a history without a time": (
        measurement(variable="spread_diameter"),
        "spread_diameter is a history; give the time at which it was measured",
    ),
    "after the end": (
        instead(variable="spread_diameter", value=0.5, uncertainty=0.01, time=9),
        "the last time is 9 s, and the case ends at 4 s; raise until in the case",
    ),
    "unknown key": (lambda fit, _: fit.update(parameter={}), "parameter"),
    "a stage that is no case": (
        lambda fit, _: fit["tests"]["slump"].update(stages=[{"grid.cell_size": -1}]),
        "tests.slump.stages.0: grid.cell_size is -1",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_wrong_is_told_in_one_sentence(name, tmp_path, monkeypatch, capsys):
    change, sentence = BAD[name]
    assert sentence in refused(tmp_path, monkeypatch, capsys, change)


@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        ("time_s,spread_diameter_m\n0.1,0.3\n0.5,wide\n", "row 2: spread_diameter_m is 'wide'"),
        ("time_s,spread_diameter_m\n0.5,0.3\n0.1,0.4\n", "row 2: the time must grow from row to row"),
        ("time_s,spread_diameter_m\n", "has no row of numbers"),
        ("time_s,spread_diameter_m\n0.1,300\n0.5,450\n", "looks like millimetres: write 0.45"),
        ("time_s,spread_diameter_m\n100,0.3\n500,0.45\n", "looks like milliseconds: write 0.5"),
    ],
)
def test_a_curve_that_cannot_be_meant(rows, sentence, tmp_path, monkeypatch, capsys):
    assert sentence in refused(tmp_path, monkeypatch, capsys, instead(**CURVE), rows)
