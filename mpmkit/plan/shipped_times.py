"""Run times of the shipped cases on this machine, estimated without running them.

``shipped_work.csv`` holds the work of each case, the steps and the particle-steps of a run, which are the
same on every machine; docs/figures/lab_pages.py writes it. The costs of a step and of a particle-step were
measured on one quiet machine with one thread, output included, on six cases (slump, fast, with its mould, in
3-D, slump test, L-box), together with the ``benchmark`` below, which gathers and scatters as a step does. A
processor that is twice as fast in it is assumed to run a case in half of the time.
The estimate is right within a factor of about two; ``mpmkit plan`` measures the case itself.
"""

from __future__ import annotations

import csv
import time
from pathlib import Path

import numpy as np

FILE = Path(__file__).with_name("shipped_work.csv")
STEP = 0.8e-3
"""Seconds per step, without the cost of particles, for a scene with one or two walls."""
PARTICLE_STEP = {2: 0.25e-6, 3: 0.62e-6}
"""Seconds per particle-step, by the number of dimensions."""
BENCHMARK = 0.61e-3
"""Seconds of the benchmark on the machine on which these were measured."""
PARTICLES, NODES, TRIES = 20_000, 2_000, 9


def benchmark() -> float:
    """Seconds, the least of several tries, for a fixed amount of work similar to that of a step."""
    places = (np.arange(PARTICLES) * 7919) % NODES
    weights = np.linspace(0.1, 1.0, PARTICLES)
    best = np.inf
    for _ in range(TRIES):
        start = time.perf_counter()
        nodes = np.bincount(places, weights, NODES)
        for _ in range(10):
            nodes = np.bincount(places, weights * np.sqrt(nodes[places]), NODES)
        best = min(best, time.perf_counter() - start)
    return float(best)


def shipped_seconds() -> dict[tuple[str, str], float]:
    """Expected seconds by the name of a shipped case and its variant, ``coarse`` or ``fine``."""
    with FILE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    slower = benchmark() / BENCHMARK
    return {
        (row["name"], row["variant"]): slower
        * (float(row["steps"]) * STEP + float(row["particle_steps"]) * PARTICLE_STEP[int(row["dimensions"])])
        for row in rows
    }
