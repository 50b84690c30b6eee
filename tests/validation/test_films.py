"""Films on a slope: their speed, and rest below the critical thickness.

A film slightly thicker than critical shears in a thin layer at its bed; a thinner film stays at rest.
"""

from __future__ import annotations

import numpy as np
import pytest
from accurate_setup import scheme, stiff
from bands import below, close_to
from channel import Channel, down_slope
from fluids import BAND, CONCRETE

pytestmark = pytest.mark.section(2)


def film(degrees: float, height: float, m: float, cells: int = 10) -> Channel:
    drive, across = down_slope(CONCRETE.density, degrees)
    return Channel(
        CONCRETE, height, drive, cells=cells, m=m, order="musl", fraction=1.0,
        normal_gravity=across, free_surface=True, sound_speed=50.0,
    )  # fmt: skip


@pytest.mark.slow
def test_film_on_20_degrees(validate):
    """The film starts 3 % too slow, so that it must reach its speed by itself: 56.42 mm/s."""
    drive, _ = down_slope(CONCRETE.density, 20)
    flow = film(20, 0.05, CONCRETE.exponent(drive, 0.05, excess=0.008))
    flow.start_with(0.97 * CONCRETE.speed(drive, 0.05, flow.z))
    flow.run_until_steady(1e-3, interval=0.01, at_most=1.0)
    validate("Film on 20°, 50 mm: surface speed", flow.plug_speed(), close_to(0.05642, rel=BAND), unit="m/s")
    error = flow.error(CONCRETE.speed(drive, 0.05, flow.z))
    validate("Film on 20°, 50 mm: profile, L2 error", error, below(BAND))
    z = np.linspace(0, 0.05, 400)
    chart = validate.figure("film_20", "Film on 20°, 50 mm", x="u (m/s)", y="distance from the bed (m)")
    chart.reference("exact", CONCRETE.speed(drive, 0.05, z), z)
    chart.points("mpmkit, 10 cells", flow.speed, flow.z)


def midpoint_speed(flow: Channel) -> float:
    """Speed of the surface when every cell shears at the rate that belongs to the stress in its middle."""
    edges = np.linspace(0.0, flow.height, round(flow.height / flow.simulation.grid.cell_size) + 1)
    middle = (edges[1:] + edges[:-1]) / 2
    step = 1e-4 * flow.height
    high = flow.fluid.regularised_speed(flow.drive, flow.height, middle + step, flow.m)
    low = flow.fluid.regularised_speed(flow.drive, flow.height, middle - step, flow.m)
    return float(np.sum((high - low) / (2 * step) * np.diff(edges)))


def steady_speed(cells: int, lower: float, upper: float) -> float:
    """Steady surface speed of the 10° film, m/s, from its imbalance of momentum at two surface speeds.

    Every flow approaches the steady one and never passes it. So the steady speed lies between these two if
    the film gains momentum at one and loses momentum at the other; a run of the many seconds that so slow a
    film takes to become steady is not necessary. Between the two speeds a straight line is accurate enough.
    """
    drive, _ = down_slope(CONCRETE.density, 10)
    profile = CONCRETE.speed(drive, 0.05, np.linspace(0, 0.05, 1001))
    rates = []
    for speed in (lower, upper):
        flow = film(10, 0.05, CONCRETE.exponent(drive, 0.05, excess=0.01), cells)
        flow.start_with(np.interp(flow.z, np.linspace(0, 0.05, 1001), profile * speed / profile[-1]))
        flow.run(0.003)  # the sheared layer, 6.9 mm, finds the shape of its profile in rho h²/k = 2.7 ms
        rates.append(flow.imbalance(0.001))
    assert rates[0] > rates[1]
    return lower + (upper - lower) * rates[0] / (rates[0] - rates[1])


@pytest.mark.slow
def test_film_on_10_degrees(validate):
    """Its sheared layer is 6.9 mm of its 50 mm: 2.7 cells of 20. It flows at 2.90 mm/s."""
    found = steady_speed(20, (1 - BAND) * 0.00290, (1 + BAND) * 0.00290)
    validate("Film on 10°, 50 mm, 20 cells: surface speed", found, close_to(0.00290, rel=BAND), unit="m/s")


@pytest.mark.slow
def test_film_on_10_degrees_is_too_thin_a_layer_for_10_cells(validate):
    """The sheared layer is 1.4 cells thick, and the midpoint rule over it gives 7 % too little.

    The same is measured: the error comes from piecewise linear velocities, not from the way they are
    computed.
    """
    drive, _ = down_slope(CONCRETE.density, 10)
    expected = midpoint_speed(film(10, 0.05, CONCRETE.exponent(drive, 0.05, excess=0.01)))
    assert expected < (1 - BAND) * 0.00290
    found = steady_speed(10, 0.98 * expected, 1.02 * expected)
    name = "Film on 10°, 50 mm, 10 cells: surface speed, by the midpoint rule"
    validate(name, found, close_to(expected, rel=0.02), unit="m/s")


def test_film_below_its_critical_thickness_stays(validate):
    """40 mm on 10°, where 43.1 mm would flow: the speed stays below 1e-4 of the free-fall speed √(2 g H).

    What is left is the creep of the regularised fluid. Below the yield stress γ̇ = -ln(1 - tau/tau0)/m, and
    with s = H/y0 the surface moves at y0/m [(1 - s) ln(1 - s) + s]: 6.4e-5 m/s for m = 500 s.
    """
    drive, _ = down_slope(CONCRETE.density, 10)
    height, m = 0.04, 500.0
    flow = film(10, height, m, cells=5)
    critical = CONCRETE.yield_stress / drive
    assert critical == pytest.approx(0.0431, rel=1e-3)
    s = height / critical
    creep = critical / m * ((1 - s) * np.log(1 - s) + s)
    fastest = 0.0
    for _ in range(3):  # 6 ms, and it creeps steadily after rho H²/(tau0 m), 0.04 ms
        flow.run(0.002)
        fastest = max(fastest, float(np.linalg.norm(flow.particles.velocity, axis=1).max()))
    free_fall = np.sqrt(2 * 9.81 * height)
    name = "Film on 10°, 40 mm, regularised: speed over that of free fall"
    validate(name, fastest / free_fall, below(1e-4, "at rest"))
    name = "Film on 10°, 40 mm, regularised: creep of its surface"
    validate(name, flow.plug_speed(), close_to(creep, rel=BAND), unit="m/s")


# --- Exact yield ------------------------------------------------------------------------------------------


def exact_film(degrees: float, height: float, cells: int, *, waves: float) -> Channel:
    """The accurate set-up, with a shear stress that balances the weight; ``waves`` is the wave speed, m/s."""
    drive, across = down_slope(CONCRETE.density, degrees)
    flow = Channel(
        CONCRETE, height, drive, cells=cells, normal_gravity=across, free_surface=True,
        **stiff(CONCRETE.density, waves), **scheme(),
    )  # fmt: skip
    flow.particles.stress[:, 5] = np.minimum(drive * (height - flow.z), CONCRETE.yield_stress)
    return flow


def test_exact_film_on_20_degrees(validate):
    """From rest; the plug's steady speed is 56.42 mm/s."""
    flow = exact_film(20, 0.05, 10, waves=20.0)
    flow.run_until_steady(1e-3, interval=0.02, at_most=5.0)
    name = "Film on 20°, 50 mm, exact yield"
    validate(f"{name}: surface speed", flow.plug_speed(), close_to(0.05642, rel=BAND), unit="m/s")
    error = flow.error(CONCRETE.speed(flow.drive, 0.05, flow.z))
    validate(f"{name}: profile, L2 error", error, below(BAND))


@pytest.mark.slow
def test_exact_film_on_10_degrees(validate):
    """From rest, 20 cells. The waves are fast, see ``Channel._settle``."""
    flow = exact_film(10, 0.05, 20, waves=60.0)
    flow.run_until_steady(1e-4, interval=0.05, at_most=5.0)
    name = "Film on 10°, 50 mm, exact yield, 20 cells"
    validate(f"{name}: surface speed", flow.plug_speed(), close_to(0.00290, rel=BAND), unit="m/s")


def test_exact_film_below_its_critical_thickness_stays(validate):
    """40 mm on 10°, where 43.1 mm would flow: the film stays, and stops again after a push to 10 mm/s.

    Across the slope the film starts slightly out of balance, since its layers lie where they would lie
    without weight, and it oscillates with a speed of g H/c. Waves of 200 m/s keep this speed below the limit.
    After the push the film, which is elastic, oscillates along the slope too, with a period of 4 H/c; so its
    drift is tested then.
    """
    flow = exact_film(10, 0.04, 5, waves=200.0)
    free_fall = np.sqrt(2 * 9.81 * 0.04)
    fastest = 0.0
    for _ in range(40):  # 0.02 s, in which a wave goes 50 times up and down
        flow.run(0.0005)
        fastest = max(fastest, float(np.linalg.norm(flow.particles.velocity, axis=1).max()))
    name = "Film on 10°, 40 mm, exact yield"
    validate(f"{name}: speed over that of free fall", fastest / free_fall, below(1e-4, "at rest"))
    flow.start_with(np.full(len(flow.z), 0.01))
    flow.run(0.1)  # it stops after 0.08 s, slowed down by (tau0 - G H)/(rho H)
    drift = abs(mean_travel(flow, 0.05)) / 0.05
    validate(f"{name}, pushed: drift over the speed of free fall", drift / free_fall, below(1e-4, "at rest"))


def mean_travel(flow: Channel, seconds: float) -> float:
    """Distance that the film moves along the slope, m: the integral of its mean speed."""
    steps, travelled = 125, 0.0
    for _ in range(steps):
        flow.run(seconds / steps)
        travelled += flow.discharge() / flow.height * seconds / steps
    return travelled
