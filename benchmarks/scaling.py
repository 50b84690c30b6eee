"""Cost against particles, threads and the size of the domain; memory a particle; the overhead of a step."""

from __future__ import annotations

import argparse
import copy
import time
from dataclasses import replace
from statistics import median

import numba
import psutil

from mpmkit.bench import SCENES
from mpmkit.bench.midflow import in_mid_flow
from mpmkit.bench.timing import timed
from mpmkit.case import parse_case
from mpmkit.solver.memory import expected_bytes
from mpmkit.solver.simulation import Simulation

ROUNDS = 5


def with_cells(scene, cell_size: float, coarser: int):
    """A standard scene with other cells."""
    case = copy.deepcopy(scene.case)
    case["grid"]["cell_size"] = cell_size
    return replace(scene, case=case, coarser=coarser)


def in_turn(simulations: dict, threads: dict, seconds: float = 2.0) -> dict[str, float]:
    """Median nanoseconds a particle-step of several scenes, timed in turn."""
    found: dict[str, list[float]] = {name: [] for name in simulations}
    for _ in range(ROUNDS):
        for name, simulation in simulations.items():
            timing = timed(simulation, name, threads[name], seconds)
            found[name].append(1e9 / timing.particle_steps_per_second)
    return {name: median(times) for name, times in found.items()}


def particles() -> None:
    """The accurate set-up in three dimensions, one thread; the same flow on ever finer particles."""
    scene = SCENES["accurate-3d"]
    sizes = {0.04: 2, 0.02: 1, 0.01: 2, 0.005: 4, 0.0032: 5}
    simulations = {f"{size}": in_mid_flow(with_cells(scene, size, times)) for size, times in sizes.items()}
    times = in_turn(simulations, dict.fromkeys(simulations, 1))
    print("\n| particles | ns a particle-step, one thread |\n|---|---|")
    for name, simulation in simulations.items():
        print(f"| {len(simulation.particles):,} | {times[name]:.0f} |")


def threads() -> None:
    most = numba.config.NUMBA_NUM_THREADS
    print(f"\n| scene | one thread, ns | {most} threads, ns | times as fast |\n|---|---|---|---|")
    for name in ("seed-3d", "accurate-3d", "accurate-axisymmetric"):
        simulation = in_mid_flow(SCENES[name])
        both = {"one": simulation, "all": simulation}
        times = in_turn(both, {"one": 1, "all": most})
        print(f"| {name} | {times['one']:.1f} | {times['all']:.1f} | {times['one'] / times['all']:.2f} |")


def domain() -> None:
    """The same material in a domain of eight times the volume."""
    scene = with_cells(SCENES["accurate-3d"], 0.01, 2)
    wide = copy.deepcopy(scene.case)
    wide["grid"]["domain"] = {"x": [-0.72, 0.72], "y": [-0.72, 0.72], "z": [0, 0.64]}
    simulations = {"as it is": in_mid_flow(scene), "eight times": in_mid_flow(replace(scene, case=wide))}
    times = in_turn(simulations, dict.fromkeys(simulations, 1))
    print("\n| domain | ns a particle-step |\n|---|---|")
    for name, time_ in times.items():
        print(f"| {name} | {time_:.1f} |")


def memory() -> None:
    """What the process grows by as the scene is set up and run, against what ``plan`` says."""
    process = psutil.Process()
    print("\n| scene | particles | grown by, bytes a particle | said by plan |\n|---|---|---|---|")
    for name in ("seed-3d", "accurate-3d"):
        small = with_cells(SCENES[name], 0.02, 1)
        Simulation(parse_case(small.case)).advance()  # compiles, and loads what is loaded once
        case = parse_case(SCENES[name].case)
        before = process.memory_info().rss
        simulation = Simulation(case)
        peak = before
        for _ in range(10):
            simulation.advance()
            peak = max(peak, process.memory_info().rss)
        count = len(simulation.particles)
        grown, said = (peak - before) / count, expected_bytes(case, count) / count
        print(f"| {name} | {count:,} | {grown:.0f} | {said:.0f} |")


def overhead() -> None:
    """A step of a handful of particles: all but none of it is work on them."""
    case = copy.deepcopy(SCENES["small-axisymmetric"].case)
    case["grid"]["cell_size"] = 0.08
    case["grid"]["domain"] = {"r": [0, 0.4], "z": [0, 0.4]}
    case["bodies"][0]["particles_per_cell"] = 1
    simulation = Simulation(parse_case(case))
    numba.set_num_threads(1)
    for _ in range(50):
        simulation.advance()
    taken = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        for _ in range(400):
            simulation.advance()
        taken.append((time.perf_counter() - start) / 400)
    print(f"\nA step of {len(simulation.particles)} particles takes {1e6 * median(taken):.0f} µs.")


def main() -> None:
    argparse.ArgumentParser(description=__doc__).parse_args()
    memory()  # first, while there is nothing that could be used again
    overhead()
    threads()
    particles()
    domain()


if __name__ == "__main__":
    main()
