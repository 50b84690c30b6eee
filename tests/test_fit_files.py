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
ROWS = "time_s,spread_diameter_m,other_m\n0.1,0.3,0.4\n0.5,0.45,0.55\n1.0,0.52,0.57\n"


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
        parameter("bodies.0.material.law"),
        'it is "bingham-evp" in tests.slump.stages.0; a parameter must be',
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
        "spread_diameter_m, other_m",
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
    "an uncertainty of nothing": (measurement(uncertainty=1e-12), "it must be at least 1e-06 of the value"),
    "bounds that are nearly one number": (
        parameter(YIELD_STRESS, low=100, high=100.001),
        "low is 100 and high is 100.001; they must differ by at least 0.001 of the value",
    ),
    "bounds over forty decades": (
        parameter(YIELD_STRESS, low=1e-20, high=1e20),
        "high must be at most 1e+09 times low",
    ),
    "a prior beyond the bounds": (
        parameter(YIELD_STRESS, prior={"value": 5000, "deviation": 10}),
        "prior.value is 5000; it must be from 20 to 1000",
    ),
    "a setting of the calculation": (
        parameter("grid.cell_size", low=0.01, high=0.02),
        "parameters.grid.cell_size: it is a setting of the calculation; a parameter must be a property of",
    ),
    "one parameter by two paths": (parameter("bodies.00.material.yield_stress"), "has no such place"),
    "a stage that sets a parameter": (
        lambda fit, _: fit["tests"]["slump"].update(stages=[{YIELD_STRESS: 50}, {}]),
        f"tests.slump.stages.0 changes {YIELD_STRESS}, which is a parameter of the fit; leave it out",
    ),
    "a wall that is not there": (
        instead(variable="wall_torque", time=1, value=3, uncertainty=0.1, of={"wall": "bob"}),
        "measurements.0.of.wall is 'bob'; it must be one of z_min",
    ),
    "a part of a number": (measurement(of={"wall": "bob"}), "final_spread has no parts; leave it out"),
    "a component that is not named": (
        instead(variable="wall_force", time=1, value=3, uncertainty=0.1),
        "wall_force has a value for each component; give of.component, one of r, z",
    ),
    "no mould": (
        instead(variable="t500_from_lift", value=0.5, uncertainty=0.1),
        "the case has no mould that is lifted",
    ),
    "at rest before the start": (
        instead(variable="at_rest_since", value=-0.5, uncertainty=0.1),
        "measurements.0.value is -0.5 s; it must be above 0",
    ),
    "a level beyond the domain": (
        instead(variable="spread_diameter", reaches=5, value=1, uncertainty=0.1),
        "measurements.0.reaches is 5 m, and the domain of the case ends at a spread of 1.2 m",
    ),
    "a level of the start": (
        instead(variable="spread_diameter", reaches=0.1, value=1, uncertainty=0.1),
        "measurements.0.reaches is 0.1 m; it must be above the spread at the start, 0.2 m",
    ),
    "energy of less than nothing": (
        instead(variable="kinetic_energy", time=1, value=-1, uncertainty=0.1),
        "measurements.0.value is -1 J; it must be at least 0",
    ),
    "no height": (
        instead(variable="final_height", value=0, uncertainty=0.001),
        "measurements.0.value is 0 m; it must be above 0",
    ),
    "a spread that shrinks": (
        lambda _, m: m.extend(
            {"variable": "spread_diameter", "time": t, "value": d, "uncertainty": 0.002}
            for t, d in ((1, 0.5), (2, 0.4))
        ),
        "measurements.1 and tests.slump.measurements.2 contradict each other: the spread is 0.5 m at 1 s and "
        "0.4 m at 2 s, but a spread does not shrink",
    ),
    "a T500 after 500 mm": (
        lambda _, m: m.extend(
            [
                {"variable": "spread_diameter", "time": 1, "value": 0.45, "uncertainty": 0.002},
                {"variable": "t500", "value": 0.5, "uncertainty": 0.01},
            ]
        ),
        "contradict each other: the spread is 0.45 m at 1 s, and it reaches 0.5 m at 0.5 s",
    ),
    "two curves": (
        lambda _, m: m.extend(
            [CURVE, CURVE | {"columns": {"value": "other_m"}}],
        ),
        "contradict each other: the spread over time is 0.3 m by the one and 0.4 m by the other at 0.1 s",
    ),
    "a slump and a height": (
        lambda _, m: m.extend(
            [
                {"variable": "final_height", "value": 0.1, "uncertainty": 0.001},
                {"variable": "final_slump", "value": 0.1, "uncertainty": 0.001},
            ]
        ),
        "slump and height add up to 0.2 m, and the body is 0.3 m tall at the start",
    ),
    "a stage that is no case": (
        lambda fit, _: fit["tests"]["slump"].update(stages=[{"grid.cell_size": -1}]),
        "tests.slump.stages.0: grid.cell_size is -1",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_a_wrong_file_has_one_sentence(name, tmp_path, monkeypatch, capsys):
    change, sentence = BAD[name]
    assert sentence in refused(tmp_path, monkeypatch, capsys, change)


@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        ("time_s,spread_diameter_m\n0.1,0.3\n0.5,wide\n", "row 2: spread_diameter_m is 'wide'"),
        ("time_s,spread_diameter_m\n0.5,0.3\n0.1,0.4\n", "row 2: the time must grow from row to row"),
        ("time_s,spread_diameter_m\n", "has no row of numbers"),
        (
            "time_s,spread_diameter_m\n0,1,0,3\n",
            "row 1 has 4 cells, and there are 2 columns; decimals are written with a point",
        ),
        ("time_s,spread_diameter_m\n0.1\n", "row 1: spread_diameter_m is missing"),
        (
            "time_s,spread_diameter_m,spread_diameter_m\n0.1,0.3,0.4\n",
            "has two columns 'spread_diameter_m'; rename one of them",
        ),
        (
            "time_s,spread_diameter_m\n0.1,0.5\n0.2,0.3\n",
            "measurements.0 contradicts itself: the spread is 0.5 m at 0.1 s and 0.3 m at 0.2 s",
        ),
        ("time_s,spread_diameter_m\n0.1,300\n0.5,450\n", "looks like millimetres: write 0.45"),
        ("time_s,spread_diameter_m\n100,0.3\n500,0.45\n", "looks like milliseconds: write 0.5"),
    ],
)
def test_a_curve_that_cannot_be_meant(rows, sentence, tmp_path, monkeypatch, capsys):
    assert sentence in refused(tmp_path, monkeypatch, capsys, instead(**CURVE), rows)
