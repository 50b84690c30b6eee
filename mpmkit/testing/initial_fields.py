"""What every initial field must do: a value for each place, each for itself."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..contracts import Beginning, InitialField
from ..registry.audit.initial_fields import initial_values
from ..spaces import SPACES, Space
from .surfaces import N, points
from .violation import require, require_same

SHAPES = {"stress": (6,), "law.number": (), "law.pair": (2,)}
"""Fields beside the velocity, and the shapes of their values."""


def homes(field: InitialField) -> list[tuple[Space, str, tuple[int, ...]]]:
    """Spaces and fields that it can give."""
    asked = [(s, n, shape) for s in SPACES.values() for n, shape in {"velocity": (s.dim,), **SHAPES}.items()]
    return [one for one in asked if field.problem(*one) is None]


def home(field: InitialField) -> None:
    """There is a field that it can give in some space; of the others it says why not, in a sentence."""
    require(bool(homes(field)), "it can give no field in any space")
    for space in SPACES.values():
        for name, shape in {"velocity": (space.dim,), **SHAPES}.items():
            why = field.problem(space, name, shape)
            require(why is None or bool(why.strip()), "its problem is an empty text; it must be a sentence")


def starts(field: InitialField, size: float) -> Iterator[Beginning]:
    """A body in each space and for each field that it can give."""
    for space, name, shape in homes(field):
        gravity = np.zeros(space.dim)
        gravity[-1] = -9.81
        yield Beginning(space, name, shape, points(space, size), 1500.0, gravity, size)


def arrays(field: InitialField, size: float) -> None:
    """Finite values of the right shape, from places that are only read."""
    for start in starts(field, size):
        before = start.position.copy()
        field.at(start)
        require_same(start.position, before, lambda *at: f"coordinate {at[1]} of place {at[0]}, changed,")
        initial_values(field, start)


def batch_order(field: InitialField, size: float) -> None:
    """Places do not know each other: in another order, or alone, each gets the same."""
    order = np.random.default_rng(1).permutation(N)
    for start in starts(field, size):
        whole = initial_values(field, start)
        for index, how in ((order, "in another order"), (np.array([N - 1]), "alone")):
            part = Beginning(**{**vars(start), "position": start.position[index]})
            found = initial_values(field, part)
            require_same(
                found, whole[index], lambda *at, h=how: f"the value of place {at[0]}, asked for {h},"
            )
