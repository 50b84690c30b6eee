"""Which compiled functions a case will need: those that the most similar of some recorded cases needed.

``needed_kernels.json`` is made by ``benchmarks/needed_kernels.py``. It need not be complete nor in date: what
is missing is compiled when it is needed, and what is not needed costs time of another core.
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
"""Processes at the most: the functions that take longest to compile set the pace of more of them."""


def compile_ahead(case: Case, threads: int | None = None) -> None:
    """Have other processes compile what a case needs, if anything is not compiled.

    Together with this process they use no more cores than ``threads``; default: all.
    """
    AHEAD.expect(needs_of(case), min(MOST, _cores(threads) - 1))


def needs_of(case: Case) -> list[Need]:
    """What the most similar recorded case needed, in the order in which it should be compiled ahead.

    The run begins with what it needs first. So the others begin with what is needed last in the first step,
    and after that compile what is needed only later.
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
