"""Every registered source, with parameters, goes through the kit that third parties use."""

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
