"""The base of the models that a case is made of."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict


class Model(BaseModel):
    """Base of the case's own models: strict, finite, and no key that is not known."""

    def __eq__(self, other: Any) -> bool:
        """Whether the fields are equal; what was computed from them and kept does not count."""
        return type(self) is type(other) and all(
            getattr(self, name) == getattr(other, name) for name in type(self).model_fields
        )

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
