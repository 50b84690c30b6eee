"""Plane Poiseuille flow: steady profiles and the order of their error.

The velocity update is FLIP throughout. PIC adds a viscosity of the order of dx²/dt, which at the steps that
a regularised fluid demands is thousands of times that of the fluid; FLIP adds none, and the noise that it
keeps has nothing to feed on in a flow that does not depend on x.

Where the grid goes no finer than 10 cells the answer has two errors. The shear rate is constant in a cell,
so that the law sees the stress in the middle of the cell: the midpoint rule for ∫ γ̇(G (H - z)) dz. And the
fluid is regularised: its surface flows tau0/(G m) too fast.
"""

from __future__ import annotations

import numpy as np
import pytest
from accurate_setup import scheme
from bands import above, below, close_to
from channel import Channel, down_slope, names, observed_order
from fluids import BAND, CONCRETE, PLASTIC, UNIT, WATER

pytestmark = pytest.mark.section(2)


def test_formulas_give_the_table():
    for fluid, height, drive, plug, discharge in (
        (CONCRETE, 0.05, 1e4, 0.075168, 2.90865e-3),
        (PLASTIC, 0.05, 1e4, 0.105999, 4.20077e-3),
        (UNIT, 1.0, 1.0, 0.28125, 0.210938),
    ):
        assert fluid.plug_speed(drive, height) == pytest.approx(plug, rel=1e-5)
        assert fluid.half_discharge(drive, height) == pytest.approx(discharge, rel=1e-5)
    for degrees, speed in ((20, 0.05642), (10, 0.00290)):
        assert CONCRETE.plug_speed(down_slope(2574.0, degrees)[0], 0.05) == pytest.approx(speed, rel=2e-3)


# --- Plane Poiseuille flow --------------------------------------------------------------------------------


def hold_to_the_table(validate, flow: Channel, name: str, plug: float, discharge: float) -> None:
    fluid = flow.fluid
    error = flow.error(fluid.speed(flow.drive, flow.height, flow.z))
    validate(f"Plane Poiseuille, {name}: profile, L2 error", error, below(BAND))
    validate(
        f"Plane Poiseuille, {name}: speed of the plug",
        flow.plug_speed(),
        close_to(plug, rel=BAND),
        unit="m/s",
    )
    validate(f"Plane Poiseuille, {name}: Q/2", flow.discharge(), close_to(discharge, rel=BAND), unit="m²/s")


def draw_profile(validate, flow: Channel, figure: str, title: str) -> None:
    """u(z) of the particles at 10 cells across the half gap, over the exact one."""
    z = np.linspace(0, flow.height, 400)
    chart = validate.figure(figure, title, x="u (m/s)", y="distance from the wall (m)")
    chart.reference("exact", flow.fluid.speed(flow.drive, flow.height, z), z)
    chart.points("mpmkit, 10 cells across the half gap", flow.speed, flow.z)


@pytest.mark.slow
@pytest.mark.parametrize("order", ["usl", "usf"])
def test_unit_bingham_from_rest(validate, order):
    m = UNIT.exponent(1.0, 1.0, excess=0.006)
    flow = Channel(UNIT, 1.0, 1.0, m=m, order=order)
    flow.run_until_steady(1e-3, interval=0.05, at_most=10.0)
    hold_to_the_table(validate, flow, f"unit Bingham, {order.upper()}", 0.28125, 0.210938)
    draw_profile(validate, flow, "poiseuille_unit_bingham", "Plane Poiseuille flow, unit Bingham fluid")


@pytest.mark.parametrize(
    ("fluid", "name", "plug", "discharge"),
    [
        pytest.param(
            CONCRETE, "Herschel–Bulkley", 0.075168, 2.90865e-3, id="herschel-bulkley", marks=pytest.mark.slow
        ),
        pytest.param(PLASTIC, "Bingham", 0.105999, 4.20077e-3, id="bingham", marks=pytest.mark.slow),
    ],
)
def test_concrete_from_rest(validate, fluid, name, plug, discharge):
    """First with a small m, which allows longer steps, then with the m of the comparison."""
    flow = Channel(fluid, 0.05, 1e4, m=8.0, order="musl", fraction=1.0)
    flow.run_until_steady(1e-3, interval=0.005, at_most=1.0)
    flow.sharpen(fluid.exponent(1e4, 0.05, excess=0.003))
    flow.run_until_steady(1e-3, interval=0.005, at_most=1.0)
    hold_to_the_table(validate, flow, f"{name} concrete", plug, discharge)
    figure = "poiseuille_" + name.lower().replace("–", "_")
    draw_profile(validate, flow, figure, f"Plane Poiseuille flow, {name} concrete")


def hold_to_the_order(validate, name: str, cells: list[int], errors: list[float]) -> None:
    validate(f"Plane Poiseuille, {name}: L2 error at 10 cells", errors[1], below(BAND))
    validate(f"Plane Poiseuille, {name}: observed order", observed_order(cells, errors), above(1.0))
    draw_errors(validate, name, cells, errors)


def draw_errors(validate, name: str, cells: list[int], errors: list[float]) -> None:
    title = "Plane Poiseuille flow: error of the profile"
    chart = validate.figure(
        "poiseuille_order", title, x="cells across the half gap", y="relative L2 error", scale="log-log"
    )
    chart.reference("second order", cells, 0.5 / np.square(cells))
    chart.points(name, cells, errors)


@pytest.mark.parametrize(
    ("fluid", "name", "height", "drive", "plug", "discharge"),
    [
        (CONCRETE, "Herschel–Bulkley concrete", 0.05, 1e4, 0.075168, 2.90865e-3),
        (PLASTIC, "Bingham concrete", 0.05, 1e4, 0.105999, 4.20077e-3),
        (UNIT, "unit Bingham", 1.0, 1.0, 0.28125, 0.210938),
    ],
    ids=["herschel-bulkley", "bingham", "unit"],
)
def test_exact_laws_from_rest(validate, fluid, name, height, drive, plug, discharge):
    """The accurate set-up. Its elastic strain, below 2 % at the wall, leaves the steady flow as it is."""
    modulus = 50 * drive * height
    sound = np.sqrt(2 * modulus / fluid.density)
    flow = Channel(fluid, height, drive, sound_speed=sound, shear_modulus=modulus, **scheme())
    viscous = fluid.density * height**2 / fluid.consistency
    flow.run_until_steady(1e-3, interval=0.1 * viscous, at_most=20 * viscous)
    hold_to_the_table(validate, flow, f"{name}, exact yield", plug, discharge)
    z = np.linspace(0, height, 400)
    chart = validate.figure(
        "poiseuille_exact", "Plane Poiseuille flow, exact yield stress", x="u over that of the plug",
        y="distance from the wall over H",
    )  # fmt: skip
    chart.reference(f"exact, {name}", fluid.speed(drive, height, z) / plug, z / height)
    chart.points(f"mpmkit, {name}", flow.speed / plug, flow.z / height)


def shapes_and_orders():
    """In the default run cpGIMP with USL and linear functions with MUSL; cpGIMP with MUSL see below."""
    for shape in names("shape"):
        for order in names("order"):
            again = (shape, order) not in {("cpgimp", "usl"), ("linear", "musl")}
            yield pytest.param(shape, order, marks=pytest.mark.slow if again else ())


@pytest.mark.parametrize(("shape", "order"), list(shapes_and_orders()))
def test_order_of_newtonian_flow(validate, shape, order):
    """USL, whose step is half as long, on two of the three grids."""
    cells, errors = ([5, 10] if order == "usl" else [5, 10, 20]), []
    for n in cells:
        flow = Channel(WATER, 1.0, 1.0, cells=n, shape=shape, order=order)
        flow.run(4.0)  # the slowest mode, exp(-(π/2)² t), is then at 5e-5
        errors.append(flow.error(WATER.speed(1.0, 1.0, flow.z)))
    hold_to_the_order(validate, f"Newtonian, {shape}", cells, errors)


def errors_of_uneven_layers(shape: str) -> tuple[list[int], list[float]]:
    cells, errors = [5, 10, 20], []
    for n in cells:
        flow = Channel(WATER, 1.0, 1.0, cells=n, shape=shape, order="musl")  # whose step is the longest
        flow.space_unevenly(0.3)
        flow.run(4.0)
        errors.append(flow.error(WATER.speed(1.0, 1.0, flow.z)))
    return cells, errors


def test_order_of_newtonian_flow_with_uneven_particles(validate):
    """cpGIMP integrates over boxes that fill the gap, wherever their edges are."""
    cells, errors = errors_of_uneven_layers("cpgimp")
    hold_to_the_order(validate, "Newtonian, cpgimp, uneven particles", cells, errors)


def test_linear_shape_does_not_converge_with_uneven_particles(validate):
    """The whole volume of a point counts in the cell of its position, so that a cell has too much or too
    little.

    This is an error of sampling and does not become smaller with the cells (Steffen, Kirby & Berzins, Int. J.
    Numer. Meth. Eng. 76 (2008) 922-948). For this reason cpGIMP is the default.
    """
    cells, errors = errors_of_uneven_layers("linear")
    assert errors[2] > BAND
    order = observed_order(cells, errors)
    validate("Newtonian, linear, uneven particles: no convergence, observed order", order, below(0.5))
    draw_errors(validate, "Newtonian, linear, uneven particles", cells, errors)


@pytest.mark.parametrize(
    "shape",
    [pytest.param(name, marks=pytest.mark.slow if name == "linear" else ()) for name in names("shape")],
)
def test_order_of_viscoplastic_flow(validate, shape):
    """Against the exact profile of the regularised fluid, so that the error is the grid's alone."""
    cells, errors, m = [5, 10, 20], [], 10.0
    for n in cells:
        flow = Channel(UNIT, 1.0, 1.0, cells=n, m=m, shape=shape, order="musl", fraction=1.0)
        flow.run_until_steady(1e-4, interval=0.1, at_most=10.0)
        errors.append(flow.error(UNIT.regularised_speed(1.0, 1.0, flow.z, m)))
    hold_to_the_order(validate, f"unit Bingham, {shape}", cells, errors)


def test_order_of_exact_viscoplastic_flow(validate):
    """The accurate set-up, where no regularisation stands between the grid and the exact profile."""
    cells, errors = [5, 10, 20], []
    for n in cells:
        flow = Channel(UNIT, 1.0, 1.0, cells=n, sound_speed=10.0, shear_modulus=50.0, **scheme())
        flow.run_until_steady(1e-4, interval=0.1, at_most=20.0)
        errors.append(flow.error(UNIT.speed(1.0, 1.0, flow.z)))
    hold_to_the_order(validate, "unit Bingham, exact yield", cells, errors)


def test_surface_excess_of_the_regularisation(validate):
    """The plug of the regularised fluid is faster by tau0/(G m), for every profile below it."""
    for m in (20.0, 80.0):
        faster = UNIT.regularised_speed(1.0, 1.0, np.array([1.0]), m)[0] - UNIT.plug_speed(1.0, 1.0)
        validate(f"Surface excess tau0/(G m), m = {m:g} s", faster, close_to(0.25 / m, rel=0.1), unit="m/s")
