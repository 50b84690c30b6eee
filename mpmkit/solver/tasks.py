"""Division of work into pieces for any number of threads."""

from __future__ import annotations

import numpy as np

TASKS = 64
"""Number of pieces of a loop over blocks or rows with unequal load."""


def cuts(load: np.ndarray) -> np.ndarray:
    """Where to cut items into ``TASKS`` pieces of about equal load.

    Args:
        load: ``(items + 1,)``, the load of all items before each, and of all.

    Returns:
        ``(TASKS + 1,)``, the first item of each piece, and the number of items.
    """
    found = np.searchsorted(load, np.linspace(load[0], load[-1], TASKS + 1))
    found[0], found[-1] = 0, len(load) - 1
    return found
