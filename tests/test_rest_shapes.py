"""Closed forms of the laboratory tests against published formulas, and against each other."""

import math

import pytest

from mpmkit.rheology.deposits import (
    BAR,
    BIAXIAL,
    PLANE,
    bar_step,
    box_depths,
    channel_length,
    cone_spread,
    drop_spread,
    ring_spread,
    slope_length,
)
from mpmkit.rheology.laboratory import FORMULAS
from mpmkit.rheology.rotation import cylinder_torque

G = 9.81


def cone_volume(bottom, top, height):
    return math.pi * height / 12 * (bottom**2 + bottom * top + top**2)


KANTRO, HAEGERMANN = cone_volume(0.038, 0.019, 0.057), cone_volume(0.1, 0.07, 0.06)


@pytest.mark.parametrize(
    ("volume", "yield_stress", "diameter"),
    [(KANTRO, 5, 126), (KANTRO, 10, 110), (KANTRO, 20, 96),
     (HAEGERMANN, 5, 305), (HAEGERMANN, 10, 266), (HAEGERMANN, 20, 231)],
)  # fmt: skip
def test_spread_of_a_cone_without_stretching_is_that_of_roussel_and_coussot(volume, yield_stress, diameter):
    sink = yield_stress / (2000 * G)
    exact = 2 * (225 * volume**2 / (128 * math.pi**2 * sink)) ** 0.2
    assert cone_spread(volume, sink) == pytest.approx(exact, rel=1e-5)
    assert cone_spread(volume, sink) == pytest.approx(1e-3 * diameter, abs=6e-4)


def test_spread_with_stretching_is_that_of_the_finite_element_reference():
    """The no-slip slump of the reference rests at 0.409 m; lubrication alone says 0.470 m."""
    sink = 188.91 / (2574 * G)
    volume = cone_volume(0.2, 0.1, 0.3)
    assert cone_spread(volume, sink) == pytest.approx(0.470, abs=1e-3)
    assert cone_spread(volume, sink, BIAXIAL) == pytest.approx(0.409, abs=3e-3)
    assert cone_spread(volume, sink, PLANE) == pytest.approx(0.400, abs=1e-3)


@pytest.mark.parametrize(("yield_stress", "length"), [(20, 977), (50, 704), (100, 547), (200, 423)])
def test_length_in_the_lcpc_box(yield_stress, length):
    assert channel_length(6e-3, yield_stress / (2300 * G), 0.2) == pytest.approx(1e-3 * length, abs=1e-3)


@pytest.mark.parametrize(("yield_stress", "reading"), [(5, 133), (10, 92), (20, 60)])
def test_reading_of_a_bostwick_consistometer(yield_stress, reading):
    found = channel_length(0.05 * 0.05 * 0.038, yield_stress / (1000 * G), 0.05) - 0.05
    assert found == pytest.approx(1e-3 * reading, abs=1e-3)


@pytest.mark.parametrize(
    ("yield_stress", "back", "ratio", "plane_ratio"),
    [(20, 83.1, 0.80, 0.88), (50, 94.8, 0.56, 0.72), (100, 113.8, 0.21, 0.49)],
)
def test_depths_in_the_l_box(yield_stress, back, ratio, plane_ratio):
    sink = yield_stress / (2300 * G)
    h1, h2 = box_depths(0.06, 0.8, sink, 0.2)
    assert h1 == pytest.approx(1e-3 * back, abs=1e-4)
    assert h2 / h1 == pytest.approx(ratio, abs=6e-3)
    h1, h2 = box_depths(0.06, 0.8, sink)
    assert h2 / h1 == pytest.approx(plane_ratio, abs=6e-3)


def test_the_ends_of_a_closed_channel_add_their_force_to_the_friction_of_the_floor():
    """ρ g (h1² - h2²)/2 = τ0 L + π τ0 (h1 + h2)/2."""
    sink, length = 50 / (2300 * G), 0.8
    h1, h2 = box_depths(0.06, length, sink, stretching=PLANE)
    assert (h1**2 - h2**2) / 2 == pytest.approx(sink * (length + PLANE * (h1 + h2) / 2), rel=1e-3)


def test_the_plane_deposit_is_that_of_the_dam_break():
    sink, area = 188.91 / (2574 * G), 0.03
    assert channel_length(area, sink) == pytest.approx((9 * area**2 / (8 * sink)) ** (1 / 3), rel=1e-5)
    assert channel_length(area, sink, stretching=PLANE) == pytest.approx(0.443, abs=1e-3)


@pytest.mark.parametrize("degrees", [5, 10])
def test_the_deposit_on_a_slope_ends_as_coussot_says(degrees):
    """x tan θ = -h - h_c ln(1 - h/h_c) at the upper end, and for small angles the level deposit."""
    sink, angle = 50 / (2300 * G), math.radians(degrees)
    critical = sink / math.sin(angle)
    assert critical == pytest.approx({5: 0.0254, 10: 0.0128}[degrees], abs=1e-4)
    top = 0.5 * critical
    length = (-top - critical * math.log(1 - top / critical)) / math.tan(angle)
    if degrees == 5:
        assert length == pytest.approx(0.056, abs=5e-4)
    # its area, ∫ h dx with dx = h cos θ dh/(s - h sin θ)
    area = (-(top**2) / 2 - critical * top - critical**2 * math.log(1 - top / critical)) / math.tan(angle)
    assert slope_length(area, sink, angle) == pytest.approx(length, rel=1e-4)
    assert slope_length(area, sink, 1e-4) == pytest.approx(channel_length(area, sink), rel=1e-3)


@pytest.mark.parametrize(("density", "yield_stress", "slump"), [(2574, 188.91, 0.228), (2300, 1500, 0.0127)])
def test_slump_of_slices_is_that_of_schowalter_and_christensen(density, yield_stress, slump):
    (_, slices, _) = FORMULAS["slump_test"]
    given = {"density": density, "yield_stress": yield_stress, "mould_height": 0.3}
    assert slices.value(given) == pytest.approx(slump, abs=5e-4)


def test_a_slope_does_not_hold_more_than_the_critical_depth():
    with pytest.raises(ValueError, match="larger than the largest that can rest"):
        slope_length(10.0, 50 / (2300 * G), math.radians(10))


def test_torque_at_rest_is_the_start_of_flow_and_grows_with_the_speed():
    start = 2 * math.pi * 0.05**2 * 0.1 * 100
    assert cylinder_torque(0.05, 0.1, 1e-12, 100, 1) == pytest.approx(start, rel=1e-5)
    # the table of the cup whose fluid is sheared to 87 mm only: 0.303 N m at 0.05 rev/s
    assert cylinder_torque(0.0635, 0.127, 0.1 * math.pi, 50, 20) == pytest.approx(0.303, abs=6e-4)


@pytest.mark.parametrize("radius", [0.001, 0.05, 0.5])
def test_drops_of_a_table_spend_their_energy_on_stretching_and_on_the_floor(radius):
    """A cylinder of 60 mm is flattened to 30 mm by drops of the table; the test integrates its work over the
    height."""
    low, first, sink, steps = 0.03, 0.06, 0.01, 4000
    volume, work, step = math.pi * radius**2 * low, 0.0, (first - low) / steps
    for k in range(steps):
        height = low + (k + 0.5) * step
        wide = math.sqrt(volume / (math.pi * height))
        work += step * (math.sqrt(3) * math.pi * wide**2 + math.pi * wide**3 / (3 * height))
    fallen = sink * work / volume - (first - low) / 2
    assert drop_spread(volume, sink, first / 2, fallen) == pytest.approx(2 * radius, rel=1e-5)


def test_bars_in_a_closed_channel_take_their_force():
    """ρ g (h1² - h2²)/2 = τ0 L + π τ0 (h1 + h2)/2 + π/4 B τ0 (d/p) h, with the depth h at the bars."""
    sink, length, place = 50 / (2300 * G), 0.8, 0.175
    step = bar_step(0.012, 0.2 / 3, sink)
    assert step == pytest.approx(math.pi / 4 * BAR * 0.18 * sink)
    h1, h2 = box_depths(0.06, length, sink, stretching=PLANE, step=step, bars=place)
    free = box_depths(0.06, length, sink, stretching=PLANE)
    assert h1 > free[0]
    assert h2 < free[1]
    s = sink * (1 + PLANE * (h1 + h2) / (2 * length))
    before = math.sqrt(h1**2 - 2 * s * place)
    held = step * (2 * before - step) / 2  # (before² - behind²)/2
    assert (h1**2 - h2**2) / 2 == pytest.approx(s * length + held, rel=2e-3)


def test_a_ring_of_bars_keeps_a_step_in_the_deposit():
    sink, volume = 50 / (2300 * G), cone_volume(0.2, 0.1, 0.3)
    step = bar_step(0.018, 2 * math.pi * 0.15 / 16, sink)
    diameter, depth = ring_spread(volume, sink, BIAXIAL, 0.15, step)
    assert depth(0.15 - 1e-9) - depth(0.15) == pytest.approx(step, rel=1e-5)
    free = cone_spread(volume, sink, BIAXIAL)
    assert diameter < free
    held = sum(2 * math.pi * r * depth(r) * 1e-4 for r in (1e-4 * (k + 0.5) for k in range(4000)))
    assert held == pytest.approx(volume, rel=1e-3)
    assert ring_spread(volume, sink, BIAXIAL, 0.15, 0.0)[0] == pytest.approx(free, rel=1e-3)
    assert ring_spread(volume, sink, BIAXIAL, 0.5, step)[0] == pytest.approx(free, rel=1e-3)
