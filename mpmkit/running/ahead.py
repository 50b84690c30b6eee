"""Predicts the compiled functions that a case will need: those of the most similar recorded case.

``benchmarks/needed_kernels.py`` writes the record, ``needed_kernels.json``. It need not be complete or up to
date: a function that is missing is compiled when it is needed, and one that is not needed only takes time of
another core.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from importlib.resources import files
from typing import Any

import numba

from ..case.model import Case
from ..kernels.ahead import AHEAD
from ..kernels.needs import Need

MOST = 3
"""Largest number of processes: with more, the functions that take longest to compile determine the time."""


def compile_ahead(case: Case, threads: int | None = None) -> None:
    """Let other processes compile the functions that a case needs, if any is not in the cache.

    Together with this process they use no more cores than ``threads``; default: all.
    """
    AHEAD.expect(needs_of(case), min(MOST, _cores(threads) - 1))


def needs_of(case: Case) -> list[Need]:
    """The functions that the most similar recorded case needed, in the order in which to compile them ahead.

    The run itself compiles the functions of the first step from the first one on. So the other processes
    begin with the last one of the first step, and then compile those that are needed only later.
    """
    record, wanted = recorded(), traits(case)
    nearest = min(record["cases"], key=lambda of: len(wanted ^ set(of["traits"])))
    order = [*reversed(nearest["first"]), *nearest["later"]]
    return [Need(**record["functions"][number]) for number in order]


def recorded() -> dict[str, Any]:
    """``functions``, and of each of ``cases`` its traits and the numbers of the functions that it needs."""
    return json.loads((files(__package__) / "needed_kernels.json").read_text(encoding="utf-8"))


def traits(case: Case) -> set[str]:
    """What decides which functions a case needs: its dimensions, and all words in it with their places."""
    data = case.model_dump(mode="json", exclude={"name", "description", "measurements"})
    return {f"dimensions {case.space_.dim}", *_words(data, "")}


def _words(value: Any, place: str) -> Iterator[str]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _words(inner, f"{place} {key}")
    elif isinstance(value, list):
        for inner in value:
            yield from _words(inner, place)
    elif isinstance(value, str):
        yield f"{place} {value}".strip()


def _cores(threads: int | None) -> int:
    """Cores that this process may use, no more than the user allows."""
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(usable, threads or usable, numba.config.NUMBA_NUM_THREADS)
