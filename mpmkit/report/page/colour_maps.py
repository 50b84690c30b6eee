"""Colour maps of the quantities: their lightness grows evenly, so that colour-blind readers can use them."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.colors import to_hex

STOPS = 33
DARKEST = 0.1
"""Start of the maps: darker colours would not be visible on the dark background of a page."""
MAPS = {"speed": "viridis", "shear_rate": "inferno", "pressure": "cividis"}
YIELDED = ("#5b7fa6", "#e08a2e")
"""Colours of material at rest and of material that flows."""
ADDED = "plasma"
"""Map of state variables of laws, and of fields of the case."""


def stops(quantity: str) -> list[str]:
    """Colours at evenly spaced values, from the lowest to the highest."""
    if quantity == "yielded":
        return list(YIELDED)
    found = matplotlib.colormaps[MAPS.get(quantity, ADDED)](np.linspace(DARKEST, 1 - DARKEST / 2, STOPS))
    return [to_hex(colour) for colour in found]
