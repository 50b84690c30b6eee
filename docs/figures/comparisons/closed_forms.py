"""Closed forms of the slump test, that the comparisons draw beside the simulations.

SI units, unless a name says otherwise. Slump, spread and times are those of the ASTM C143 cone by default.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

GRAVITY = 9.81
BOTTOM, TOP, HEIGHT = 0.1, 0.05, 0.3
"""Radii and height of the cone."""
VOLUME = math.pi * HEIGHT * (BOTTOM**2 + BOTTOM * TOP + TOP**2) / 3
TRESCA, MISES = 2.0, math.sqrt(3.0)
"""Vertical stress, over the yield stress in shear, at which a column without support at its sides yields."""


def slump_of_layers(yield_stress: ArrayLike, density: float, criterion: float = TRESCA) -> np.ndarray:
    """Murata (1984), corrected by Schowalter & Christensen (1998): every layer squeezed by the weight on it.

    Down to a depth h0 nothing yields. A layer below is squeezed until the weight above is carried by an area
    on which it no longer yields. Nothing holds it at its sides or underneath. Theirs is Tresca's criterion.
    """
    number = np.asarray(yield_stress, dtype=float) / (density * GRAVITY * HEIGHT)
    apex = TOP / (BOTTOM - TOP)  # depth of the top below the cone's apex, over its height
    # Stress in shear at depth z: (y - apex³/y²) / (3 criterion), with y = apex + z.
    y = np.array([_positive_root(3 * criterion * n, apex) for n in np.atleast_1d(number)])
    depth = np.minimum(y - apex, 1.0).reshape(number.shape)
    thinned = criterion * number * np.log(((1 + apex) ** 3 - apex**3) / ((depth + apex) ** 3 - apex**3))
    return HEIGHT * (1 - depth - thinned)


def _positive_root(a: float, apex: float) -> float:
    """The one positive y with y³ - a y² = apex³."""
    roots = np.roots([1.0, -a, 0.0, -(apex**3)])
    return float(roots[np.argmax(roots.real)].real)


def slump_of_cylinder(
    yield_stress: ArrayLike, density: float, height: float, criterion: float = TRESCA
) -> np.ndarray:
    """The same for a cylinder, of any radius: Pashias, Boger, Summers & Glenister (1996)."""
    depth = np.minimum(criterion * np.asarray(yield_stress, dtype=float) / (density * GRAVITY * height), 1.0)
    return height * (1 - depth * (1 - np.log(depth)))


def slump_tall(yield_stress: ArrayLike, density: float) -> np.ndarray:
    """Roussel & Coussot (2005), much higher than wide: what is left weighs √3 tau0 on its base."""
    return HEIGHT - MISES * np.asarray(yield_stress, dtype=float) / (density * GRAVITY)


def slump_of_roussel(yield_stress: ArrayLike, density: float) -> np.ndarray:
    """Roussel (2006), a line through simulations on a stick floor: 25.5 cm - 17.6 tau0/rho."""
    return 0.255 - 0.176 * np.asarray(yield_stress, dtype=float) / density


def spread_stick(yield_stress: ArrayLike, density: float) -> np.ndarray:
    """Spread diameter after Roussel & Coussot (2005): a thin sheet on a stick floor, without inertia.

    rho g h h' = -tau0, so that h = √(2 tau0 (R - r)/(rho g)), and its volume is the cone's.
    """
    weight = density * GRAVITY
    return 2 * (225 * weight * VOLUME**2 / (128 * math.pi**2 * np.asarray(yield_stress, dtype=float))) ** 0.2


def height_stick(yield_stress: ArrayLike, density: float) -> np.ndarray:
    """Height of that sheet on its axis."""
    radius = spread_stick(yield_stress, density) / 2
    return np.sqrt(2 * np.asarray(yield_stress, dtype=float) * radius / (density * GRAVITY))


def height_slip(yield_stress: ArrayLike, density: float) -> np.ndarray:
    """Height of a uniform sheet at rest on a slip floor: √3 tau0 H = rho g H²/2."""
    return 2 * MISES * np.asarray(yield_stress, dtype=float) / (density * GRAVITY)


def spread_slip(yield_stress: ArrayLike, density: float) -> np.ndarray:
    """Spread diameter of that sheet."""
    return 2 * np.sqrt(VOLUME / (math.pi * height_slip(yield_stress, density)))


def t500_slip(viscosity: ArrayLike, yield_stress: float, density: float) -> np.ndarray:
    """Time in which a uniform Bingham sheet thins to a spread of 500 mm on a slip floor, without inertia.

    √3 (tau0 + mu 2√3 e) H = rho g H²/2 and dH/dt = -2 e H, from the cone's height on.
    """
    rest, end = float(height_slip(yield_stress, density)), VOLUME / (math.pi * 0.25**2)
    if end <= rest:
        return np.full(np.shape(viscosity), np.inf)
    # d(1/H) integrated; log1p, so that a yield stress of nothing has its limit.
    reached = math.log1p(-rest / HEIGHT) - math.log1p(-rest / end) if rest > 0 else 0.0
    thinned = reached / rest if rest > 0 else 1 / end - 1 / HEIGHT
    return 6 * np.asarray(viscosity, dtype=float) / (density * GRAVITY) * thinned


def t500_stick(viscosity: ArrayLike, density: float) -> np.ndarray:
    """Huppert (1982): a Newtonian sheet on a stick floor, R = 0.894 (rho g V³ t / (3 mu))^(1/8)."""
    pace = density * GRAVITY * VOLUME**3 / (3 * np.asarray(viscosity, dtype=float))
    return (0.25 / 0.894) ** 8 / pace


def t500_of_sedran(viscosity: ArrayLike, spread: ArrayLike, density: float) -> np.ndarray:
    """Sedran & de Larrard (1999), from measurements: mu = rho g / 10000 (0.026 SF - 2.39) T500, SF in mm."""
    per_second = density * GRAVITY / 1e4 * (0.026 * 1e3 * np.asarray(spread, dtype=float) - 2.39)
    return np.asarray(viscosity, dtype=float) / per_second


def spread_of_sedran(yield_stress: ArrayLike, density: float) -> np.ndarray:
    """Sedran & de Larrard (1999): tau0 = rho g / 11740 (808 - SF), SF in mm."""
    return 1e-3 * (808 - 11740 * np.asarray(yield_stress, dtype=float) / (density * GRAVITY))
