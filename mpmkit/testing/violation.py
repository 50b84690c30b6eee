"""What a check says of a plug-in that fails it: one sentence, with what, where, and by how much."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Index = tuple[int, ...]


class Violation(AssertionError):
    """A contract that a plug-in does not keep."""


def require(holds: bool, sentence: str) -> None:
    """Raise a ``Violation`` with this sentence unless it holds."""
    __tracebackhide__ = True
    if not holds:
        raise Violation(sentence)


def require_all(holds: np.ndarray, sentence: Callable[..., str], worst: np.ndarray | None = None) -> None:
    """Raise a ``Violation`` with the sentence for an index where it does not hold.

    Args:
        holds: what must be true throughout.
        sentence: from an index to what is wrong there.
        worst: a measure of how wrong; the largest is reported; default: the first.
    """
    __tracebackhide__ = True
    holds = np.asarray(holds)
    if not holds.all():
        badness = np.where(holds, -np.inf, 1.0 if worst is None else np.nan_to_num(worst, nan=np.inf))
        raise Violation(sentence(*(int(i) for i in np.unravel_index(np.argmax(badness), holds.shape))))


def require_close(
    found: Any, expected: Any, tolerance: Any, what: Callable[..., str], unit: str = ""
) -> None:
    """Raise a ``Violation`` where ``found`` is off ``expected`` by more than ``tolerance``, NaN included.

    Args:
        found: array of any shape.
        expected: broadcast to it.
        tolerance: largest absolute difference, broadcast to it.
        what: from an index to what it is that is compared.
        unit: of the values.
    """
    __tracebackhide__ = True
    found = np.asarray(found, dtype=float)
    expected, tolerance = (np.broadcast_to(value, found.shape) for value in (expected, tolerance))
    off = np.abs(found - expected)

    def sentence(*at: int) -> str:
        f, e, o, t = found[at], expected[at], off[at], tolerance[at]
        return f"{what(*at)} is {f:.9g}{unit and ' ' + unit}, not {e:.9g}: off by {o:.3g}, {t:.3g} allowed"

    require_all(off <= tolerance, sentence, off - tolerance)


def require_same(found: np.ndarray, expected: np.ndarray, what: Callable[..., str]) -> None:
    """Raise a ``Violation`` where two arrays differ in any bit."""
    __tracebackhide__ = True
    require_close(found, expected, 0.0, what)
