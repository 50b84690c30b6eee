"""Histories of several runs at common times."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray

ROWS = 201
"""Times at which histories are compared."""


def scalars_at(history: xarray.Dataset, time: np.ndarray) -> Iterator[tuple[str, np.ndarray, dict]]:
    """Name, values and attributes of each scalar of a history, by linear interpolation.

    Args:
        history: with the dimension ``time``.
        time: s, ``(t,)``.

    Yields:
        Values ``(t,)``, which are NaN after the end of the history.
    """
    end = float(history.time[-1]) * (1 + 1e-9)
    for name, series in history.data_vars.items():
        if series.dims == ("time",):
            values = np.interp(time, history.time.values, series.values)
            yield str(name), np.where(time <= end, values, np.nan), dict(series.attrs)


def number_or_nan(value: Any) -> float:
    """A number of a summary; NaN for None."""
    return math.nan if value is None else float(value)
