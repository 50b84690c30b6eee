"""One member's run, wherever it takes place: a process of its own here, or a machine far away."""

from __future__ import annotations

import tempfile
import time as clock
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import GuardStop, reason


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
    import json

    import meshio  # noqa: F401  these two write the results, and take longer to load than a small run lasts
    import xarray  # noqa: F401

    from ..case import parse_case
    from ..memory import expected_bytes
    from ..runner import run
    from ..solver.simulation import Simulation
    from ..threads import use_threads

    try:
        case = parse_case(data, ["output.report=false", f"output.frame_interval={data['until']!r}"])
        use_threads(threads, 1)
        Simulation(case).advance()
    except Exception as error:
        return Outcome("failed", reason(error), {}, {}, b"")
    fate, sentence = "finished", ""
    with tempfile.TemporaryDirectory() as place:
        out = Path(place) / "run"
        wall, cpu = clock.perf_counter(), clock.process_time()
        try:
            run(case, out, threads=threads)
        except GuardStop as stop:
            fate, sentence = stop.guard, reason(stop)
        except Exception as error:
            fate, sentence = "failed", reason(error)
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
