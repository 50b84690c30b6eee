"""The numerical method of a case."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, model_validator

from ..contracts import quantity
from ..contracts.order import UpdateOrder
from ..contracts.redistribution import Redistribution
from ..contracts.refinement import Refinement
from ..contracts.shape import ShapeFunction
from ..contracts.velocity import VelocityUpdate
from ..contracts.volumetric import VolumetricTreatment
from .base import Model


class TimeStep(Model):
    """The step as a fraction of the smallest limit that is not ignored."""

    fraction: float = quantity("1", "fraction of the critical step", gt=0, le=1, default=0.5)
    ignore: list[Literal["acoustic", "viscous", "advective"]] = Field(
        default=[], description="limits that the step may exceed; a warning says by how much"
    )


class Scheme(Model):
    """The numerical method."""

    shape: ShapeFunction
    order: UpdateOrder
    velocity: VelocityUpdate
    volumetric: VolumetricTreatment
    redistribution: Redistribution
    refinement: Refinement
    splitting: bool = Field(
        default=False,
        description="true is short for the refinement 'split', false for 'none'",
    )
    time_step: TimeStep = Field(default=TimeStep(), description="how long a step is")

    @model_validator(mode="before")
    @classmethod
    def _splitting_says_whether(cls, data: Any) -> Any:
        """``splitting`` tells whether particles are split, ``refinement`` how."""
        if not isinstance(data, dict) or not isinstance(data.get("splitting", False), bool):
            return data
        if "refinement" not in data:
            return data | ({"refinement": "split"} if data.get("splitting") else {})
        chosen = data["refinement"]
        name = chosen.get("name") if isinstance(chosen, dict) else getattr(chosen, "name", chosen)
        splits = name != "none"
        if data.get("splitting", splits) != splits:
            raise ValueError(
                f"splitting is {str(data['splitting']).lower()} and refinement is "
                f"{name!r}, which contradict each other; leave out splitting"
            )
        return data | {"splitting": splits}
