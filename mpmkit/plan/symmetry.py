"""Symmetry of a scene: whether a quarter of it, or a half plane, is enough."""

from __future__ import annotations

from typing import Any

from ..case.model import Case
from .symmetric_walls import are_mirrored

SIDES = ("x_min", "x_max", "y_min", "y_max")


def axis_of_revolution(case: Case) -> tuple[float, float] | None:
    """Position of the vertical axis about which a 3-D scene is axisymmetric, walls and motion included; None
    if it is not, or is not a 3-D scene."""
    axis = _common_middle(case)
    if axis is None or not all(body.shape.turned for body in case.bodies):
        return None
    for side in SIDES:
        face = case.grid.faces.get(side, "open")
        through_the_axis = side.endswith("_min") and _end(case, side) == axis["xy".index(side[0])]
        if face != "open" and not (face in ("symmetry", "slip") and through_the_axis):
            return None
    return axis


def planes_of_symmetry(case: Case) -> tuple[float, float] | None:
    """Position of planes x = const and y = const that cut a 3-D scene into four equal quarters; else None."""
    middle = _common_middle(case)
    if middle is None:
        return None
    for axis, place in zip("xy", middle, strict=True):
        low, high = (case.grid.faces.get(f"{axis}_{end}", "open") for end in ("min", "max"))
        if low != high or low in ("periodic", "symmetry"):
            return None
        (lower, upper), apart = case.grid.domain[axis], case.grid.cell_size
        if not lower < place < upper or (low != "open" and abs(lower + upper - 2 * place) > 1e-9 * apart):
            return None
    return middle if are_mirrored(case, middle) else None


def _common_middle(case: Case) -> tuple[float, float] | None:
    """Where the vertical planes of symmetry of all bodies and of their motion meet."""
    pulled = any(case.gravity_vector[:2]) or case.varying_forces
    if case.space != "3d" or pulled or case.sinks or case.sources:
        return None
    middles = {
        body.shape.middle(case.space_) if _falls(body.velocity) and not body.initial else None
        for body in case.bodies
    }
    return middles.pop() if len(middles) == 1 else None


def _falls(velocity: Any) -> bool:
    """Whether an initial velocity has no horizontal part."""
    return velocity is None or (isinstance(velocity, list) and not any(velocity[:2]))


def _end(case: Case, side: str) -> float:
    axis, end = side.split("_")
    return case.grid.domain[axis][end == "max"]
