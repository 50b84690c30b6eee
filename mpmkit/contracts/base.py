"""Base of all plug-ins: a frozen, validated record of parameters with a name and a source."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_serializer, model_validator
from pydantic.json_schema import GetJsonSchemaHandler
from pydantic_core import CoreSchema

API_VERSION = 2
"""Version of the plug-in contracts; it increases when plug-ins must be changed to work."""
OLDEST_API_VERSION = 1
"""Oldest version whose plug-ins still work; plug-ins of versions that are not supported are reported."""


def quantity(unit: str, description: str = "", **constraints: Any) -> Any:
    """A physical parameter: a pydantic ``Field`` that also carries its SI unit into the JSON Schema.

    >>> yield_stress: float = quantity("Pa", "stress below which it does not flow", ge=0)
    """
    return Field(
        description=f"{description} [{unit}]".strip(), json_schema_extra={"unit": unit}, **constraints
    )


def one_each(values: Any, asked: np.ndarray, method: str) -> np.ndarray:
    """What a method returned for an array, if it is an array of the same shape.

    Raises:
        TypeError: it is not, or not of real numbers; a compiled loop would read beyond its end.
    """
    if not isinstance(values, np.ndarray) or values.shape != asked.shape:
        what = (
            f"an array of shape {values.shape}"
            if isinstance(values, np.ndarray)
            else f"a {type(values).__name__}"
        )
        raise TypeError(f"{method} returned {what}; it must return an array of shape {asked.shape}")
    if values.dtype.kind not in "fiu":
        raise TypeError(f"{method} returned an array of {values.dtype}; it must return one of float64")
    return values


class Plugin(BaseModel):
    """Base of all descriptors. Its annotated fields are its parameters; its class variables say what it is.

    In a case file a plug-in is written by name, ``"cpgimp"``, or with parameters,
    ``{"name": "cpgimp", "domain": "stretch"}``; surfaces and contacts have ``"kind"`` in place of ``"name"``.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    name: ClassVar[str]
    citation: ClassVar[str]
    api_version: ClassVar[int]
    """Version of the contracts for which it is written, so that an old plug-in is noticed."""
    named_by: ClassVar[str] = "name"
    """Key that names it in a case file; the same for all plug-ins of a kind."""

    def cautions(self, case: Any) -> list[str]:
        """Sentences on what is known to fail in the case, whose fields are those of case files."""
        return []

    @model_validator(mode="before")
    @classmethod
    def _accept_shorthand(cls, value: Any) -> Any:
        if isinstance(value, str):
            return {}
        if isinstance(value, dict):
            return {key: item for key, item in value.items() if key != cls.named_by}
        return value

    @model_serializer(mode="wrap")
    def _with_name(self, handler: Any) -> dict[str, Any]:
        return {self.named_by: self.name, **handler(self)}

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        body = handler.resolve_ref_schema(handler(schema))
        name = getattr(cls, "name", None)
        if name is None:
            return body
        body["properties"] = {cls.named_by: {"const": name}, **body.get("properties", {})}
        body["required"] = [cls.named_by, *body.get("required", [])]
        if body["required"] != [cls.named_by]:  # its name alone is not enough
            return body
        return {"anyOf": [{"const": name, "description": (cls.__doc__ or "").split("\n")[0]}, body]}
