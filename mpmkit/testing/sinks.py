"""What every sink must do: say which places it takes, and each for itself."""

from __future__ import annotations

import numpy as np

from ..contracts import Sink
from ..registry.audit import described
from ..spaces import SPACES, Space
from .surfaces import TIMES, N
from .violation import require, require_same


def faces_of(space: Space) -> dict[str, str]:
    """All faces of the grid, which are open."""
    return dict.fromkeys(space.faces, "open")


def at_home(sink: Sink) -> list[Space]:
    """The spaces that can have a sink, with open faces."""
    return [space for space in SPACES.values() if sink.problem(space, faces_of(space)) is None]


def home(sink: Sink) -> None:
    """At least one space can have it; of the others it says why not, in a sentence."""
    said = [sink.problem(space, faces_of(space)) for space in SPACES.values()]
    require(None in said, f"no space can have it: {'; '.join(map(str, said))}")
    for why in said:
        require(why is None or bool(why.strip()), "its problem is an empty text; it must be a sentence")


def domain(space: Space, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner of a grid, m."""
    lower = np.full(space.dim, -size)
    lower[0] = 0.0 if space.radial else -size
    return lower, np.full(space.dim, size)


def taken(sink: Sink, space: Space, size: float, x: np.ndarray, time: float) -> np.ndarray:
    """Which places it takes, ``(n,)`` True or False; they are only read."""
    given = x.copy()
    found = sink.takes(given, time, domain(space, size))
    require_same(given, x, lambda *at: f"coordinate {at[1]} of place {at[0]}, changed,")
    is_mask = isinstance(found, np.ndarray) and found.dtype == bool and found.shape == (len(x),)
    require(
        is_mask,
        f"takes returned {described(found)}; it must be an array of True and False of shape ({len(x)},)",
    )
    return found


def places(space: Space, size: float) -> np.ndarray:
    """Places all over a grid and beyond its faces, m, ``(N, dim)``."""
    lower, upper = domain(space, size)
    x = np.random.default_rng(0).uniform(lower - size / 2, upper + size / 2, (N, space.dim))
    if space.radial:
        x[:, 0] = np.abs(x[:, 0])
    return x


def takes_something(sink: Sink, space: Space, size: float) -> None:
    """Some of the places at some time, and not all of them at all times."""
    found = [taken(sink, space, size, places(space, size), time) for time in TIMES]
    require(bool(np.any(found)), f"it takes nothing within {1.5 * size:g} m of the origin")
    require(not bool(np.all(found)), "it takes everything, wherever it is")


def batch_order(sink: Sink, space: Space, size: float) -> None:
    """Places do not know each other, nor what was asked before: in another order, each gets the same."""
    x, order = places(space, size), np.random.default_rng(1).permutation(N)
    for time in reversed(TIMES):
        whole = taken(sink, space, size, x, time)
        for index, how in ((order, "in another order"), (np.array([N - 1]), "alone")):
            found = taken(sink, space, size, x[index], time)
            require_same(
                found.astype(float), whole[index].astype(float), lambda p, h=how: f"place {p}, asked for {h},"
            )
