"""A material of a case: a law, its parameters, a density and a sound speed."""

from __future__ import annotations

from functools import cached_property
from typing import ClassVar

from pydantic import Field

from ..contracts import ConstitutiveLaw, EquationOfState, quantity
from .base import Model
from .sound_speed import SoundSpeed


class Material(Model):
    """A constitutive law with its parameters, a density and, for a fluid, a sound speed."""

    law: str = Field(description="name of the constitutive law")
    density: float = quantity("kg/m^3", "initial density", gt=0)
    sound_speed: SoundSpeed | None = quantity(
        "m/s", "artificial sound speed, or a factor of √(2 g h), or the largest Mach number", default=None
    )
    equation_of_state: EquationOfState

    law_class: ClassVar[type[ConstitutiveLaw]]

    @cached_property
    def constitutive_law(self) -> ConstitutiveLaw:
        """The law with its parameters."""
        return self.law_class.model_validate(
            {name: getattr(self, name) for name in self.law_class.model_fields}
        )
