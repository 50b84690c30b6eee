"""The base of the models that a case is made of."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict


class Model(BaseModel):
    """Base of the case's own models: strict types, finite numbers, and only known keys."""

    def __eq__(self, other: Any) -> bool:
        """Whether the fields are equal; cached values do not count."""
        return type(self) is type(other) and all(
            getattr(self, name) == getattr(other, name) for name in type(self).model_fields
        )

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
