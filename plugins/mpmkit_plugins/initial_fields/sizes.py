"""Values of a field in a case: a number, or a flat list of components."""

from __future__ import annotations

import math


def wrong_size(where: str, value: float | list[float], field: str, shape: tuple[int, ...]) -> str | None:
    """Why a value does not fit a field with this shape, in a sentence; None if it does."""
    count = len(value) if isinstance(value, list) else None
    if count == (math.prod(shape) if shape else None):
        return None
    needs = f"a list of {math.prod(shape)} numbers" if shape else "a number"
    return f"{where} is {value}; {field} needs {needs}"
