"""The run of one member, in a process of this machine or on another machine."""

from __future__ import annotations

import logging
import tempfile
import threading
import time as clock
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import GuardStop, reason

FAILED = "failed"
"""Fate of a member that could not be run, or that ended with an unexpected error."""
MOST_BYTES = 1_000_000
"""Largest size of the page of a member."""
LOGGER = logging.getLogger("mpmkit")
MOMENT = 1e-9
"""Part of the run time of the warm-up run, which takes one step to load all code."""
TURN = threading.Lock()
"""Lock for executors with threads: one member at a time in a process, because CPU time, numba's threads and
the NetCDF library are shared by the whole process."""

_LOADED: set[frozenset[str]] = set()
"""Kinds of cases whose code this process has loaded: their warm-up run has been made."""


@dataclass(frozen=True)
class Outcome:
    """The result of a member; it can be sent from one machine to another."""

    fate: str
    """``finished``, or the name of the guard that stopped it, or ``failed``"""
    sentence: str
    """error message, if it did not finish"""
    summary: dict[str, Any]
    cost: dict[str, float]
    """wall_seconds, cpu_seconds, steps, particle_steps, memory_bytes"""
    history: bytes
    """bytes of ``history.nc``; empty if there is none"""
    page: bytes = b""
    """bytes of the page of the run; empty if none was asked for, or made"""


@dataclass(frozen=True)
class PageOf:
    """The page that a member is to have."""

    title: str
    above: str
    """address of the page of the study, relative to that of the member"""


def run_member(data: dict[str, Any], threads: int, page: PageOf | None = None) -> Outcome:
    """Run a case and return its result; no file stays on the machine that ran it.

    The seconds are those of the run itself: kernels are loaded, or compiled, before the clock starts, and the
    page is made after it has stopped.
    """
    with TURN, np.errstate(all="ignore"):  # a guard reports a diverging run
        return _run(data, threads, page)


def _run(data: dict[str, Any], threads: int, page: PageOf | None) -> Outcome:
    import json

    from ..case import parse_case
    from ..case.ending import latest
    from ..running.ahead import traits
    from ..running.runner import run
    from ..solver.memory import expected_bytes, require_memory

    try:
        keeps = f"output.report={'false' if page is None else 'true'}"
        case = parse_case(data, [keeps, f"output.frame_interval={latest(data['until'])!r}"])
        require_memory(case)
    except Exception as error:
        return Outcome(FAILED, reason(error), {}, {}, b"")
    fate, sentence = "finished", ""
    with tempfile.TemporaryDirectory() as place:
        kind = frozenset(traits(case))
        if kind not in _LOADED:
            with suppress(Exception):  # the run meets the error again and reports it
                moment = case.model_copy(update={"until": MOMENT * case.end})
                run(moment, Path(place) / "moment", threads=threads, draw=False)
                _LOADED.add(kind)
        out = Path(place) / "run"
        wall, cpu = clock.perf_counter(), clock.process_time()
        try:
            run(case, out, threads=threads, draw=False)
        except GuardStop as stop:
            fate, sentence = stop.guard, reason(stop)
        except Exception as error:
            fate, sentence = FAILED, reason(error)
        wall, cpu = clock.perf_counter() - wall, clock.process_time() - cpu
        summary = json.loads(_text(out / "summary.json") or "{}")
        history = (out / "history.nc").read_bytes() if (out / "history.nc").exists() else b""
        shown = b"" if page is None else _page(out, page)
    particles = summary.get("particles") or 0
    rate, solving = summary.get("particle_steps_per_second"), summary.get("wall_time")
    cost = {
        "wall_seconds": wall,
        "cpu_seconds": cpu,
        "steps": float(summary.get("steps") or 0),
        "particle_steps": rate * solving if rate and solving else 0.0,
        "memory_bytes": float(expected_bytes(case, particles)),
    }
    return Outcome(fate, sentence, summary, cost, history, shown)


def _page(directory: Path, wanted: PageOf) -> bytes:
    """The page of a member; empty if it cannot be made, which must not lose the result of the run."""
    from ..report.page import page_of

    try:
        return page_of(directory, title=wanted.title, above=wanted.above, most=MOST_BYTES).encode()
    except Exception as error:
        LOGGER.warning("the page of '%s' was not made: %s", wanted.title, reason(error), exc_info=True)
        return b""


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8") if path.exists() else ""
