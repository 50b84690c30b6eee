"""Every registered surface and contact, with parameters, passes the conformance kit for third parties."""

import pytest

from mpmkit.registry import installed
from mpmkit.testing import contact_checks, surface_checks

SURFACES, CONTACTS = installed().of_kind("surface"), installed().of_kind("contact")

FRUSTUM = {"kind": "frustum", "bottom_radius": 0.4, "top_radius": 0.2, "height": 0.6}
CONE = {"kind": "frustum", "bottom_radius": 0.0, "top_radius": 0.5, "height": 0.8}
CYLINDER = {"kind": "cylinder", "radius": 0.3, "height": 0.5}
BOX = {"kind": "box", "lower": [0.1, -0.2], "upper": [0.5, 0.4]}
BOX_3D = {"kind": "box", "lower": [-0.1, -0.3, -0.2], "upper": [0.5, 0.4, 0.3]}
BALL = {"kind": "sphere", "centre": [0.0, 0.2], "radius": 0.4}
BALL_3D = {"kind": "sphere", "centre": [0.1, 0.0, 0.2], "radius": 0.4}
LIFT = {"kind": "velocity", "velocity": [0, 0.3], "start": 0.1, "end": 1.1}
DRIFT_3D = {"kind": "velocity", "velocity": [0.1, -0.2, 0.3]}
TABLE = {"kind": "table", "times": [0.1, 0.3, 0.9], "positions": [[0, 0], [0, 0.2], [0, -0.1]]}
SHAKEN = {"kind": "oscillation", "amplitude": [0.1, 0.05], "frequency": 1.5, "phase": 0.4, "end": 3.3}
TURNED = {"kind": "rotation", "point": [0.2, 0.1], "rate": 2.0, "start": 0.05}
TURNED_3D = {"kind": "rotation", "point": [0.2, 0.1, 0], "axis": [1, 2, 2], "rate": -3.0, "end": 2.0}


def body(shape, side, motion=None, **more):
    return {"kind": "body", "shape": shape, "side": side, "motion": motion, **more}


MADE = {
    "plane": {"kind": "plane", "point": [0.2, 0.1], "normal": [1, 2], "motion": TABLE},
    "shaken plane": {"kind": "plane", "point": [0.2, 0.1], "normal": [-1, 2], "motion": SHAKEN},
    "plane in 3d": {"kind": "plane", "point": [0, 0, 0], "normal": [1, -2, 2], "motion": DRIFT_3D},
    "mould": body(FRUSTUM, "inside", LIFT, thickness=0.1),
    "cup": body(CYLINDER, "inside", LIFT, thickness=0.1, open=["top"]),
    "bell": body(CYLINDER, "inside", None, thickness=0.1, open=["bottom"], appears=0.5, vanishes=1.0),
    "closed tube": body(CYLINDER, "inside", None, thickness=0.1, open=[]),
    "funnel": body(CONE, "inside", TABLE, thickness=0.1),
    "cavity": body(CONE, "inside"),
    "cone": body(FRUSTUM, "outside", TABLE),
    "turned box": body(BOX, "outside", TURNED),
    "trough": body(BOX, "inside", SHAKEN, thickness=0.1, open=["z_max"]),
    "drum": body(BALL, "inside", TURNED | {"point": [0.0, 0.2]}),
    "ball": body(BALL, "outside", LIFT),
    "turned box in 3d": body(BOX_3D, "outside", TURNED_3D),
    "crate": body(BOX_3D, "inside", TURNED_3D, thickness=0.1, open=["z_max", "x_min"]),
    "ball in 3d": body(BALL_3D, "inside", TURNED_3D, thickness=0.1),
    "turned cup in 3d": body(
        CYLINDER | {"base": [0, 0, 0]}, "inside", TURNED_3D, thickness=0.1, open=["top"]
    ),
}


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{name}: {check.name}")
        for name, made in MADE.items()
        for check in surface_checks(SURFACES[made["kind"]].model_validate(made))
    ],
)
def test_conformance_of_surfaces(check):
    check()


def test_all_registered_surfaces_and_contacts_are_tried():
    assert {made["kind"] for made in MADE.values()} == set(SURFACES)
    assert {made["kind"] for made in RULES} == set(CONTACTS)


RULES = [
    {"kind": "slip"},
    {"kind": "stick"},
    {"kind": "stick", "releases": True},
    {"kind": "coulomb", "coefficient": 0.0},
    {"kind": "coulomb", "coefficient": 0.4},
    {"kind": "coulomb", "coefficient": 1e9},
    {"kind": "navier-slip", "slip_length": 0.0},
    {"kind": "navier-slip", "slip_length": 0.01},
    {"kind": "navier-slip", "slip_length": 1e9},
]


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{rule}: {check.name}")
        for rule in RULES
        for check in contact_checks(CONTACTS[rule["kind"]].model_validate(rule))
    ],
)
def test_conformance_of_contacts(check):
    check()
