"""Time in which a Bingham fluid flows out of a funnel under its own weight.

The flow is slow, and every section carries what leaves: lubrication. A section of area A and perimeter P that
carries the flow Q with the wall stress τ_w has the pressure gradient G = τ_w P/A, and (Kozicki, Chou & Tiu
1966, Chem. Eng. Sci. 21)

    2 Q P/A² = 1/(μ a) [τ_w/(n + 1) - τ0/n + τ0 (τ0/τ_w)^n/(n (n + 1))],    n = b/a        (1)

with a and b of the form of the section: 1/4 and 3/4 for a circle, for which (1) is Buckingham & Reiner's law.
The weight of the column holds both the friction and the kinetic head of the jet,

    ρ g h = ∫ G(Q, z) dz + ρ (Q/A_0)²                                                      (2)

The factor of the kinetic head is α/2 with α = 2, that of a parabola in a pipe; a plug has 1. (2) leaves out
what it takes to stretch the fluid where the funnel narrows.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

G = 9.81
SLICES = 150
"""Of the funnel, in height."""
LEVELS = 40
"""Levels of the surface at which the flow is found."""
ROUNDS = 35
NEWTON = 30
SAME = 1e-9
Sections = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""Area, m², perimeter, m, and a and b of (1), each at every height."""


def circles(radius: np.ndarray) -> Sections:
    """Round sections of the radius R, m."""
    same = np.ones_like(radius)
    return np.pi * radius**2, 2 * np.pi * radius, same / 4, 3 * same / 4


def rectangles(width: np.ndarray, depth: float) -> Sections:
    """Sections with sides of ``width`` and ``depth``, m; a and a + b as in the paper, with the fit of
    Shah & London 1978 for the friction of a Newtonian fluid, 16 (a + b)."""
    ratio = np.minimum(width, depth) / np.maximum(width, depth)
    n = (2 * np.arange(8)[:, None] + 1) * np.pi / 2
    series = ((-1.0) ** np.arange(1, 9)[:, None] / (n**3 * np.cosh(np.minimum(n / ratio, 700)))).sum(axis=0)
    a = 1 / (2 * (1 + ratio) ** 2 * (1 + 4 * series))
    friction = 24 * np.polyval([-0.2537, 0.9564, -1.7012, 1.9467, -1.3553, 1], ratio)
    return width * depth, 2 * (width + depth), a, friction / 16 - a


def flow(head: float, step: float, sections: Sections, fluid: tuple[float, float, float]) -> float:
    """Q, m³/s, of (2), for a column of the height ``head``, m, in sections ``step``, m, apart."""
    density, yield_stress, viscosity = fluid
    area, perimeter, a, b = sections
    weight, n, stress = density * G * head, b / a, max(yield_stress, 1e-9)

    def held(q: float) -> float:
        s = viscosity * a * 2 * q * perimeter / area**2 / stress
        x = (n + 1) * (s + 1 / n)  # τ_w/τ0, from above
        for _ in range(NEWTON):
            power = x**-n
            f = x / (n + 1) - 1 / n + power / (n * (n + 1)) - s
            before, x = x, np.maximum(x - f * (n + 1) / np.maximum(1 - power / x, 1e-9), 1.0)
            if (before - x < SAME * x).all():
                break
        return float((stress * x * perimeter / area).sum() * step) + density * (q / area[0]) ** 2

    low, high = 0.0, float(area[0]) * math.sqrt(G * head)
    for _ in range(ROUNDS):
        q = (low + high) / 2
        low, high = (low, q) if held(q) > weight else (q, high)
    return low


def flow_time(
    top: float,
    volume: float,
    sections: Callable[[np.ndarray], Sections],
    density: float,
    yield_stress: float,
    viscosity: float,
) -> float:
    """Time, s, in which a volume flows out of a funnel; infinite if it stops flowing before.

    Args:
        top: height of the surface above the outlet at the start, m.
        volume: m³.
        sections: of the funnel at heights above its outlet, m.
        density, yield_stress, viscosity: ρ, τ0 and μ.
    """
    step = top / SLICES
    heights = (np.arange(SLICES) + 0.5) * step
    area, *_ = every = sections(heights)
    out = np.concatenate([[0.0], np.cumsum(area[::-1]) * step])  # by the surface at the upper end of a slice
    surface = top - step * np.arange(SLICES + 1)
    if volume > out[-1]:
        raise ValueError(f"the volume is {volume:g} m³, but the funnel holds only {out[-1]:g} m³")
    gone = (np.arange(LEVELS) + 0.5) * volume / LEVELS
    total = 0.0
    for level in np.interp(gone, out, surface):
        full = max(1, round(level / step))
        part: Sections = tuple(values[:full] for values in every)  # type: ignore[assignment]
        q = flow(level, level / full, part, (density, yield_stress, viscosity))
        if q <= 0:
            return math.inf
        total += volume / LEVELS / q
    return total
