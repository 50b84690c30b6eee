"""Every registered source, with parameters, passes the conformance kit for third parties."""

import pytest

from mpmkit.registry import installed
from mpmkit.testing import source_checks

SOURCES = installed().of_kind("source")
TABLE = {"times": [0.5, 1.0, 3.0], "values": [0.0, 0.3, 0.1]}
MADE = [
    {"kind": "inlet", "face": "x_min", "velocity": 0.2},
    {"kind": "inlet", "face": "z_max", "flux": 0.002, "start": 1.5, "end": 4.0},
    {"kind": "inlet", "face": "z_min", "velocity": TABLE, "start": 0.7},
    {"kind": "inlet", "lower": [0.1, 0.5], "upper": [0.3, 0.5], "direction": "-z", "flux": TABLE, "end": 2.5},
    {"kind": "pour", "centre": [0, 0.5], "radius": 0.05, "rate": 0.4},
    {"kind": "pour", "centre": [0, 0, 0.5], "radius": 0.05, "rate": 0.4, "mass": 1.2, "start": 0.5},
    {
        "kind": "nozzle",
        "radius": 0.01,
        "points": [[0, 0.1], [0.2, 0.1], [0.2, 0.2]],
        "speeds": [0.1, 0.2],
        "fluxes": [2e-4, 0],
    },
    {"kind": "nozzle", "radius": 0.01, "gcode": ["G0 X0 Y0 Z20 F6000", "G1 X100 E900 F1200", "G1 Y50 E900"]},
    {"kind": "inlet", "centre": [0, 0, 0.5], "radius": 0.1, "direction": "-z", "velocity": 0.1},
]


def test_none_is_left_out():
    entries = installed().plugins["source"].values()
    assert {one.name for one in entries if one.distribution == "mpmkit"} == {one["kind"] for one in MADE}


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{one}: {check.name}")
        for one in MADE
        for check in source_checks(SOURCES[one["kind"]].model_validate(one))
    ],
)
def test_conformance(check):
    check()
