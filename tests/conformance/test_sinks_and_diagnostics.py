"""Every registered sink and diagnostic, with parameters, passes the conformance kit for third parties."""

import pytest

from mpmkit.registry import installed
from mpmkit.testing import diagnostic_checks, sink_checks

DIAGNOSTICS, SINKS = installed().of_kind("diagnostic"), installed().of_kind("sink")
MADE = [
    {"kind": "probe", "at": [0.13, 0.1]},
    {"kind": "probe", "at": [0.15, 0.13, 0.12]},
    {"kind": "flux", "axis": "z", "at": 0.1},
    {"kind": "flux", "axis": "r", "at": 0.2},
    {"kind": "flux", "axis": "y", "at": 0.2},
    {"kind": "largest-pressure", "wall": "z_min"},
]


MADE_SINKS = [
    {"kind": "face", "face": "z_min"},
    {"kind": "face", "face": "r_max"},
    {"kind": "face", "face": "y_max"},
    {"kind": "box", "lower": [0.1, -0.2], "upper": [0.7, 0.4]},
    {"kind": "box", "lower": [-0.5, -0.5, -0.5], "upper": [0.5, 0.5, 0.5]},
]


@pytest.mark.parametrize(("kind", "made"), [("diagnostic", MADE), ("sink", MADE_SINKS)])
def test_none_is_left_out(kind, made):
    entries = installed().plugins[kind].values()
    assert {one.name for one in entries if one.distribution == "mpmkit"} == {one["kind"] for one in made}


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{one}: {check.name}")
        for one in MADE
        for check in diagnostic_checks(DIAGNOSTICS[one["kind"]].model_validate(one))
    ]
    + [
        pytest.param(check, id=f"{one}: {check.name}")
        for one in MADE_SINKS
        for check in sink_checks(SINKS[one["kind"]].model_validate(one))
    ],
)
def test_conformance(check):
    check()
