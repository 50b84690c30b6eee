"""The choices for the artificial sound speed of a nearly incompressible fluid."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Discriminator, Field, Tag, model_validator

from ..contracts import quantity
from .base import Model


class SoundSpeedFactor(Model):
    """Sound speed as a multiple of the free-fall speed over the height of the scene, c = factor √(2 g h).

    h is the extent of all bodies along gravity.
    """

    factor: float = quantity("1", "multiple of √(2 g h)", gt=0)


class SoundSpeedMach(Model):
    """Sound speed that follows the flow, c = √(2 e) / mach.

    e, J/kg, is the largest energy of a particle: kinetic, potential above the lowest particle, and stored. No
    particle can become faster than √(2 e). For a body at rest e = g h; as it slumps, e falls,
    and the steps grow.
    """

    mach: float = quantity("1", "largest Mach number that the flow can reach", gt=0, lt=1)

    @model_validator(mode="before")
    @classmethod
    def _is_one_choice(cls, value: Any) -> Any:
        if isinstance(value, dict) and {"mach", "factor"} <= value.keys():
            raise ValueError('it has mach and factor; it must have one of them, such as {"factor": 10}')
        return value


SoundSpeed = Annotated[
    Annotated[float, Field(gt=0), Tag("value")]
    | Annotated[SoundSpeedFactor, Tag("of-the-height")]
    | Annotated[SoundSpeedMach, Tag("of-the-flow")],
    Discriminator(lambda value: _tag(value)),
]


def _tag(value: Any) -> str:
    # Tags differ from all names of keys, so that the path of an error is clear.
    if isinstance(value, dict):
        return "of-the-flow" if "mach" in value else "of-the-height"
    if isinstance(value, SoundSpeedMach):
        return "of-the-flow"
    return "of-the-height" if isinstance(value, SoundSpeedFactor) else "value"
