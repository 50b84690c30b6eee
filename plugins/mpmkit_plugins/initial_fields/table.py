"""A field by a table along an axis."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from pydantic import model_validator

from mpmkit.contracts import Beginning, InitialField, Space, hookimpl, quantity

from .sizes import wrong_size


class Table(InitialField):
    """Values at places along an axis: linear between them, constant below the first and above the last."""

    name = "table"
    api_version = 2
    citation = "none: a definition"

    axis: str = quantity("1", "axis of the space along which it changes, such as z")
    places: list[float] = quantity("m", "rising places along the axis", min_length=2)
    values: list[float] | list[list[float]] = quantity(
        "unit of the field", "value, or list of components, at each of the places", min_length=2
    )

    @model_validator(mode="after")
    def _is_a_table(self) -> Table:
        if len(self.places) != len(self.values):
            raise ValueError(
                f"values has {len(self.values)} entries and places {len(self.places)}; "
                "there must be one for each place"
            )
        for before, after in pairwise(self.places):
            if after <= before:
                raise ValueError(
                    f"places has {after:g} m after {before:g} m; each must be above the one before"
                )
        return self

    def problem(self, space: Space, field: str, shape: tuple[int, ...]) -> str | None:
        if self.axis not in space.axes:
            return f"axis is '{self.axis}'; the space {space.name} has the axes {', '.join(space.axes)}"
        for row, value in enumerate(self.values):
            if said := wrong_size(f"values.{row}", value, field, shape):  # type: ignore[arg-type]
                return said
        return None

    def at(self, start: Beginning) -> np.ndarray:
        x = start.position[:, start.space.axes.index(self.axis)]
        table = np.array(self.values, dtype=float).reshape(len(self.places), -1)
        found = np.column_stack([np.interp(x, self.places, component) for component in table.T])
        return found.reshape(len(x), *start.shape)


@hookimpl
def mpmkit_initial_fields() -> list[type[InitialField]]:
    return [Table]
