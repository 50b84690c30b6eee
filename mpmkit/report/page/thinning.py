"""Fewer particles and moments, if a page with all of them would be too large."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...output.flow import Moment
from .packing import Packed

FEWEST_PARTICLES, FEWEST_MOMENTS = 2500, 12
MARGIN = 0.93
"""Part of the room to aim at: the packed size falls a little less than the number of particles."""
ODD = (2**0.5 - 1) * 2
"""Irrational factor that selects particles evenly; the run itself selects by the golden ratio."""


@dataclass(frozen=True)
class Thinned:
    """Moments that fit, and how they are packed."""

    moments: list[Moment]
    packed: Packed


def fitting(moments: Sequence[Moment], pack: Callable[[Sequence[Moment]], Packed], room: int) -> Thinned:
    """Select particles and moments so that they need at most ``room`` characters; the last moment is kept.

    First particles are left out, down to ``FEWEST_PARTICLES`` in each moment, and then moments.
    """
    kept, share = list(moments), 1.0
    while True:
        found = pack(kept)
        ratio = room / len(found.text)
        if ratio >= 1:
            return Thinned(kept, found)
        largest = max(len(moment) for moment in kept)
        if largest > FEWEST_PARTICLES:
            share *= max(MARGIN * ratio, FEWEST_PARTICLES / largest, 0.5)
            kept = [_fewer(moment, share) for moment in moments]
        elif len(kept) > FEWEST_MOMENTS:
            count = max(FEWEST_MOMENTS, int(MARGIN * ratio * len(kept)))
            kept = [kept[row] for row in np.linspace(0, len(kept) - 1, count).round().astype(int)]
            moments = [moments[row] for row in np.linspace(0, len(moments) - 1, count).round().astype(int)]
        else:
            share *= 0.5
            kept = [_fewer(moment, share) for moment in moments]


def _fewer(moment: Moment, share: float) -> Moment:
    kept = (moment.number * ODD) % 1.0 < share
    if not kept.any():
        kept[:1] = True
    return moment.only(kept, share)
