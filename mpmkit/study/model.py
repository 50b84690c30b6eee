"""The study: a case, and what is varied in it, as a pydantic model."""

from __future__ import annotations

from typing import Any

from pydantic import Field, model_validator

from ..case.base import Model

Changes = dict[str, Any]
"""New values by their paths in the case, such as ``{"scheme.order": "usf"}``."""


class Study(Model):
    """Variations of a case: the grid of everything in ``vary``, or the list of ``members``."""

    name: str = Field(
        default="study",
        pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$",
        max_length=100,
        description="name of its directory",
        json_schema_extra={
            "allowed": "at most 100 letters, digits, '_', '.' and '-', first a letter or a digit"
        },
    )
    description: str = ""
    case: str | dict[str, Any] = Field(
        description="the case that is varied: a file, its path from the study's, or the case itself"
    )
    common: Changes = Field(default={}, description="values by path that all members have")
    vary: dict[str, list[Any] | dict[str, Changes]] = Field(
        default={},
        description="dimensions of a grid: the values of one path, or by name sets of values by path",
    )
    members: dict[str, Changes] = Field(
        default={}, description="instead of a grid, a list: by name what is changed"
    )
    threads: int = Field(default=1, ge=1, description="threads of each member")

    @model_validator(mode="after")
    def _varies_something(self) -> Study:
        if bool(self.vary) == bool(self.members):
            given = "both are given" if self.vary else "neither is given"
            raise ValueError(f"a study has either vary or members, and {given}")
        for name, choices in self.vary.items():
            if not choices:
                raise ValueError(f"vary.{name} is empty; it must list at least one value")
            if isinstance(choices, list) and len({repr(value) for value in choices}) < len(choices):
                raise ValueError(f"vary.{name} has a value twice; keep one of them")
        return self
