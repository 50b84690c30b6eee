"""The base of the models that a case is made of."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict, Field


class Model(BaseModel):
    """Base of the case's own models: strict types, finite numbers, and only known keys."""

    def __eq__(self, other: Any) -> bool:
        """Whether the fields are equal; cached values do not count."""
        return type(self) is type(other) and all(
            getattr(self, name) == getattr(other, name) for name in type(self).model_fields
        )

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


def name_of_directory(default: str, description: str) -> Any:
    """The field of a name that is also the name of a directory."""
    return Field(
        default=default,
        pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$",
        max_length=100,
        description=description,
        json_schema_extra={
            "allowed": "at most 100 letters, digits, '_', '.' and '-', first a letter or a digit"
        },
    )
