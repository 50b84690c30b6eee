"""The study: a case and its variations, as a pydantic model."""

from __future__ import annotations

import json
import re
from typing import Annotated, Any

from pydantic import Field, WithJsonSchema, model_validator

from ..case.base import Model, name_of_directory
from .clashes import clash, replaced
from .quantities import TAKEN


def _said(kind: str, allowed: str) -> WithJsonSchema:
    """The schema of a type, with the allowed values in words, which error messages use."""
    return WithJsonSchema({"type": kind, "allowed": allowed})


Changes = Annotated[
    dict[str, Any],
    _said("object", 'an object of values by their paths in the case, such as {"scheme.order": "usf"}'),
]
"""New values by their paths in the case."""
DIMENSION = r"[A-Za-z0-9_][A-Za-z0-9_.-]*"
"""Allowed names of a dimension: NetCDF names that are easy to type."""


class Study(Model):
    """Variations of a case: the grid of everything in ``vary``, or the list of ``members``."""

    name: str = name_of_directory("study", "name of its directory")
    description: str = ""
    case: (
        Annotated[str, _said("string", "the path of a case file")]
        | Annotated[dict[str, Any], _said("object", "a case itself")]
    ) = Field(description="the case that is varied: a file, relative to the study file, or the case itself")
    common: Changes = Field(default={}, description="values by path that all members have")
    vary: dict[str, Annotated[list[Any], _said("array", "a list of values")] | dict[str, Changes]] = Field(
        default={},
        description="dimensions of a grid: a list of values of one path, or named sets of values by path",
    )
    members: dict[str, Changes] = Field(
        default={}, description="a list instead of a grid: the changes of each member, by name"
    )
    threads: int = Field(default=1, ge=1, description="threads of each member")
    pages: bool = Field(
        default=True, description="whether each member keeps a page, as a run does, of at most 1 MB"
    )

    @model_validator(mode="after")
    def _varies_something(self) -> Study:
        if bool(self.vary) == bool(self.members):
            given = "both are given" if self.vary else "neither is given"
            raise ValueError(f"a study has either vary or members, and {given}")
        for name, choices in self.vary.items():
            if not re.fullmatch(DIMENSION, name):
                raise ValueError(
                    f"vary has {shown([name])[1:-1]}; it must be named by letters, digits, '_', '.' and '-'"
                )
            if name in TAKEN:
                raise ValueError(f"vary.{name} has the name of a result; it must be called something else")
            if not choices:
                raise ValueError(f"vary.{name} is empty; it must list at least one value")
            # Compared as text, as in the dataset: 1 and 1.0 differ, but "1" and 1 are the same.
            labels = [shown(choice) for choice in choices]
            twice = next((label for label in labels if labels.count(label) > 1), None)
            if twice is not None:
                raise ValueError(f"vary.{name} has the value {twice} twice; keep one of them")
        self._changes_no_place_twice()
        return self

    def _changes_no_place_twice(self) -> None:
        both = clash(
            {
                name: dict.fromkeys(path for changes in choices.values() for path in changes)
                if isinstance(choices, dict)
                else [name]
                for name, choices in self.vary.items()
            }
        )
        if both is not None:
            raise ValueError(both)
        lost = replaced(
            self.common, [name for name, choices in self.vary.items() if isinstance(choices, list)]
        )
        if lost is not None:
            raise ValueError(
                f"common.{lost[0]} is a part of vary.{lost[1]}, which replaces it in every member; "
                f"leave it out, or make it a part of the values of vary.{lost[1]}"
            )


def shown(label: Any) -> str:
    """A label as text."""
    return label if isinstance(label, str) else json.dumps(label, ensure_ascii=False)
