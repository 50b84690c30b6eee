"""Pairwise products, for tests of faults that depend on at most two choices at once."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest
from allpairspy import AllPairs


def pairwise(*axes: Iterable[Any]) -> list[tuple[Any, ...]]:
    """Rows in which every value of an axis meets every value of every other axis at least once."""
    return [tuple(row) for row in AllPairs([list(axis) for axis in axes])]


def every_pair(names: str, *axes: Iterable[Any]) -> pytest.MarkDecorator:
    """As ``pytest.mark.parametrize``, over the pairwise product of the axes, in the order of the names."""
    return pytest.mark.parametrize(names, pairwise(*axes))
