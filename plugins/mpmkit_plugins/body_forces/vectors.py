"""Vectors of a force in a space."""

from __future__ import annotations

from mpmkit.contracts import Space


def wrong_length(field: str, vector: list[float], space: Space) -> str | None:
    """Why a space cannot have a vector at this field, in a sentence; None if it can."""
    if len(vector) == space.dim:
        return None
    needs = f"the space {space.name} needs {space.dim} numbers ({', '.join(space.axes)})"
    return f"{field} is {vector}, but {needs}"
