"""The shipped laboratory tests, in their coarse variants, against published formulas.

Formulas for deposits at rest come from lubrication theory: the yield stress on the floor balances the
pressure gradient. They neglect the stress that stretches the layer (``rheology.deposits``), whose influence
is of the order of depth over length. The finite-element reference of the slump on a stick floor rests at
0.409 m; lubrication alone gives 0.470 m, lubrication with stretching 0.409 m. So runs are compared with the
latter, with the bands of the former. The comparison with lubrication alone is expected to fail.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from bands import above, below, close_to

import mpmkit
from mpmkit.case import load_case
from mpmkit.case.load import read_json
from mpmkit.case.parameters import parameters
from mpmkit.case.shipped import shipped_case
from mpmkit.rheology.laboratory import FORMULAS, THIN, G

pytestmark = pytest.mark.section(8)
QUICK = {"sagging_film": ("until=0.02",), "coaxial_cylinders": ("until=0.3",)}
"""Changes that make a case short enough for the default run: the film flows steadily after 5 ms, and the
fluid between the cylinders after 0.2 s."""
LONG = {"l_box_bars": ("parameters.longest=6",)}
"""Changes that make the longest case shorter: its h2/h1 grows by 4 % after 6 s."""
FORCES = ("torque_of_vane", "torque_of_cylinder", "plate_force")
"""Their result is the mean over the last twentieth of the run, because they oscillate with the sound
waves."""


def given(name: str) -> dict[str, float]:
    """The parameters of a shipped case."""
    return {key: entry.value for key, entry in parameters(read_json(shipped_case(name))).items()}


@cache
def run(name: str, *changes: str):
    return mpmkit.run(load_case(shipped_case(name), changes), threads=1)


def measured(name: str, what: str, *changes: str) -> float:
    values = run(name, *changes)[what].values
    return float(values[-max(1, len(values) // 20) :].mean() if what in FORCES else values[-1])


@pytest.mark.parametrize(
    "name",
    [
        name if name in QUICK else pytest.param(name, marks=pytest.mark.slow)
        for name, formulas in FORMULAS.items()
        if formulas[0].band is not None
    ],
)
def test_a_laboratory_test_agrees_with_its_formula(validate, name):
    formula = FORMULAS[name][0]
    found = measured(name, formula.measured, *(QUICK | LONG).get(name, ()))
    expected = close_to(formula.value(given(name)), rel=formula.band)
    validate(f"{name}: {formula.measured}", found, expected)


@pytest.mark.slow
@pytest.mark.xfail(
    reason="too long by 8 to 17 %: lubrication leaves out what it takes to stretch the layer", strict=True
)
@pytest.mark.parametrize(
    "name", ["slump_flow", "mini_cone_kantro", "mini_cone_haegermann", "lcpc_box", "bostwick", "slope"]
)
def test_a_deposit_agrees_with_lubrication_alone(validate, name):
    held, thin = FORMULAS[name]
    assert thin.words == THIN
    expected = close_to(thin.value(given(name)), rel=held.band)
    validate(f"{name}: {thin.measured}, lubrication alone", measured(name, thin.measured), expected)


@pytest.mark.parametrize(("part", "hangs"), [(1.05, True), (0.57, False)])
def test_a_film_hangs_below_its_critical_thickness_and_sags_above_it(validate, part, hangs):
    """h_c = τ0/(ρ g). The elastic part of a law with exact yield deforms by 2 τ0 H/(3 G) at most.

    With τ0/G = 0.3 % this is 0.2 % of the thickness; the film that sags has moved by 1 % after 0.04 s.
    """
    p = given("sagging_film")
    stress = part * p["density"] * G * p["thickness"]
    history = run("sagging_film", f"parameters.yield_stress={stress}", "until=0.04")
    speed = history["momentum"].values[:, 0] / history["total_mass"].values
    gone = np.trapezoid(speed, history["time"].values) / p["thickness"]
    name = f"Film on a vertical wall, {1 / part:.3g} h_c thick: way of its middle after 0.04 s, over H"
    validate(name, gone, below(2e-3, "0") if hangs else above(8e-3))


@pytest.mark.slow
@pytest.mark.parametrize(("part", "stands"), [(1.0, True), (0.4, False)])
def test_a_layer_stands_by_itself(validate, part, stands):
    """τ0 > ρ g h/√3 is enough for a layer to stand, and less than half of it is not."""
    p = given("standing_layer")
    enough = p["density"] * G * p["layer_height"] / math.sqrt(3)
    found = measured("standing_layer", "settlement", f"parameters.yield_stress={part * enough}")
    name = f"Layer with {part:g} of ρgh/√3: settlement over its height"
    validate(name, found, below(0.01, "0") if stands else above(0.05))


LAST = pytest.mark.xfail(
    reason="the last tenth drains as a film of one or two particles on walls that are four cells apart: 0.5 %"
    " and 8 % below the line in two versions that differ in their noise",
    strict=False,
)


@pytest.mark.slow
@pytest.mark.parametrize("part", [0.5, 0.7, pytest.param(0.8, marks=LAST)])
def test_the_flow_time_of_a_v_funnel_grows_in_line_with_the_viscosity(validate, part):
    """Of three viscosities, the flow time of the middle one lies on the line of the others.

    When 0.7 of the mass has left, the middle of the funnel is empty down to the outlet; the flow time of the
    case is that of 0.8.
    """
    times = []
    for mu in (10, 20, 50):
        history = run("v_funnel", f"parameters.plastic_viscosity={mu}")
        out = history["mass_out"].values
        whole = out[-1] + history["total_mass"].values[-1]
        times.append(float(np.interp(part * whole, out, history["time"].values)))
    short, middle, long = times
    line = short + (long - short) * (20 - 10) / (50 - 10)
    name = f"V-funnel at 20 Pa s: time of {part:g} of the mass over the line of 10 and 50 Pa s"
    validate(name, middle / line, close_to(1, rel=0.05))


@pytest.mark.slow
def test_the_flow_time_of_a_v_funnel_is_that_of_its_finest_run(validate):
    """The finest run has 3 cells in half of the depth, the shipped case 2."""
    fine = measured("v_funnel", "flow_time", "parameters.cells_across=3")
    validate(
        "V-funnel: flow time over that of the finest run",
        measured("v_funnel", "flow_time") / fine,
        close_to(1, rel=0.25),
    )


@pytest.mark.slow
def test_a_flow_table_spreads_mortar_with_a_part_of_the_energy_of_its_drops(validate):
    """A stopped table gives at most the energy m g h to the mortar. A rigid body would get none; mortar
    without viscosity would get all and spread farthest."""
    history, p = run("flow_table"), given("flow_table")
    work = float(history["force_work"].values[-1, 0]) / float(history["total_mass"].values[-1])
    energy = G * p["drops"] * p["drop_height"]
    validate("Flow table: work on the mortar over m g h of all drops", work / energy, below(1.0))
    farthest = FORMULAS["flow_table"][0].value(p)
    found = measured("flow_table", "flow_value")
    validate("Flow table: spread over the largest that energy allows", found / farthest, below(1.0))
    validate("Flow table: spread over the foot of the mould", found / (2 * p["bottom_radius"]), above(1.2))


@pytest.mark.slow
def test_a_frictionless_barrier_is_pushed_along_its_normal(validate):
    """The face leans back by 30°: for each newton along the flow cot 60° of it pushes the barrier down."""
    down = -measured("barrier", "upward_force") / measured("barrier", "force_on_barrier")
    lean = math.radians(given("barrier")["inclination"])
    validate("Barrier: downward over horizontal force", down, close_to(1 / math.tan(lean), rel=0.01))


@pytest.mark.slow
def test_a_barrier_holds_what_rests_on_it(validate):
    """Force ½ ρ g h², with h the depth at the foot of the barrier, and at most π τ0 h/2 more or less.

    The force is less where the layer is stretched, as after flowing back from the barrier, and more where it
    is compressed. The band has 10 % more, since h is read two cells before the barrier.
    """
    p, depth = given("barrier"), measured("barrier", "depth_at_barrier")
    weight, stretch = p["density"] * G * depth**2 / 2, math.pi / 2 * p["yield_stress"] * depth
    force = measured("barrier", "force_on_barrier")
    validate("Barrier at rest: force over the least for its depth", force / (weight - stretch), above(0.9))
    validate("Barrier at rest: force over the most for its depth", force / (weight + stretch), below(1.1))


@pytest.mark.slow
@pytest.mark.parametrize("yield_stress", [0.001, 20])
def test_the_flow_rate_of_a_full_marsh_cone(validate, yield_stress):
    """Buckingham & Reiner in every section of the full cone, with the kinetic head; the shipped case has 5
    Pa.

    The bands are those of the targets for the first litre; tests/test_funnels.py tests the closed form.
    """
    found = measured("marsh_cone", "outflow_rate", f"parameters.yield_stress={yield_stress}")
    (formula,) = FORMULAS["marsh_cone"]
    expected = formula.value(given("marsh_cone") | {"yield_stress": yield_stress})
    validate(f"Marsh cone at {yield_stress:g} Pa: flow rate", found, close_to(expected, rel=formula.band))


@pytest.mark.slow
def test_bars_of_a_ring_add_the_step_that_their_force_says(validate):
    """Randolph & Houlsby's force on 16 bars; without bars the deposit is higher in its middle as well.

    The band is that of two heights, each known to some 3 mm, of a step of 5 mm.
    """
    _, step, _ = FORMULAS["j_ring"]
    p = given("j_ring")
    expected = step.value(p) - step.value(p | {"bar_diameter": 0.0})
    without = measured("j_ring", "blocking_step", "parameters.bar_height=0")
    added = measured("j_ring", "blocking_step") - without
    validate("J-ring: height that its bars hold back, m", added, close_to(expected, rel=0.5))
