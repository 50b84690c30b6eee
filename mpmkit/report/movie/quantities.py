"""The quantities that can colour a movie, and the colour scale that all its pictures share."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from matplotlib.colors import BoundaryNorm, Colormap, ListedColormap, Normalize

from ..style import COLOUR_MAP

RIGID, FLOWING = "#9DB4C0", "#009E73"
"""Colours of material that has not yielded, and of material that has."""


@dataclass(frozen=True)
class Quantity:
    """A field of the frames."""

    field: str
    label: str
    percentiles: tuple[float, float]
    """Percentiles at the ends of the scale; a few shear rates and pressures lie far outside."""
    ticks: tuple[str, ...] = ()
    """Labels of the values 0, 1, … of a field that has only these values."""


@dataclass(frozen=True)
class Scale:
    """From values to colours."""

    norm: Normalize
    colour_map: str | Colormap
    extend: str
    """the ends of the scale that values may exceed, as matplotlib names them"""


QUANTITIES = {
    "speed": Quantity("speed", "speed (m/s)", (0, 100)),
    "shear-rate": Quantity("shear_rate", "shear rate (1/s)", (0, 98)),
    "yielded": Quantity("yielded", "", (0, 100), ("has not yielded", "has yielded")),
    "pressure": Quantity("pressure", "pressure (Pa)", (2, 98)),
}
"""By the names of the option ``--colour-by``."""


def scale_of(quantity: Quantity, values: Iterable[np.ndarray]) -> Scale:
    """The scale for the values of all frames."""
    if quantity.ticks:
        edges = np.arange(len(quantity.ticks) + 1) - 0.5
        return Scale(BoundaryNorm(edges, len(quantity.ticks)), ListedColormap([RIGID, FLOWING]), "neither")
    joined = np.concatenate([*values, np.zeros(1)])
    low, high = np.percentile(joined, quantity.percentiles)
    low = min(low, 0.0)
    if not high > low:
        high = low + 1.0
    ends = (joined.min() < low, joined.max() > high)
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[
        ends
    ]
    return Scale(Normalize(low, high), COLOUR_MAP, extend)
