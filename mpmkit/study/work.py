"""One member's run, wherever it takes place: a process of its own here, or a machine far away."""

from __future__ import annotations

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
"""Fate of a member that could not be run, or met an error that no guard knows."""
MOMENT = 1e-9
"""Part of a run that is one step, with which all code is loaded."""
TURN = threading.Lock()
"""One member at a time in a process, where an executor works with threads: the CPU's clock, numba's threads
and NetCDF's library are the whole process's."""


@dataclass(frozen=True)
class Outcome:
    """What became of a member; all of it can travel from one machine to another."""

    fate: str
    """``finished``, or the name of the guard that stopped it, or ``failed``"""
    sentence: str
    """what there is to say of a bad end"""
    summary: dict[str, Any]
    cost: dict[str, float]
    """wall_seconds, cpu_seconds, steps, particle_steps, memory_bytes"""
    history: bytes
    """of ``history.nc``; empty where there is none"""


def run_member(data: dict[str, Any], threads: int) -> Outcome:
    """Run a case and return what it did; nothing is left behind on the machine that ran it.

    The seconds are those of the run itself: kernels are loaded, or compiled, before the clock starts.
    """
    with TURN, np.errstate(all="ignore"):  # its guard reports a run that diverges
        return _run(data, threads)


def _run(data: dict[str, Any], threads: int) -> Outcome:
    import json

    from ..case import parse_case
    from ..case.ending import latest
    from ..running.runner import run
    from ..solver.memory import expected_bytes, require_memory

    try:
        case = parse_case(data, ["output.report=false", f"output.frame_interval={latest(data['until'])!r}"])
        require_memory(case)
    except Exception as error:
        return Outcome(FAILED, reason(error), {}, {}, b"")
    fate, sentence = "finished", ""
    with tempfile.TemporaryDirectory() as place:
        with suppress(Exception):  # which the run meets again, as something to tell of
            moment = case.model_copy(update={"until": MOMENT * case.end})
            run(moment, Path(place) / "moment", threads=threads)
        out = Path(place) / "run"
        wall, cpu = clock.perf_counter(), clock.process_time()
        try:
            run(case, out, threads=threads)
        except GuardStop as stop:
            fate, sentence = stop.guard, reason(stop)
        except Exception as error:
            fate, sentence = FAILED, reason(error)
        wall, cpu = clock.perf_counter() - wall, clock.process_time() - cpu
        summary = json.loads(_text(out / "summary.json") or "{}")
        history = (out / "history.nc").read_bytes() if (out / "history.nc").exists() else b""
    particles = summary.get("particles") or 0
    rate, solving = summary.get("particle_steps_per_second"), summary.get("wall_time")
    cost = {
        "wall_seconds": wall,
        "cpu_seconds": cpu,
        "steps": float(summary.get("steps") or 0),
        "particle_steps": rate * solving if rate and solving else 0.0,
        "memory_bytes": float(expected_bytes(case, particles)),
    }
    return Outcome(fate, sentence, summary, cost, history)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8") if path.exists() else ""
