"""What fills a scene with particles: bodies at the start, and sources."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Discriminator, Field, Tag, ValidationError, model_validator

from ..contracts import BodyShape, InitialField, Source, quantity
from .base import Model
from .material import Material


class SineVelocity(Model):
    """A standing wave as initial velocity: v(x) = amplitude sin(wave_vector · x)."""

    amplitude: list[float] = quantity("m/s", "amplitude along each axis")
    wave_vector: list[float] = quantity("rad/m", "2 pi over the wave length, along each axis")

    def at(self, position: np.ndarray) -> np.ndarray:
        """Velocity, m/s, ``(n, dim)``, at positions ``(n, dim)``, m."""
        return np.sin(position @ np.array(self.wave_vector))[:, None] * np.array(self.amplitude)


def _velocity_tag(value: Any) -> str:
    return "sine" if isinstance(value, dict | SineVelocity) else "uniform"


InitialVelocity = Annotated[
    Annotated[list[float], Tag("uniform")] | Annotated[SineVelocity, Tag("sine")],
    Discriminator(_velocity_tag),
]


ParticleCount = Annotated[int, Field(gt=0, le=1000)]
ParticlesPerCell = ParticleCount | list[ParticleCount] | None


def _particles_per_cell() -> Any:
    return quantity(
        "1",
        "particles in a full cell (a square or cubic number), or their number along each axis; "
        "default: 2 along each axis",
        default=None,
    )


class Body(Model):
    """A shape filled with a material."""

    shape: BodyShape = Field(description="where the body is at the start")
    material: Material = Field(description="what the body is made of")
    particles_per_cell: ParticlesPerCell = _particles_per_cell()
    velocity: InitialVelocity | None = quantity(
        "m/s", "initial velocity along each axis, or a standing wave; default: at rest", default=None
    )
    initial: dict[str, InitialField] = Field(
        default={},
        description="fields at the start: 'velocity', 'stress', or 'law.' and the name of a state variable",
    )

    def particles_along_axes(self, dim: int) -> tuple[int, ...]:
        """Particles along each axis of a full cell."""
        return particles_along_axes(self.particles_per_cell, dim)

    @property
    def largest_speed(self) -> float:
        """Upper bound of the initial speed, m/s."""
        if self.velocity is None:
            return 0.0
        vector = self.velocity if isinstance(self.velocity, list) else self.velocity.amplitude
        return math.hypot(*vector)


def particles_along_axes(per_cell: int | list[int] | None, dim: int) -> tuple[int, ...]:
    """Particles along each axis of a full cell, of their number in it as in a case."""
    if per_cell is None:
        return (2,) * dim
    if isinstance(per_cell, list):
        return tuple(per_cell)
    return (round(per_cell ** (1 / dim)),) * dim


class Inflow(Model):
    """A source with its material."""

    kind: str = Field(description="name of the source")
    material: Material = Field(description="what comes in")
    particles_per_cell: ParticlesPerCell = _particles_per_cell()

    source_class: ClassVar[type[Source]]

    @model_validator(mode="after")
    def _is_a_source(self) -> Inflow:
        """Rules of the source that span several of its fields."""
        try:
            self.source  # noqa: B018
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            raise ValueError(str(first.get("ctx", {}).get("error", first["msg"]))) from None
        return self

    @cached_property
    def source(self) -> Source:
        """The source with its parameters."""
        return self.source_class.model_validate(
            {name: getattr(self, name) for name in self.source_class.model_fields}
        )

    def particles_along_axes(self, dim: int) -> tuple[int, ...]:
        """Particles along each axis of a full cell."""
        return particles_along_axes(self.particles_per_cell, dim)
