"""Closed forms of the shipped laboratory tests; docs and validation compare runs with them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from .deposits import (
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
from .funnels import SLICES, Sections, circles, flow, flow_time, rectangles
from .rotation import coaxial_torque, cylinder_torque
from .tubes import tube_gradient

G = 9.81
SQRT3 = math.sqrt(3)
Given = Mapping[str, float]
"""Parameters of a case, by name, in SI units."""


@dataclass(frozen=True)
class Formula:
    """A closed form of a measurement of a case.

    Args:
        measured: name of the measurement, or of a variable of the history.
        words: the name of the formula.
        value: its value for the parameters of the case.
        band: largest relative difference of a run; None if the formula neglects too much for a comparison.
    """

    measured: str
    words: str
    value: Callable[[Given], float]
    band: float | None


def sink(p: Given) -> float:
    """τ0/(ρ g), m."""
    return p["yield_stress"] / (p["density"] * G)


def _cone(p: Given, stretching: float) -> float:
    return cone_spread(_cone_volume(p), sink(p), stretching)


def _cone_volume(p: Given) -> float:
    bottom, top = p["bottom_radius"], p["top_radius"]
    return math.pi * p["mould_height"] / 3 * (bottom**2 + bottom * top + top**2)


def _flow_table(p: Given) -> float:
    bottom, top = p["bottom_radius"], p["top_radius"]
    centre = (bottom**2 + 2 * bottom * top + 3 * top**2) / (4 * (bottom**2 + bottom * top + top**2))
    fallen = p["drops"] * p["drop_height"]
    return drop_spread(_cone_volume(p), sink(p), centre * p["mould_height"], fallen)


def _channel(p: Given, stretching: float) -> float:
    volume = p["reservoir_length"] * p["channel_width"] * p["reservoir_height"]
    return channel_length(volume, sink(p), p["channel_width"], stretching)


def _slope(p: Given, stretching: float) -> float:
    area, angle = p["column_length"] * p["column_height"], math.radians(p["inclination"])
    return slope_length(area, sink(p), angle, stretching)


def _ratio(p: Given, stretching: float) -> float:
    area = p["column_width"] * p["column_height"]
    back, end = box_depths(area, p["channel_length"], sink(p), stretching=stretching)
    return end / back


def _ratio_behind_bars(p: Given) -> float:
    step = bar_step(p["bar_diameter"], p["box_width"] / p["bars"], sink(p))
    area = p["column_width"] * p["column_height"]
    back, end = box_depths(
        area, p["channel_length"], sink(p), stretching=PLANE, step=step, bars=p["bar_place"]
    )
    return end / back


def _ring(p: Given) -> tuple[float, Callable[[float], float]]:
    interval = 2 * math.pi * p["ring_radius"] / (4 * p["bars_in_quarter"])
    step = bar_step(p["bar_diameter"], interval, sink(p))
    return ring_spread(_cone_volume(p), sink(p), BIAXIAL, p["ring_radius"], step)


def _ring_step(p: Given) -> float:
    _, depth = _ring(p)
    return depth(0.0) - depth(p["outside"])


def _cone_slump(p: Given, uniaxial: float) -> float:
    """Slump, m, of a cone whose base is twice as wide as its top.

    Schowalter & Christensen 1998, J. Rheol. 42: s/H = 1 - h0 - 2τ' ln(7/((1 + h0)³ - 1)); above h0 H the
    material has not yielded, τ' = τ0/(ρ g H) = ((1 + h0) - (1 + h0)⁻²)/6.

    Args:
        p: parameters.
        uniaxial: σ/τ0 at which a column yields under its weight. The authors use 2, Tresca's criterion. The
            laws here use von Mises' criterion, which gives √3, so that τ' becomes √3/2 τ'.
    """
    relative = uniaxial / 2 * sink(p) / p["mould_height"]
    low, high = 0.0, 1.0
    for _ in range(60):
        h0 = (low + high) / 2
        low, high = (low, h0) if (1 + h0 - (1 + h0) ** -2) / 6 > relative else (h0, high)
    slump = 1 - h0 - 2 * relative * math.log(7 / ((1 + h0) ** 3 - 1))
    return max(slump, 0.0) * p["mould_height"]


def _cylinder_slump(p: Given) -> float:
    relative = sink(p) / p["mould_height"]
    return max(1 - 2 * relative * (1 - math.log(2 * relative)), 0.0) if relative < 0.5 else 0.0


def _film_speed(p: Given) -> float:
    weight = p["density"] * G
    above = max(weight * p["thickness"] - p["yield_stress"], 0.0)
    return above**2 / (2 * p["plastic_viscosity"] * weight)


def _friction(p: Given) -> tuple[float, float]:
    """Force of friction on the plates, N, at the end of the squeeze, and radius of the disc then, m."""
    gap = p["gap"] - p["squeeze"]
    radius = p["radius"] * math.sqrt(p["gap"] / gap)
    return 2 * math.pi * p["yield_stress"] * radius**3 / (3 * gap), radius


def _squeeze(p: Given) -> float:
    friction, radius = _friction(p)
    return friction + math.sqrt(3) * math.pi * p["yield_stress"] * radius**2


def _v_funnel(p: Given) -> float:
    outlet, top, depth = p["outlet_width"], p["top_width"], p["depth"]
    slanted, straight = p["funnel_height"], p["outlet_height"]

    def sections(z: np.ndarray) -> Sections:
        return rectangles(np.interp(z, [straight, straight + slanted], [outlet, top]), depth)

    volume = p["emptied_part"] * depth * (outlet * straight + (outlet + top) / 2 * slanted)
    return flow_time(straight + slanted, volume, sections, *_fluid(p))


def _marsh_cone(p: Given) -> float:
    """Flow out of the full cone, m³/s."""
    outlet, top, straight = p["nozzle_radius"], p["top_radius"], p["nozzle_length"]
    head = straight + p["cone_height"]
    heights = (np.arange(SLICES) + 0.5) * head / SLICES
    sections = circles(np.interp(heights, [straight, head], [outlet, top]))
    return flow(head, head / SLICES, sections, _fluid(p))


def _fluid(p: Given) -> tuple[float, float, float]:
    return p["density"], p["yield_stress"], p["plastic_viscosity"]


def _coaxial(p: Given) -> float:
    _, *fluid = _fluid(p)
    radii = p["inner_radius"], p["outer_radius"], p["cylinder_height"]
    return coaxial_torque(*radii, 2 * math.pi * p["turns_per_second"], *fluid)


def _vane(p: Given, turns: float) -> float:
    return cylinder_torque(
        p["vane_radius"], p["vane_height"], 2 * math.pi * turns, p["yield_stress"], p["plastic_viscosity"]
    )


def _turning_vane(p: Given) -> float:
    return _vane(p, p["turns_per_second"])


def _filling(p: Given) -> float:
    return p["mass"] / (p["density"] * math.pi * p["form_radius"] ** 2)


def _filament(p: Given) -> float:
    nozzle = math.pi / 4 * p["nozzle_diameter"] ** 2
    return p["layers"] * nozzle * p["extrusion_speed"] / p["nozzle_speed"]


def _tube(p: Given) -> float:
    return tube_gradient(p["tube_radius"], p["mean_speed"], p["yield_stress"], p["plastic_viscosity"])


STRETCHED = "thin layer at rest, lubrication and stretching"
THIN = "thin layer at rest, lubrication alone"


def _layer(measured: str, of: Callable[[Given, float], float], c: float, band: float) -> list[Formula]:
    return [
        Formula(measured, STRETCHED, lambda p: of(p, c), band),
        Formula(measured, THIN, lambda p: of(p, 0.0), None),
    ]


FORMULAS: dict[str, list[Formula]] = {
    "slump_test": [
        Formula("slump_of_highest_point", "slices that yield at √3 τ0", lambda p: _cone_slump(p, SQRT3), 0.1),
        Formula("slump_of_highest_point", "slices that yield at 2 τ0, Schowalter & Christensen 1998",
                lambda p: _cone_slump(p, 2.0), None),
        Formula("slump_of_highest_point", "a fit, Roussel 2006: 255 mm - 176 mm · τ0/ρ (in Pa m³/kg)",
                lambda p: 0.255 - 0.176 * p["yield_stress"] / p["density"], None),
    ],
    "slump_flow": _layer("slump_flow", _cone, BIAXIAL, 0.08),
    "mini_cone_kantro": _layer("spread", _cone, BIAXIAL, 0.05),
    "mini_cone_haegermann": _layer("spread", _cone, BIAXIAL, 0.05),
    "cylinder_slump": [
        Formula("relative_slump", "slices, Pashias et al. 1996: 1 - 2τ' (1 - ln 2τ')", _cylinder_slump, 0.05)
    ],
    "l_box": _layer("passing_ratio", _ratio, PLANE, 0.1),
    "l_box_bars": [
        Formula("passing_ratio", f"{STRETCHED}, with a step at the bars", _ratio_behind_bars, 0.1),
        Formula("passing_ratio", "the same without bars", lambda p: _ratio(p, PLANE), None),
    ],
    "j_ring": [
        Formula("j_ring_flow", f"{STRETCHED}, with a step at the bars", lambda p: _ring(p)[0], 0.08),
        Formula("blocking_step", "the same: the middle above the outside", _ring_step, None),
        Formula("j_ring_flow", "the same without a ring", lambda p: _cone(p, BIAXIAL), None),
    ],
    "lcpc_box": _layer("flow_length", _channel, PLANE, 0.05),
    "bostwick": _layer("reading", lambda p, c: _channel(p, c) - p["reservoir_length"], PLANE, 0.08),
    "slope": _layer("front", _slope, PLANE, 0.1),
    "sagging_film": [
        Formula("surface_speed", "a Bingham film, (ρgH - τ0)²/(2 μ ρ g)", _film_speed, 0.05)
    ],
    "squeeze_flow": [
        Formula("plate_force", "friction and stretching, 2π τ0 R³/(3h) + √3 π τ0 R²", _squeeze, 0.1),
        Formula("plate_force", "friction on the plates, 2π τ0 R³/(3h)", lambda p: _friction(p)[0], None),
    ],
    "flow_table": [
        Formula("flow_value", "at most: the yield stress takes all energy of the drops", _flow_table, None)
    ],
    "marsh_cone": [
        Formula("outflow_rate", "full cone, Buckingham & Reiner, with a kinetic head", _marsh_cone, 0.12)
    ],
    "v_funnel": [
        Formula("flow_time", "lubrication in rectangular sections, Kozicki et al. 1966, with a kinetic head",
                _v_funnel, None)
    ],
    "pour_into_form": [
        Formula("mean_depth", "the volume that is poured over the area of the form, exact", _filling, 0.02)
    ],
    "printed_filament": [
        Formula("cross_section", "what is pushed out, (π D²/4) U/V for each layer, exact", _filament, 0.02)
    ],
    "tube_extrusion": [Formula("pressure_gradient", "Buckingham & Reiner, exact", _tube, 0.03)],
    "coaxial_cylinders": [Formula("torque_of_cylinder", "Reiner & Riwlin, exact", _coaxial, 0.03)],
    "vane": [
        Formula("torque_of_vane", "a cylinder that turns, Reiner & Riwlin", _turning_vane, 0.05),
        Formula("torque_of_vane", "start of flow, 2π R² h τ0", lambda p: _vane(p, 1e-12), None),
    ],
}  # fmt: skip
"""By the name of the case; the first formula of each case is the most accurate."""
