"""The accurate set-up: the one place that says which schemes and laws the viscoplastic rows use.

Yield by return mapping, so that the material truly arrests and no viscous limit binds the step; volumetric
rate and pressure averaged through the grid, so that nothing locks; an affine velocity update, whose damping
is physical; places, boxes and volumes kept even (the default), so that material may be sheared for long.
"""

from __future__ import annotations

from typing import Any

SCHEME: dict[str, Any] = {
    "shape": "cpgimp",
    "order": "usl",
    "velocity": "apic",
    "volumetric": "nodal-average",
    "time_step": {"fraction": 0.4},
}
PAPER: dict[str, Any] = {
    "shape": {"name": "cpgimp", "domain": "fixed"},
    "order": "usl",
    "velocity": "flip",
    "volumetric": "own",
    "redistribution": "none",
}
"""The set-up of Ferreira et al.: to every particle its own pressure, and a box that stays as it was."""


def bingham(yield_stress: float, plastic_viscosity: float, **more: Any) -> dict[str, Any]:
    """Material of an exact Bingham plastic, as a case file writes it."""
    return {
        "law": "bingham-evp", "yield_stress": yield_stress, "plastic_viscosity": plastic_viscosity, **more,
    }  # fmt: skip


def herschel_bulkley(
    yield_stress: float, consistency: float, flow_index: float, **more: Any
) -> dict[str, Any]:
    """Material of an exact Herschel–Bulkley fluid."""
    flow = {"yield_stress": yield_stress, "consistency": consistency, "flow_index": flow_index}
    return {"law": "herschel-bulkley-evp", **flow, **more}


def stiff(density: float, speed: float) -> dict[str, float]:
    """Sound speed and shear modulus of a material whose waves are all this fast, m/s."""
    return {"sound_speed": speed, "shear_modulus": 0.5 * density * speed**2}


def scheme(**changes: Any) -> dict[str, Any]:
    """The accurate scheme with some keys changed."""
    return {**SCHEME, **changes}
