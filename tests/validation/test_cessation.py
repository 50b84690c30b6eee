"""Cessation of plane Poiseuille flow: a viscoplastic fluid comes to rest in a finite time."""

from __future__ import annotations

import numpy as np
import pytest
from accurate_setup import scheme
from bands import below, close_to
from channel import Channel
from fluids import UNIT

pytestmark = pytest.mark.section(2)

AT_REST = {0.0: 0.409, 0.2: 0.696}
"""Time of arrest, s, of the unit Bingham fluid that flowed at G = 1, by what is left of the drive."""


REGULARISED = [
    (0.0, 500.0, AT_REST[0.0]),
    pytest.param(0.2, 500.0, AT_REST[0.2], marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("drive", "m", "at_rest"), REGULARISED)
def test_regularised_fluid_nearly_stops(validate, drive, m, at_rest):
    """Started from the profile of G = 1. A regularised fluid creeps where the exact one has stopped.

    Near its end the fluid is one plug that the wall holds back with the yield stress: the discharge falls in
    a straight line. That line is taken between 5 % and 2 % of the first discharge, where the shear rate at
    the wall is still tens of 1/m, and where it meets zero is the time of arrest.
    """
    flow = Channel(UNIT, 1.0, 1.0, m=m, order="musl", fraction=1.0)
    flow.start_with(UNIT.speed(1.0, 1.0, flow.z))
    flow.set_drive(drive)
    first = flow.discharge()
    times, shares = [0.0], [1.0]
    while shares[-1] > 0.02:
        flow.run(0.004)
        times.append(flow.simulation.time)
        shares.append(flow.discharge() / first)
        assert times[-1] < 1.0, f"still flowing at {shares[-1]:.2g} of the first discharge"
    early, late = np.interp([-0.05, -0.02], -np.array(shares), times)
    found = late + (late - early) * 0.02 / 0.03
    name = f"Cessation, unit Bingham, G → {drive:g}, regularised: time of arrest"
    validate(name, found, close_to(at_rest, rel=0.05), unit="s")
    draw_decay(validate, f"G = {drive:g}, regularised", times, shares)


@pytest.mark.parametrize("drive", AT_REST)
def test_exact_fluid_stops(validate, drive):
    """With a yield stress by return mapping the discharge reaches zero, and that is the time of arrest.

    The plug that is held by tau0 at the wall springs back when it stops: it rings with at most tau0/(rho c_s)
    = 2.5e-3, c_s its shear wave's speed, which is 1.2 % of the mean speed at the start.
    """
    shear_modulus = 1e4
    flow = Channel(UNIT, 1.0, 1.0, sound_speed=100.0, shear_modulus=shear_modulus, **scheme())
    flow.start_with(UNIT.speed(1.0, 1.0, flow.z))
    flow.set_drive(drive)
    first, times, shares = flow.discharge(), [0.0], [1.0]
    while times[-1] < 1.5 * AT_REST[drive]:
        flow.run(0.004)
        times.append(flow.simulation.time)
        shares.append(flow.discharge() / first)
    shares = np.array(shares)
    turn = int(np.argmax(shares <= 0))
    stopped = np.interp(0, -shares[turn - 1 : turn + 1], times[turn - 1 : turn + 1]) if turn else np.nan
    name = f"Cessation, unit Bingham, G → {drive:g}, exact yield"
    validate(f"{name}: time of arrest", stopped, close_to(AT_REST[drive], rel=0.05), unit="s")
    ringing = UNIT.yield_stress / np.sqrt(shear_modulus) / first
    validate(f"{name}: discharge after it, of the first", np.abs(shares[turn:]).max(), below(ringing, "0"))
    draw_decay(validate, f"G = {drive:g}, exact yield", times, shares)


def draw_decay(validate, name: str, times: list[float], shares: list[float]) -> None:
    title = "Cessation of plane Poiseuille flow, unit Bingham fluid"
    chart = validate.figure("cessation", title, x="time (s)", y="discharge over that at the start")
    for drive, at_rest in AT_REST.items():
        chart.reference(f"exact time of arrest, G = {drive:g}", [at_rest, at_rest], [0, 1])
    chart.line(name, times, shares)
