"""The standard scenes in two trees of the sources, in turn: how many times as fast this tree is as the other.

    python benchmarks/against_tree.py OTHER_PYTHON --scenes seed-3d accurate-3d --threads 2 --rounds 9

OTHER_PYTHON is the interpreter of an environment in which the other tree is installed. For each scene, each
tree has its own process with the scene in mid-flow. In each round, the two processes compute their steps one
after the other. Other users of the machine slow down both, so they have little influence on the median of the
ratios. The least times are those of the quietest round of each tree.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from statistics import median

WARM_UP = 3
WORKER = """
import copy, json, sys, time
from dataclasses import replace
import numba
from mpmkit.bench import SCENES
from mpmkit.bench.midflow import in_mid_flow
name, times, threads, steps = sys.argv[1], float(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
numba.set_num_threads(threads)
scene = SCENES[name]
case = copy.deepcopy(scene.case)
case["grid"]["cell_size"] *= times
simulation = in_mid_flow(replace(scene, case=case, coarser=max(1, round(scene.coarser / times))))
for line in sys.stdin:
    clocks = time.perf_counter(), time.process_time()
    for _ in range(steps):
        simulation.advance()
    done = 1e-9 * steps * len(simulation.particles)
    wall, cpu = time.perf_counter() - clocks[0], time.process_time() - clocks[1]
    print(json.dumps([wall / done, cpu / done, len(simulation.particles)]), flush=True)
"""


class Tree:
    """One tree with one scene in mid-flow."""

    def __init__(self, python: str, *arguments: object) -> None:
        command = [python, "-c", WORKER, *map(str, arguments)]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def round(self) -> list[float]:
        """Nanoseconds of the clock and of the processor for each particle-step, and the particles."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        print(file=self._process.stdin, flush=True)
        return json.loads(self._process.stdout.readline())

    def end(self) -> None:
        self._process.communicate()


def compare(name: str, arguments: argparse.Namespace) -> str:
    """A row of the table for one scene."""
    of_run = name, arguments.coarser, arguments.threads, arguments.steps
    trees = Tree(arguments.other, *of_run), Tree(sys.executable, *of_run)
    for tree in trees:
        for _ in range(WARM_UP):
            tree.round()
    rounds = []
    for k in range(arguments.rounds):  # who is first changes from round to round
        first, second = trees if k % 2 else trees[::-1]
        pair = [first.round(), second.round()]
        rounds.append(pair if k % 2 else pair[::-1])
    for tree in trees:
        tree.end()
    wall, cpu = ([(old[i], new[i]) for old, new in rounds] for i in range(2))
    cells = [f"{median(pair[i] for pair in clock):.1f}" for clock in (wall, cpu) for i in range(2)]
    ratios = [f"{median(old / new for old, new in clock):.2f}" for clock in (wall, cpu)]
    ratios.append(f"{min(old for old, _ in cpu) / min(new for _, new in cpu):.2f}")
    return f"| {name} | {rounds[0][1][2]:,} | {' | '.join(cells)} | {' | '.join(ratios)} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("other", metavar="OTHER_PYTHON", help="interpreter that has the other tree")
    scenes = ["seed-3d", "accurate-3d", "accurate-axisymmetric"]
    parser.add_argument("--scenes", nargs="+", default=scenes)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--steps", type=int, default=2, help="steps of a round; default: 2")
    parser.add_argument("--coarser", type=float, default=1.0, help="times the cell size; default: 1")
    arguments = parser.parse_args()
    print("| scene | particles | wall before | after | CPU before | after | wall ratio | CPU | least CPU |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name in arguments.scenes:
        print(compare(name, arguments), flush=True)


if __name__ == "__main__":
    main()
