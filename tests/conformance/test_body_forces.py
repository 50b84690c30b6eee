"""Every registered body force, with parameters, passes the conformance kit for third parties."""

import pytest

from mpmkit.registry import installed
from mpmkit.testing import body_force_checks

FORCES = installed().of_kind("body_force")
TABLE = {"times": [0.2, 0.9, 1.4], "vectors": [[0, -9.81], [3, -9], [1, -9.7]]}
DROPS = {
    "times": [0.0, 0.05, 0.06],
    "velocities": [[0, 0], [0, -0.5], [0, 0]],
    "period": 0.25,
    "count": 8,
}
MADE = [
    {"kind": "gravity", "vector": [0, -9.81]},
    {"kind": "gravity", "vector": [1, 2, -9.81]},
    {"kind": "gravity-table", **TABLE},
    {"kind": "turning-gravity", "vector": [1, -9.81], "rate": -0.7, "start": 0.1},
    {"kind": "turning-gravity", "vector": [1, 2, -9.81], "rate": 5.0, "axis": [1, 1, 0], "end": 4.0},
    {"kind": "moving-frame", **DROPS},
    {"kind": "moving-frame", "times": [0.1, 2.0], "velocities": [[0, 0, 0], [1, 0, -2]]},
    {"kind": "oscillation", "amplitude": [0.001, 0.01], "frequency": 20, "start": 0.01},
    {"kind": "oscillation", "amplitude": [0, 0.01, 0.01], "frequency": 7, "start": 0.0, "end": 2.0},
    {"kind": "rotating-frame", "point": [0.3, -0.1], "rate": 3.0},
    {"kind": "rotating-frame", "point": [0, 0, 1], "axis": [1, 0, 2], "times": [0.2, 1.2], "rates": [0, -4]},
    {"kind": "centrifugal", "rate": 5.0},
    {"kind": "centrifugal", "rate": 5.0, "point": [0, 0.2, 0.1], "direction": [1, 1, 1]},
]


def test_none_is_left_out():
    entries = installed().plugins["body_force"].values()
    assert {one.name for one in entries if one.distribution == "mpmkit"} == {one["kind"] for one in MADE}


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{one['kind']} {number}: {check.name}")
        for number, one in enumerate(MADE)
        for check in body_force_checks(FORCES[one["kind"]].model_validate(one))
    ],
)
def test_conformance(check):
    check()
