"""Motions of walls: position, velocity, and the times at which they are present."""

import math

import numpy as np
import pytest

from mpmkit.registry import installed
from mpmkit.spaces import SPACES

PLANE = installed().of_kind("surface")["plane"]
BODY = installed().of_kind("surface")["body"]
X = np.array([[0.3, 0.7], [-0.2, 0.1]])


def plane(motion=None, **more):
    made = {"kind": "plane", "point": [0, 0], "normal": [0, 2], "motion": motion, **more}
    return PLANE.model_validate(made).placed(SPACES["plane-strain"])


def heights(placed, t):
    """Height of the plane, m."""
    return X[:, 1] - placed.distance(X, t)[0]


def speeds(placed, t):
    return placed.velocity(X, t)[:, 1]


def test_at_rest():
    placed = plane()
    assert heights(placed, 3.0).tolist() == [0, 0]
    assert placed.fastest(0, 1e9) == 0
    assert placed.thickness == math.inf


@pytest.mark.parametrize(
    ("motion", "time", "height", "speed"),
    [
        ({"kind": "velocity", "velocity": [9, 0.3]}, 2.0, 0.6, 0.3),
        ({"kind": "velocity", "velocity": [0, 0.3], "start": 0.5}, 0.4, 0.0, 0.0),
        ({"kind": "velocity", "velocity": [0, 0.3], "start": 0.5, "end": 1.5}, 1.0, 0.15, 0.3),
        ({"kind": "velocity", "velocity": [0, 0.3], "start": 0.5, "end": 1.5}, 1.5, 0.3, 0.0),
        ({"kind": "table", "times": [1, 2, 4], "positions": [[0, 0], [0, 1], [0, 0]]}, 0.5, 0.0, 0.0),
        ({"kind": "table", "times": [1, 2, 4], "positions": [[0, 0], [0, 1], [0, 0]]}, 1.5, 0.5, 1.0),
        ({"kind": "table", "times": [1, 2, 4], "positions": [[0, 0], [0, 1], [0, 0]]}, 2.0, 1.0, -0.5),
        ({"kind": "table", "times": [1, 2, 4], "positions": [[0, 0], [0, 1], [0, 3]]}, 9.0, 3.0, 0.0),
        ({"kind": "oscillation", "amplitude": [0, 0.1], "frequency": 2}, 0.125, 0.1, 0.0),
        ({"kind": "oscillation", "amplitude": [0, 0.1], "frequency": 2}, 0.5, 0.0, 0.4 * math.pi),
        (
            {"kind": "oscillation", "amplitude": [0, 0.1], "frequency": 2, "phase": math.pi / 2},
            0.25,
            -0.2,
            0.0,
        ),
        ({"kind": "oscillation", "amplitude": [0, 0.1], "frequency": 2, "end": 0.125}, 7.0, 0.1, 0.0),
    ],
)
def test_place_and_velocity(motion, time, height, speed):
    placed = plane(motion)
    assert heights(placed, time).tolist() == pytest.approx([height] * 2, abs=1e-15)
    assert speeds(placed, time).tolist() == pytest.approx([speed] * 2, abs=1e-15)


def test_the_fastest_is_that_of_the_time_that_is_asked_for():
    lift = plane({"kind": "velocity", "velocity": [0.4, 0.3], "start": 1, "end": 2})
    assert [lift.fastest(*span) for span in ((0, 0.9), (0, 1), (1.5, 1.6), (2, 3))] == [0, 0.5, 0.5, 0]
    table = plane({"kind": "table", "times": [1, 2, 4], "positions": [[0, 0], [0, 1], [0, 0]]})
    assert [table.fastest(*span) for span in ((0, 0.5), (1.2, 1.3), (2.5, 3), (0, 9))] == [0, 1, 0.5, 1]


def test_rotation_turns_x_towards_z():
    bar = BODY.model_validate(
        {
            "kind": "body",
            "shape": {"kind": "box", "lower": [0, -0.1], "upper": [1, 0.1]},
            "side": "outside",
            "motion": {"kind": "rotation", "point": [0, 0], "rate": math.pi / 2},
        }
    ).placed(SPACES["plane-strain"])
    tip = np.array([[0.0, 1.5], [0.3, 0.5]])  # above its end, and beside it, when it stands upright
    distance, normal = bar.distance(tip, 1.0)
    assert distance.tolist() == pytest.approx([0.5, 0.2])
    np.testing.assert_allclose(normal, [[0, 1], [1, 0]], atol=1e-15)
    # The nearest point of the bar moves, not the point that is asked for: (0, 1) and (0.1, 0.5).
    np.testing.assert_allclose(
        bar.velocity(tip, 1.0), np.pi / 2 * np.array([[-1, 0], [-0.5, 0.1]]), atol=1e-15
    )
    assert bar.fastest(0, 1) == pytest.approx(math.pi / 2 * math.hypot(1, 0.1))


def test_rotation_in_3d_follows_the_right_hand():
    ball = BODY.model_validate(
        {
            "kind": "body",
            "shape": {"kind": "sphere", "centre": [1, 0, 0], "radius": 0.1},
            "side": "outside",
            "motion": {"kind": "rotation", "point": [0, 0, 5], "axis": [0, 0, 2], "rate": math.pi / 2},
        }
    ).placed(SPACES["3d"])
    distance, normal = ball.distance(np.array([[0.0, 1.3, 0]]), 1.0)
    assert distance[0] == pytest.approx(0.2)
    np.testing.assert_allclose(normal, [[0, 1, 0]], atol=1e-15)
    assert ball.fastest(0, 1) == pytest.approx(math.pi / 2 * 1.1)


def test_a_drum_that_turns_about_its_axis_is_as_fast_as_its_rim():
    """The bound is within a thousandth of ω R: it limits the time step."""
    drum = BODY.model_validate(
        {
            "kind": "body",
            "shape": {"kind": "cylinder", "radius": 0.2, "height": 0.1},
            "side": "inside",
            "motion": {"kind": "rotation", "point": [0, 0, 0], "axis": [0, 0, 1], "rate": 5.0},
        }
    ).placed(SPACES["3d"])
    assert 1.0 <= drum.fastest(0, 1) < 1.0013
    np.testing.assert_allclose(drum.velocity(np.array([[0.19, 0, 0.05]]), 0.0), [[0, 1.0, 0]], atol=1e-12)


def test_a_wall_appears_and_vanishes():
    placed = plane(appears=0.5, vanishes=1.5)
    assert [placed.present(t) for t in (0.0, 0.5, 1.49, 1.5, 9.0)] == [False, True, True, False, False]
    assert plane().present(0.0)
    assert plane().present(1e9)
