"""Every registered body shape, with parameters, passes the conformance kit for third parties."""

import pytest

from mpmkit.registry import installed
from mpmkit.testing import body_shape_checks

SHAPES = installed().of_kind("body_shape")
CORNERS = [[0.05, 0.0], [0.1, 0.0], [0.1, 0.2], [0.3, 0.5], [0.05, 0.5]]
MADE = [
    {"kind": "box", "lower": [0, 0.1], "upper": [0.3, 0.2]},
    {"kind": "box", "lower": [0.1, -0.1, 0], "upper": [0.3, 0.2, 0.1]},
    {"kind": "cylinder", "radius": 0.1, "height": 0.3},
    {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": 0.3},
    {"kind": "frustum", "bottom_radius": 0, "top_radius": 0.1, "height": 0.2, "base": [0.1, 0.2, 0.3]},
    {"kind": "sphere", "centre": [0, 0.2], "radius": 0.1, "inner_radius": 0.05},
    {"kind": "sphere", "centre": [0.1, 0, 0.2], "radius": 0.1},
    {"kind": "polygon", "corners": CORNERS},
    {"kind": "polygon", "corners": CORNERS, "y": [-0.1, 0.2]},
]


def test_none_is_left_out():
    entries = installed().plugins["body_shape"].values()
    mine = {one.name for one in entries if one.distribution == "mpmkit"}
    assert mine == {one["kind"] for one in MADE} | {"mesh"}


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{one['kind']} {number}: {check.name}")
        for number, one in enumerate(MADE)
        for check in body_shape_checks(SHAPES[one["kind"]].model_validate(one))
    ],
)
def test_conformance(check):
    check()


def test_conformance_of_a_mesh(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    trimesh.creation.icosphere(2, radius=0.1).export(tmp_path / "ball.ply")
    for check in body_shape_checks(SHAPES["mesh"].model_validate({"file": str(tmp_path / "ball.ply")})):
        check()
