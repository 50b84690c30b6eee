"""Tables of values at rising times or places."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any


def require_table(name: str, values: Sequence[Any], at: Sequence[float], key: str = "times") -> None:
    """Check a table: one of ``values``, the parameter ``name``, for each of ``at``, which rise.

    Args:
        name: of the parameter that has the values.
        at: times, s, or places, m.
        key: of the parameter that has them: ``times`` or ``places``.

    Raises:
        ValueError: in one sentence that names the parameter.
    """
    if len(at) != len(values):
        raise ValueError(
            f"{name} has {len(values)} entries and {key} {len(at)}; there must be one for each {key[:-1]}"
        )
    unit = "m" if key == "places" else "s"
    for before, after in pairwise(at):
        if after <= before:
            raise ValueError(
                f"{key} has {after:g} {unit} after {before:g} {unit}; each must be above the one before"
            )
