"""How long the shipped cases take on this machine, from how long they took on another one.

``shipped_times.csv`` holds the seconds that each case took there, with one thread, and the seconds that the
``benchmark`` below took just before; benchmarks/shipped_times.py writes it. The benchmark gathers and
scatters as a step does: processors that are twice as fast at it run a case in about half of the time.
"""

from __future__ import annotations

import csv
import time
from pathlib import Path

import numpy as np

FILE = Path(__file__).with_name("shipped_times.csv")
PARTICLES, NODES, TRIES = 20_000, 2_000, 9


def benchmark() -> float:
    """Seconds, the least of some tries, for a fixed amount of work of the kind that a step is made of."""
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
    speed = benchmark()
    return {
        (row["name"], row["variant"]): float(row["seconds"]) * speed / float(row["benchmark"]) for row in rows
    }
