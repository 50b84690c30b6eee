"""A filled cone, closed at its bottom, in which concrete, water or a viscous fluid is at rest under its
weight.

The fluid starts with the pressure of its weight. The pressure is read twelve times in a period of its
oscillation, 4 H/c. ρ c² with c = 20 m/s is 140 times the pressure at the bottom.
"""

from __future__ import annotations

from functools import cache

import pytest
from bands import below, close_to
from filled_cone import filled_cone
from wall_scenes import FRESH

from mpmkit.errors import GuardStop

pytestmark = pytest.mark.section(6)
FLUIDS = {
    "concrete": {**FRESH, "sound_speed": 20.0},
    "water": {"law": "newtonian", "density": 1000.0, "viscosity": 1e-3, "sound_speed": 20.0},
    "a fluid of 20 Pa s": {"law": "newtonian", "density": 2574.0, "viscosity": 20.0, "sound_speed": 20.0},
}
WALLS = {"cone": None, "cup": 3, "thin cup": 2}
"""Thickness, cells."""


@cache
def rest(fluid, wall, until, redistribution):
    return filled_cone(FLUIDS[fluid], until, WALLS[wall], redistribution=redistribution)


def hold_places(validate, fluid, wall, until, redistribution="even"):
    beyond, volume, _ = rest(fluid, wall, until, redistribution)
    name = f"Cone filled with {fluid}, {wall}, redistribution {redistribution}, {until:g} s"
    validate(f"{name}: largest way of a particle beyond a wall, cells", beyond, below(0.1, "0"))
    validate(f"{name}: volume over that at the start", volume, close_to(1.0, rel=0.005))


def hold_pressure(validate, fluid, wall, until, redistribution="even"):
    _, _, pressure = rest(fluid, wall, until, redistribution)
    name = f"Cone filled with {fluid}, {wall}, redistribution {redistribution}, {until:g} s"
    validate(f"{name}: pressure at the foot over ρ g depth", pressure, close_to(1.0, rel=0.02))


def test_filled_cup_keeps_its_concrete(validate):
    hold_places(validate, "concrete", "cup", 0.3)


def test_filled_cone_keeps_its_water(validate):
    hold_places(validate, "water", "cone", 0.3)


def test_pressure_at_the_foot_of_a_filled_cone(validate):
    """Of a fluid without yield stress."""
    hold_pressure(validate, "a fluid of 20 Pa s", "cone", 0.5)


THIN = pytest.mark.xfail(
    reason="a caution says so before the run: nodes beyond the middle of the wall belong to its other side,"
    " but splines reach 1.5 cells. The energy guard stops water at 0.128 s; with `none` its pressure is 11 %"
    " wrong",
    raises=GuardStop,
    strict=True,
)


@THIN
def test_thin_cup_keeps_its_water(validate):
    hold_places(validate, "water", "thin cup", 0.3)


@pytest.mark.slow
@THIN
def test_thin_cup_keeps_its_concrete(validate):
    hold_places(validate, "concrete", "thin cup", 5.0)


LONG = pytest.mark.parametrize(
    ("fluid", "wall"), [("concrete", "cone"), ("concrete", "cup"), ("water", "cone")]
)


SWIRLS = pytest.mark.xfail(
    reason="water without yield stress is kept in motion: the energy guard stops it at 3.9 s, by when `even`"
    " has added 3.9 J; with one pass of the weights it is torn at 2.3 s",
    raises=GuardStop,
    strict=True,
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fluid", "wall"),
    [("concrete", "cone"), ("concrete", "cup"), pytest.param("water", "cone", marks=SWIRLS)],
)
def test_filled_cone_keeps_its_content_for_long(validate, fluid, wall):
    hold_places(validate, fluid, wall, 5.0)


@pytest.mark.slow
@pytest.mark.xfail(
    reason="concrete 3.3 % too little in the cone and 5.1 % in the cup, water 3.0 %. Concrete at 1 s with"
    " `none`: 4.7 %, steady to 0.3 %; its yield stress, 2.5 % of ρ g H, may bear a part. Water still moves",
    strict=True,
)
@LONG
def test_pressure_at_the_foot_of_a_filled_cone_for_long(validate, fluid, wall):
    hold_pressure(validate, fluid, wall, 5.0)
