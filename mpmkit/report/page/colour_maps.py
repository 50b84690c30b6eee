"""Colours of the quantities of a flow: maps whose lightness rises evenly, for the colour-blind as well."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.colors import to_hex

STOPS = 33
DARKEST = 0.1
"""Where maps begin: their darkest colours would be lost on the dark background of a page."""
MAPS = {"speed": "viridis", "shear_rate": "inferno", "pressure": "cividis"}
YIELDED = ("#5b7fa6", "#e08a2e")
"""Colours of what is at rest as a solid, and of what flows."""


def stops(quantity: str) -> list[str]:
    """Colours, evenly spread from the least to the largest value."""
    if quantity == "yielded":
        return list(YIELDED)
    found = matplotlib.colormaps[MAPS[quantity]](np.linspace(DARKEST, 1 - DARKEST / 2, STOPS))
    return [to_hex(colour) for colour in found]
