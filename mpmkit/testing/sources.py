"""What every source must do: have a mouth, push its column forwards, and no faster than it says."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from ..contracts import Mouth, Source
from ..registry.audit import described
from ..spaces import SPACES, Space
from .sinks import domain
from .violation import require

AREA, DENSITY = 0.01, 2000.0
"""m² and kg/m³, of the column that is asked about."""
LAST, TIMES = 10.0, 401
"""s, and the number of times at which it is asked."""
ROUNDING = 1e-9


def at_home(source: Source, size: float) -> list[Space]:
    """The spaces that can have a source."""
    return [space for space in SPACES.values() if source.problem(space, domain(space, size)) is None]


def home(source: Source, size: float) -> None:
    """At least one space can have it; of the others it says why not, in a sentence."""
    said = [source.problem(space, domain(space, size)) for space in SPACES.values()]
    require(None in said, f"no space can have it: {'; '.join(map(str, said))}")
    for why in said:
        require(why is None or bool(why.strip()), "its problem is an empty text; it must be a sentence")


def mouth(source: Source, space: Space, size: float) -> None:
    """A section normal to an axis, in a space."""
    found = source.mouth(space, domain(space, size))
    require(isinstance(found, Mouth), f"mouth returned {described(found)}; it must be a Mouth")
    for name in ("centre", "half_width"):
        values = getattr(found, name)
        require(
            len(values) == space.dim and all(math.isfinite(value) for value in values),
            f"its mouth has the {name} {values}; it must be {space.dim} finite numbers",
        )
    require(
        found.axis in range(space.dim),
        f"its mouth has the axis {found.axis}; it must be 0 to {space.dim - 1}",
    )
    require(found.sign in (1, -1), f"its mouth has the sign {found.sign}; it must be 1 or -1")
    for axis, half in enumerate(found.half_width):
        flat = axis == found.axis
        require(
            half == 0 if flat else half > 0,
            f"its mouth is {2 * half:g} m wide along axis {axis}; it must be "
            f"{'0, along its normal' if flat else 'above 0'}",
        )


def _times(source: Source) -> np.ndarray:
    begins, ends = source.spell(AREA, DENSITY)
    require(
        0 <= begins < ends, f"its spell is from {begins} s to {ends} s; it must begin at 0 or later, then end"
    )
    last = begins + LAST if math.isinf(ends) else ends + 0.1 * (ends - begins)
    return np.unique([0.0, begins, min(ends, last), *np.linspace(0.0, last, TIMES)])


def _pushed(source: Source, time: float) -> float:
    found = source.pushed(time, AREA, DENSITY)
    number = isinstance(found, int | float | np.floating) and math.isfinite(found)
    require(number, f"pushed returned {found!r} at {time:g} s; it must be a finite number")
    return float(found)


def pushes(source: Source) -> None:
    """Its column begins with no length, never moves back, is pushed out at some time, and ends as it says."""
    times = _times(source)
    begins, ends = source.spell(AREA, DENSITY)
    lengths = np.array([_pushed(source, float(time)) for time in times])
    before, after = lengths[times <= begins], lengths[times >= ends]
    require(
        bool((before == 0).all()), f"it has pushed out {before.max():.4g} m before it begins, at {begins:g} s"
    )
    falls = np.diff(lengths)
    least = int(np.argmin(falls))
    require(
        bool(falls[least] >= -ROUNDING * lengths.max()),
        f"its column moves back by {-falls[least]:.4g} m between {times[least]:g} and {times[least + 1]:g} s",
    )
    require(bool(lengths.max() > 0), f"it has pushed out nothing by {times[-1]:g} s")
    require(len(after) == 0 or bool((after == after[0]).all()), f"it pushes on after its end, at {ends:g} s")


def fastest(source: Source) -> None:
    """The speed of the column between two times is at most ``fastest`` of them."""
    times = _times(source)
    lengths = np.array([_pushed(source, float(time)) for time in times])
    places = np.array([np.atleast_1d(source.moved(float(time))) for time in times], dtype=float)
    steps = np.diff(times)
    # The normal may be along any axis: so the column is at least as fast as the difference of its two parts.
    along, across = np.diff(lengths) / steps, np.linalg.norm(np.diff(places, axis=0), axis=1) / steps
    speed = np.abs(along - across)
    bound = np.array([source.fastest(float(a), float(b), AREA, DENSITY) for a, b in pairwise(times)])
    over = speed - bound * (1 + 1e-6) - ROUNDING
    worst = int(np.argmax(over))
    require(
        bool(over[worst] <= 0),
        f"its column moves at {speed[worst]:.6g} m/s between {times[worst]:g} and {times[worst + 1]:g} s, "
        f"and fastest says {bound[worst]:.6g} m/s",
    )


def remembers_nothing(source: Source) -> None:
    """Asked in another order, it gives the same answers."""
    times = _times(source)
    once = {float(time): _pushed(source, float(time)) for time in times}
    for time in times[::-1]:
        again = _pushed(source, float(time))
        require(
            again == once[float(time)],
            f"it has pushed out {once[float(time)]:.9g} m at {time:g} s and {again:.9g} m when asked again",
        )
