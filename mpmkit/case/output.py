"""The output of a run, and its times."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, WithJsonSchema

from ..contracts import Diagnostic, ParticleField, quantity
from ..output.variables import PARTICLE_VARIABLES

NAMED: dict[str, Any] = {"propertyNames": {"pattern": "^[A-Za-z0-9_-]+$"}}
ROWS, FRAMES = 400, 20
"""Default numbers of rows and frames of a run."""


ParticleFieldName = Annotated[
    str,
    WithJsonSchema(
        {
            "type": "string",
            "allowed": "a particle field or a state variable of a law of the case",
            "examples": list(PARTICLE_VARIABLES),
        }
    ),
]


class OutputSettings(BaseModel):
    """Intervals and contents of the history and the frames."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    history_interval: float | None = quantity(
        "s", "time between rows of the history; default: a 400th of the run", gt=0, default=None
    )
    frame_interval: float | None = quantity(
        "s", "time between frames; default: a 20th of the run", gt=0, default=None
    )
    snapshot_times: list[Annotated[float, Field(ge=0)]] = quantity(
        "s",
        "times whose frames the report draws; the last state is always drawn",
        default=[0.0, 0.1, 0.2, 0.5],
    )
    particle_history: list[ParticleFieldName] = Field(
        default=[], description="particle fields kept in every row of the history, by particle number"
    )
    diagnostics: dict[str, Diagnostic] = Field(
        default={},
        description="what rows of the history hold beside their own variables, each by a name of letters, "
        "digits, '_' and '-'",
        json_schema_extra=NAMED,
    )
    fields: dict[str, ParticleField] = Field(
        default={},
        description="fields of particles in frames, and for particle_history, each by a name of letters, "
        "digits, '_' and '-'",
        json_schema_extra=NAMED,
    )
    report: bool = Field(default=True, description="whether pictures are drawn at the end")
