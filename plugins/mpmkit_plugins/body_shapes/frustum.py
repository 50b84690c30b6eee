"""The frustum of an upright cone: the mould of the slump test."""

from __future__ import annotations

from pydantic import model_validator

from mpmkit.contracts import BodyShape, hookimpl, quantity

from .upright import Upright


class Frustum(Upright):
    """Upright frustum, V = π h (R_b² + R_b R_t + R_t²)/3; a trapezium in plane strain.

    Either radius may be 0 (a full cone), not both. In an axisymmetric scene its base is [0, z].
    """

    name = "frustum"
    api_version = 2
    citation = "none: elementary geometry"

    bottom_radius: float = quantity("m", "radius of the bottom disc", ge=0)
    top_radius: float = quantity("m", "radius of the top disc", ge=0)

    @model_validator(mode="after")
    def _has_volume(self) -> Frustum:
        if self.bottom_radius == 0 and self.top_radius == 0:
            raise ValueError("bottom_radius and top_radius are both 0, but one of them must be above 0")
        return self

    def _radii(self) -> tuple[float, float]:
        return self.bottom_radius, self.top_radius


@hookimpl
def mpmkit_body_shapes() -> list[type[BodyShape]]:
    return [Frustum]
