"""Run what docs/accuracy.md tells of, one member after the other; what is there is not run again.

    python docs/figures/accuracy_runs.py [NAME ...]

Takes about an hour and a half on one core. Results: runs/accuracy/NAME.json.
"""

import json
import time

import numba
import numpy as np
from members import EVERY, Member
from options import ROOT, parser

from mpmkit.errors import GuardStop

RUNS = ROOT / "runs/accuracy"
TIMES = np.round(np.arange(0, 4.001, 0.02), 2)
KEPT = ("spread_diameter", "height", "axis_height", "kinetic_energy", "fractured_fraction")


def run(member: Member) -> dict:
    simulation = member.simulation()
    rows: dict[str, list[float]] = {name: [] for name in KEPT}
    times, stopped = [], None
    start = time.perf_counter()
    for t in TIMES:
        try:
            while simulation.time < t * (1 - 1e-12):
                simulation.advance(t - simulation.time)
        except GuardStop as stop:
            stopped = str(stop)
            break
        found = simulation.measures(simulation.particles)
        times.append(float(t))
        for name in KEPT:
            rows[name].append(float(found[name]))
    return {
        "label": member.label,
        "time": times,
        **rows,
        "particles": len(simulation.particles),
        "steps": simulation.steps,
        "particle_steps": simulation.particle_steps,
        "wall_time": time.perf_counter() - start,
        "stopped": stopped,
    }


def main() -> None:
    arguments = parser()
    arguments.add_argument("names", nargs="*", metavar="NAME", help="members to run; default: all")
    wanted = arguments.parse_args().names
    numba.set_num_threads(1)
    RUNS.mkdir(parents=True, exist_ok=True)
    for member in EVERY:
        path = RUNS / f"{member.name}.json"
        if path.exists() or (wanted and member.name not in wanted):
            continue
        found = run(member)
        path.write_text(json.dumps(found))
        last = found["spread_diameter"][-1] * 1000
        print(
            f"{member.name:14} {last:7.1f} mm {found['wall_time']:7.1f} s  {found['stopped'] or ''}",
            flush=True,
        )


if __name__ == "__main__":
    main()
