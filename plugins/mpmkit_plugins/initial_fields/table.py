"""A field by a table along an axis."""

from __future__ import annotations

import numpy as np
from pydantic import model_validator

from mpmkit.contracts import Beginning, InitialField, Space, hookimpl, quantity, require_table

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
        require_table("values", self.values, self.places, "places")
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
