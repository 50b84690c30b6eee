"""Every registered initial field, with parameters, passes the conformance kit for third parties."""

import pytest

from mpmkit.registry import installed
from mpmkit.testing import initial_field_checks

FIELDS = installed().of_kind("initial_field")
MADE = [
    {"kind": "uniform", "value": [1.0, -2.0]},
    {"kind": "uniform", "value": 3.0},
    {"kind": "table", "axis": "z", "places": [-0.3, 0.5], "values": [1.0, 2.0]},
    {"kind": "table", "axis": "y", "places": [0, 1], "values": [[1.0, 0, 0], [0, 2.0, 0]]},
    {"kind": "hydrostatic", "load": 100.0},
    {"kind": "k0", "ratio": 0.5, "level": 0.7},
]


def test_none_is_left_out():
    entries = installed().plugins["initial_field"].values()
    assert {one.name for one in entries if one.distribution == "mpmkit"} == {one["kind"] for one in MADE}


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{one['kind']} {number}: {check.name}")
        for number, one in enumerate(MADE)
        for check in initial_field_checks(FIELDS[one["kind"]].model_validate(one))
    ],
)
def test_conformance(check):
    check()
