"""The distance of a plane region, compiled, against NumPy as the definition says it."""

import numpy as np
import pytest

from mpmkit.geometry.distance import Section, trapezium, trapezium_shell
from mpmkit.kernels.sections import section_distance

REGIONS = {
    "trapezium": trapezium(0.1, 0.05, 0.3),
    "cone": trapezium(0.0, 0.1, 0.3),
    "mould": trapezium_shell(0.1, 0.05, 0.3, 0.02, ["bottom", "top"]),
    "cup": trapezium_shell(0.1, 0.05, 0.3, 0.02, ["top"]),
    "closed": trapezium_shell(0.1, 0.05, 0.3, 0.02, []),
}


def reference(x, start, end):
    """Distance of the nearest point of all edges, below 0 where the winding number is odd; its gradient."""
    along = end - start
    part = ((x[:, None] - start) * along).sum(axis=2) / (along * along).sum(axis=1)
    foot = start + np.clip(part, 0, 1)[:, :, None] * along
    apart = np.linalg.norm(x[:, None] - foot, axis=2)
    nearest = foot[np.arange(len(x)), apart.argmin(axis=1)]
    angle = np.arctan2(*np.moveaxis(end - x[:, None], 2, 0)[::-1]) - np.arctan2(
        *np.moveaxis(start - x[:, None], 2, 0)[::-1]
    )
    turns = np.rint(((angle + np.pi) % (2 * np.pi) - np.pi).sum(axis=1) / (2 * np.pi)).astype(int)
    sign = np.where(turns % 2 == 1, -1.0, 1.0)
    distance = apart.min(axis=1)
    return sign * distance, sign[:, None] * (x - nearest) / distance[:, None]


@pytest.mark.parametrize("name", REGIONS)
def test_distance_and_gradient(name):
    section = Section.of(REGIONS[name])
    x = np.random.default_rng(0).uniform([-0.2, -0.1], [0.2, 0.4], (2000, 2))
    distance, gradient = section_distance(x, section.start, section.end)
    expected, direction = reference(x, section.start, section.end)
    np.testing.assert_allclose(distance, expected, rtol=0, atol=1e-15)
    np.testing.assert_allclose(gradient, direction, rtol=0, atol=1e-10)  # what is near has no exact direction


@pytest.mark.parametrize("name", REGIONS)
def test_on_the_edges_and_at_the_corners(name):
    section = Section.of(REGIONS[name])
    x = np.concatenate([section.start, (section.start + section.end) / 2])
    distance, gradient = section_distance(x, section.start, section.end)
    np.testing.assert_allclose(distance, 0, atol=1e-16)
    np.testing.assert_allclose(np.linalg.norm(gradient, axis=1), 1)


def test_a_point_that_is_none_has_no_distance():
    section = Section.of(REGIONS["mould"])
    distance, gradient = section_distance(np.array([[np.nan, 0.1]]), section.start, section.end)
    assert np.isnan(distance).all()
    assert np.isnan(gradient).all()
