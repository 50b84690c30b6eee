"""Longest stable step: acoustic dx/c, viscous 0.375 rho dx²/mu, and the influence of surface, axis and update
order.

On the grid alone a step is v ← v - dt A v (viscous) or a leapfrog with A (acoustic), stable for dt < 2/λ and
dt < 2/√λ with λ the largest eigenvalue of A. Two particles along each axis stand at the quarters of a cell.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest
from bands import above, below, close_to
from stability import block, critical_step, free_bar, largest_eigenvalue

pytestmark = pytest.mark.section(5)

# All of density 1 on cells of 1, so that a step is in units of 1/c and 0.375/mu.
OIL = {"law": "newtonian", "density": 1.0, "viscosity": 1.0, "sound_speed": 1e-6}
GAS = {"law": "newtonian", "density": 1.0, "viscosity": 1e-12, "sound_speed": 1.0}
RUBBER = {"law": "neo-hookean", "density": 1.0, "youngs_modulus": 1.0, "poisson_ratio": 0.3}
WAVE = math.sqrt(0.7 / (1.3 * 0.4))  # of the rubber: √((λ + 2 G)/rho)
VISCOUS, ACOUSTIC = 0.375, 1.0
SCENES = {"1-D": ("plane-strain", [2, 1], 8), "2-D": ("plane-strain", [2, 2], 6), "3-D": ("3d", [2, 2, 2], 4)}


def grid_limit(simulation, steepness=1.0) -> float:
    """2/λ or 2/√λ, over what it is inside a full body, of whose λ about ``steepness`` times is expected."""
    law = simulation.particles.groups[0].law
    if law.largest_viscosity(1.0) > 1e-6:
        eigenvalue = largest_eigenvalue(simulation, steepness * 2 / VISCOUS)
        return 2 / eigenvalue / VISCOUS
    speed = simulation.particles.groups[0].wave_speed
    eigenvalue = largest_eigenvalue(simulation, steepness * 4 * speed**2)
    return 2 / math.sqrt(eigenvalue) * speed


@pytest.mark.parametrize("shape", ["linear", "cpgimp"])
@pytest.mark.parametrize("dimension", SCENES)
def test_limits_inside_a_body(validate, dimension, shape):
    """The same in every dimension, since the steepest mode is plane."""
    space, per_cell, cells = SCENES[dimension]
    oil, gas, rubber = (grid_limit(block(space, m, per_cell, cells, shape=shape)) for m in (OIL, GAS, RUBBER))
    validate(f"Viscous limit, {dimension}: mu dt/(rho dx²)", VISCOUS * oil, close_to(VISCOUS, rel=1e-3))
    validate(f"Acoustic limit, {dimension}, fluid: c dt/dx", gas, close_to(ACOUSTIC, rel=1e-3))
    name = f"Acoustic limit, {dimension}, elastic, c² = (λ + 2 G)/rho: c dt/dx"
    validate(name, rubber, close_to(ACOUSTIC, rel=1e-3))


@pytest.mark.parametrize("per_cell", [2, 3])
def test_limits_near_the_axis_are_smaller(validate, per_cell):
    """With radially weighted functions, by less than 1 %."""
    for name, material in (("viscous", OIL), ("acoustic, fluid", GAS), ("acoustic, elastic", RUBBER)):
        found = grid_limit(block("axisymmetric", material, [per_cell, per_cell]))
        validate(f"Limit in a cylinder about its axis, {name}: of that inside", found, below(1.0, "< 1"))
        assert found > 0.99


@pytest.mark.parametrize("filled", [0.1, 0.03, 0.01])
def test_limit_of_a_nearly_empty_node_linear(validate, filled):
    """The limits are 4 ε of the viscous and 2 √ε of the acoustic one, so that no step is short enough for all
    ε.

    The last particle, of volume V, gives a node ε of its mass, ε rho V, but as much force as any other node:
    V σ/dx with σ = 4/3 mu v/dx. So λ = 4 mu/(3 ε rho dx²), or c²/(ε dx²).
    """
    viscous = grid_limit(free_bar(OIL, "linear", filled), 0.25 / filled)
    acoustic = grid_limit(free_bar(GAS, "linear", filled), 0.25 / filled)
    name = f"Limit at a node that has {filled:g} of a particle, linear"
    validate(f"{name}, viscous: of that inside", viscous, close_to(4 * filled, rel=0.1))
    validate(f"{name}, acoustic: of that inside", acoustic, close_to(2 * math.sqrt(filled), rel=0.1))


def test_limit_of_a_nearly_empty_node_cpgimp(validate):
    """With boxes weight and gradient vanish together, N = ε² and 2 ε/dx, so that the limit is bounded.

    In the limit ε → 0, with w = ε v of the empty node, a bar's end has strains v1 - v2 in the last cell's
    inner particle and v1 - v2 + 2 w in its outer one; w and v1 have the mass of one particle, those further
    inside of two.
    """
    n, strains = 12, []
    for cell in range(1, n - 1):
        inner = np.zeros(n)
        inner[cell], inner[cell + 1] = 1.0, -1.0
        outer = inner.copy()
        if cell == 1:
            outer[0] = 2.0
        strains += [inner, outer]
    B = np.array(strains)
    mass = np.full(n, 2.0)
    mass[:2] = 1.0
    largest = np.linalg.eigvalsh(B.T @ B / np.sqrt(np.outer(mass, mass)))[-1]
    viscous = grid_limit(free_bar(OIL, "cpgimp", 1e-3), 2.0)
    name = "Limit at a free surface whose last box pokes a trace into the next cell, cpgimp"
    validate(f"{name}, viscous: of that inside", viscous, close_to(4 / largest, rel=0.01))
    worst = min(grid_limit(free_bar(OIL, "cpgimp", poke), 2.0) for poke in (0.5, 0.4, 0.3, 0.2, 0.1, 0.03))
    validate(
        "Limit at a free surface, cpgimp, wherever the last box ends: the smallest", worst, above(4 / largest)
    )


@pytest.mark.parametrize("per_cell", [8, 16])
def test_limits_at_the_surface_of_thinned_material(validate, per_cell):
    """Boxes of w cells, as material that was thinned has them: 2 w of the viscous limit, √(2 w) of dx/c.

    A box that just reaches over a node by ε gives it N = ε²/(2 w) and ε/(w dx), and so λ = 4/3 mu V (ε/w dx)²
    over rho V ε²/(2 w): 8/3 mu/(rho w dx²), or 2 c²/(w dx²). USL, whose stress follows the grid's velocity,
    has to obey that. To the particles, and so to USF and MUSL, such a node means next to nothing.
    """
    w = 1 / per_cell
    pokes = [part * w for part in (0.01, 0.1, 0.3)]

    def bar(material, poke=pokes[1], **order):
        return free_bar(material, "cpgimp", poke, per_cell, **order)

    name = f"Limit at a free surface, cpgimp, boxes 1/{per_cell} cell thick"
    found = min(grid_limit(bar(OIL, poke), per_cell / 2) for poke in pokes)
    validate(f"{name}, viscous: of that inside", found, close_to(2 * w, rel=0.05))
    found = min(grid_limit(bar(GAS, poke), per_cell / 2) for poke in pokes)
    validate(f"{name}, acoustic: of that inside", found, close_to(math.sqrt(2 * w), rel=0.05))
    for order in ("usl", "usf", "musl"):
        found = critical_step(partial(bar, RUBBER, order=order), ACOUSTIC / WAVE)
        band = below(math.sqrt(2 * w), "no more") if order == "usl" else above(1.0)
        validate(f"{name}, {order.upper()} by trying: of dx/c", found, band)


def expected_limits(order: str, cells: int) -> tuple[float, float]:
    """Viscous and acoustic limit of a whole step with FLIP, over those of the grid alone.

    For the mode of phase k a cell: λ = λ0 s², s = sin(k/2), and F = 1 - 3/4 s² is what mapping it to the
    particles and back leaves. With κ = dt λ and ω² = dt² λ:

    USF and MUSL, whose stress follows the particles' velocity: κ F < 2, ω² F < 4.
    USL, whose stress follows the grid's: κ (2 - F) < 2, ω² (2 - F) < 4.
    """
    s2 = np.sin(np.pi * np.arange(1, cells // 2 + 1) / cells) ** 2
    F = 1 - 0.75 * s2
    steepest = float(np.max(s2 * ((2 - F) if order == "usl" else F)))
    return 1 / steepest, 1 / math.sqrt(steepest)


@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
def test_limits_of_the_orders(validate, order):
    """By trying: random velocities of a periodic bar, 600 steps, and whether they grow."""
    viscous, acoustic = expected_limits(order, 8)

    def bar(material):
        return lambda: block("plane-strain", material, [2, 1], order=order, shape="linear")

    name = f"{order.upper()} with FLIP, two particles a cell, by trying"
    found = critical_step(bar(OIL), VISCOUS)
    validate(f"{name}: viscous limit over that of the grid", found, close_to(viscous, rel=0.03))
    found = critical_step(bar(RUBBER), ACOUSTIC / WAVE)
    validate(f"{name}: acoustic limit over dx/c", found, close_to(acoustic, rel=0.03))
