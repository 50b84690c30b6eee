"""Shapes of a yield-stress fluid at rest after a slow flow in a thin layer on a floor without slip.

With s = τ0/(ρ g), lubrication theory gives the balance of a slice of depth h:

    h dh/dx = -s                                                    (1)

The next order includes that the flow also stretches the layer, which is at yield everywhere. The shear
stress falls linearly from τ0 at the floor to 0 at the surface. The rest of the yield stress acts along the
flow, and pulls each section back with a force of c s/2 times ρ g h:

    h² - c s h = 2 s (R - r),    ending at the front with the depth c s   (2)

c is π for a layer that spreads along x only (plane strain), and √3 π/2 for one that spreads equally in all
directions. A spreading cone is between the two. Dubash, Balmforth, Slim & Cochard 2009, J. Non-Newtonian
Fluid Mech. 158, derive such a correction. Equation (1) has c = 0; its deposit is too long, by terms of the
order of depth over length.

Bars that stand in the layer hold it back, too. A rough bar of the diameter d across which a plastic material
flows in its plane takes B τ0 d for each metre of its length, B = 4√2 + 2π (Randolph & Houlsby 1984,
Géotechnique 34, exact far from other bars). The shear stress of the floor leaves the rest of the yield
stress for this, √(τ0² - τ²), of which the mean over the depth is π/4 τ0, as in c. So bars at intervals of p
give the layer a step

    h_before - h_behind = π/4 B (d/p) s                             (3)
"""

from __future__ import annotations

import math
from collections.abc import Callable

PLANE = math.pi
"""c of a layer that spreads along one direction."""
BIAXIAL = math.sqrt(3) * math.pi / 2
"""c of a layer that spreads equally along both directions."""
BAR = 4 * math.sqrt(2) + 2 * math.pi
"""B of equation (3)."""
STEPS = 2000
ROUNDS = 3
"""Iterations for the force of the ends of a closed channel; it hardly changes with the depths."""


def cone_spread(volume: float, sink: float, stretching: float = 0.0) -> float:
    """Diameter, m, of the round deposit of a volume, m³.

    For c = 0: R = (225 V² s⁻¹/(128 π²))^(1/5), Roussel & Coussot 2005, J. Rheol. 49.

    Args:
        volume: m³.
        sink: s, m.
        stretching: c of equation (2).
    """

    def found(top: float) -> tuple[float, float]:
        radius = _behind(top, sink, stretching)
        return radius, _integral(
            lambda h: 2 * math.pi * (radius - _behind(h, sink, stretching)) * h * _slope(h, sink, stretching),
            stretching * sink,
            top,
        )

    return 2 * _solve(found, volume, sink, stretching)


def channel_length(volume: float, sink: float, width: float = math.inf, stretching: float = 0.0) -> float:
    """Length, m, of the deposit of a volume that was poured at the end wall of a channel without slip.

    The side walls resist with τ0, as the floor does: s becomes s (1 + 2h/b). With c = 0 this is the
    balance of the LCPC box (Roussel 2007, Cem. Concr. Res. 37).

    Args:
        volume: m³, or m² for a channel without side walls.
        sink: s, m.
        width: b, m; if it is infinite, the volume is that of a slice of 1 m.
        stretching: c of equation (2).
    """
    across = 1.0 if math.isinf(width) else width

    def found(top: float) -> tuple[float, float]:
        def slope(h: float) -> float:
            return _slope(h, sink, stretching) / (1 + 2 * h / width)

        start = stretching * sink
        return _integral(slope, start, top), across * _integral(lambda h: h * slope(h), start, top)

    return _solve(found, volume, sink, stretching)


def bar_step(diameter: float, interval: float, sink: float) -> float:
    """How much deeper, m, the layer is before a row of bars than behind it, by equation (3).

    Args:
        diameter: d, m.
        interval: p, m, from bar to bar.
        sink: s, m.
    """
    return math.pi / 4 * BAR * diameter / interval * sink


def ring_spread(
    volume: float, sink: float, stretching: float, ring: float, step: float
) -> tuple[float, Callable[[float], float]]:
    """Diameter, m, of the round deposit of a volume that has flowed through a ring of bars, and its depth, m,
    as a function of the distance from the axis, m.

    Equation (2) holds outside and inside of the ring; at the ring the depth changes by the step of the bars.
    A deposit that does not reach the ring is that of ``cone_spread``.

    Args:
        volume: m³.
        sink: s, m.
        stretching: c.
        ring: radius of the ring, m.
        step: of ``bar_step``, m.
    """

    def behind(start: float, way: float) -> float:
        """Depth at a distance behind a place of the depth ``start``."""
        half = stretching * sink / 2
        return half + math.sqrt((start - half) ** 2 + 2 * sink * way)

    def depth(radius: float, end: float) -> float:
        if radius >= end:
            return 0.0
        front = stretching * sink
        if radius >= ring or end <= ring:
            return behind(front, end - radius)
        return behind(behind(front, end - ring) + step, ring - radius)

    def held(end: float) -> float:
        return _integral(lambda r: 2 * math.pi * r * depth(r, end), 0.0, end)

    high = ring
    while held(high) < volume:
        high *= 2
    end = _bisect(lambda end: held(end) - volume, 0.0, high)
    return 2 * end, lambda radius: depth(radius, end)


def box_depths(
    area: float,
    length: float,
    sink: float,
    width: float = math.inf,
    stretching: float = 0.0,
    step: float = 0.0,
    bars: float = 0.0,
) -> tuple[float, float]:
    """Depths, m, at the back and at the end of a closed channel that material has filled to its end.

    The layer is stretched at the back wall and compressed at the end wall, so that c changes its sign
    between them. Over the whole channel this adds a force of c τ0 (h1 + h2)/2 to the friction τ0 L. Here
    this force is distributed evenly over the length: s becomes s (1 + c (h1 + h2)/(2 L)).

    Args:
        area: m², volume over the width of the channel.
        length: m, of the channel.
        sink, width: as of ``channel_length``.
        stretching: c of the two ends.
        step: of the depth at a row of bars, as of ``bar_step``, m.
        bars: distance of the bars from the back wall, m.
    """

    def depths(end: float, s: float) -> tuple[float, float]:
        """Depth at the back, and area, for a depth at the end: h dh/dx = -s (1 + 2h/b), second order."""
        h, dx, filled = end, length / STEPS, 0.0
        at_bars = round((length - bars) / dx)
        for k in range(STEPS):
            if k == at_bars:
                h += step
            middle = h + dx / 2 * s * (1 + 2 * h / width) / h
            following = h + dx * s * (1 + 2 * middle / width) / middle
            filled += (h + following) / 2 * dx
            h = following
        return h, filled

    back = end = area / length
    for _ in range(ROUNDS):
        s = sink * (1 + stretching * (back + end) / (2 * length))
        end = _bisect(lambda h, s=s: depths(h, s)[1] - area, 1e-2 * area / length, area / length)  # type: ignore[misc]
        back = depths(end, s)[0]
    return back, end


def drop_spread(volume: float, sink: float, centre: float, fallen: float) -> float:
    """Diameter, m, of a cylinder into which drops of a table flatten a body without viscosity.

    Each drop gives the body the energy ρ g V for each metre of its height. As the height H of a cylinder of
    the volume V = π R² H falls by dH, its stretching takes √3 τ0 π R² dH, and the floor, on which it slides
    with r |dH|/(2H) under τ0, π τ0 R³ dH/(3H). With H0 = 2 ``centre`` at first,

        fallen + centre - H/2 = s [√3 ln(H0/H) + 2/9 √(V/π) (H^(-3/2) - H0^(-3/2))]

    Viscosity takes a part of the energy, and so does the elastic rebound: a body spreads less.

    Args:
        volume: V, m³.
        sink: s = τ0/(ρ g), m.
        centre: height of the centre of mass at first, m.
        fallen: sum of the heights of all drops, m.
    """
    first = 2 * centre

    def left(height: float) -> float:
        """Energy that is left, over ρ g V, m; it falls with the height."""
        stretched = math.sqrt(3) * math.log(first / height)
        slid = 2 / 9 * math.sqrt(volume / math.pi) * (height**-1.5 - first**-1.5)
        return fallen + centre - height / 2 - sink * (stretched + slid)

    height = _bisect(left, 1e-3 * first, first)
    return 2 * math.sqrt(volume / (math.pi * height))


def slope_length(area: float, sink: float, angle: float, stretching: float = 0.0) -> float:
    """Length, m, of the plane deposit on a slope below a wall at its upper end.

    dh/dx = (sin θ - s/h)/(cos θ - c s/(2h)), equation (2) with the weight along the slope; with c = 0 the
    front is x tan θ = -h - h_c ln(1 - h/h_c), h_c = s/sin θ (Coussot, Proust & Ancey 1996).

    Args:
        area: m².
        sink: s, m.
        angle: θ, rad.
        stretching: c.
    """
    critical = sink / math.sin(angle)

    def found(top: float) -> tuple[float, float]:
        def slope(h: float) -> float:
            return (h * math.cos(angle) - stretching * sink / 2) / (sink - h * math.sin(angle))

        start = min(stretching * sink / math.cos(angle), 0.999 * critical)
        return _integral(slope, start, top), _integral(lambda h: h * slope(h), start, top)

    high = critical * (1 - 1e-9)
    if found(high)[1] < area:
        raise ValueError("the volume is larger than the largest that can rest on the slope")
    top = _bisect(lambda h: found(h)[1] - area, 1e-6 * critical, high)
    return found(top)[0]


def _behind(h: float, sink: float, c: float) -> float:
    """Distance behind the front, m, at which the depth is h."""
    return (h * h - c * sink * h) / (2 * sink)


def _slope(h: float, sink: float, c: float) -> float:
    """-dr/dh."""
    return (2 * h - c * sink) / (2 * sink)


def _integral(f: Callable[[float], float], low: float, high: float) -> float:
    step = (high - low) / STEPS
    return step * sum(f(low + (k + 0.5) * step) for k in range(STEPS))


def _solve(found: Callable[[float], tuple[float, float]], volume: float, sink: float, c: float) -> float:
    """The length of the deposit of a volume; ``found`` gives both for the depth at its top."""
    low, high = c * sink * (1 + 1e-9) + 1e-12, 1.0
    while found(high)[1] < volume:
        high *= 2
    return found(_bisect(lambda top: found(top)[1] - volume, low, high))[0]


def _bisect(f: Callable[[float], float], low: float, high: float) -> float:
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if f(middle) > 0 else (middle, high)
    return (low + high) / 2
