"""Every registered diagnostic, with parameters, goes through the kit that third parties use."""

import pytest

from mpmkit.registry import installed
from mpmkit.testing import diagnostic_checks

DIAGNOSTICS = installed().of_kind("diagnostic")
MADE = [
    {"kind": "probe", "at": [0.13, 0.1]},
    {"kind": "probe", "at": [0.15, 0.13, 0.12]},
    {"kind": "flux", "axis": "z", "at": 0.1},
    {"kind": "flux", "axis": "r", "at": 0.2},
    {"kind": "flux", "axis": "y", "at": 0.2},
    {"kind": "largest-pressure", "wall": "z_min"},
]


def test_none_is_left_out():
    ours = {
        name for name, entry in installed().plugins["diagnostic"].items() if entry.distribution == "mpmkit"
    }
    assert ours == {one["kind"] for one in MADE}


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{one}: {check.name}")
        for one in MADE
        for check in diagnostic_checks(DIAGNOSTICS[one["kind"]].model_validate(one))
    ],
)
def test_conformance(check):
    check()
