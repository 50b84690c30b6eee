"""Particle-steps per second, and the time of each operation."""

from __future__ import annotations

import time as clock
from collections import defaultdict
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

from ..running.threads import using_threads
from ..solver.simulation import Simulation
from .midflow import in_mid_flow
from .scenes import BenchScene

WARM_UP = 3
"""Steps before the clock starts: kernels are compiled or loaded, particles sorted."""
KERNELS = {
    "sorting": ("_sort",),
    "weights": ("_evaluate_shapes",),
    "particles to nodes": ("_map",),
    "nodes": ("map_to_grid", "solve_momentum", "_fold"),
    "nodes to particles": ("_take",),
    "averages": ("sums", "at_nodes", "at_particles"),
    "volumes": ("_update_volumes", "_follow_domains", "_treated", "_pressure", "relax_volume"),
    "law": ("_update_law",),
    "redistribution": ("redistribute_if_due",),
}
"""The parts of a step, and the methods that do them; the rest of a step is outside the kernels."""


@dataclass(frozen=True)
class Timing:
    """Speed of a scene. ``kernels`` has the nanoseconds per particle-step of each part of a step."""

    scene: str
    particles: int
    threads: int
    particle_steps_per_second: float
    kernels: dict[str, float]

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def time_scene(scene: BenchScene, threads: int | None = None, seconds: float = 5.0) -> Timing:
    """Time full steps of a scene in mid-flow, with all operations of a real run.

    Args:
        scene: one of ``SCENES``.
        threads: threads to use; default: as many as are useful.
        seconds: duration of the measurement, s.
    """
    return timed(in_mid_flow(scene), scene.name, threads, seconds)


def timed(simulation: Simulation, name: str, threads: int | None, seconds: float) -> Timing:
    """As ``time_scene``, for a simulation that exists; it advances."""
    with using_threads(threads, len(simulation.particles)) as used:
        return _timed(simulation, name, used, seconds)


def _timed(simulation: Simulation, name: str, threads: int, seconds: float) -> Timing:
    for _ in range(WARM_UP):
        simulation.advance()
    particles = len(simulation.particles)
    operations = simulation.operations
    watch = Stopwatch(operations, operations.averager)
    watch.watch(operations.stage, "redistribute_if_due")
    begin, before = clock.perf_counter(), simulation.particle_steps
    while (spent := clock.perf_counter() - begin) < seconds or simulation.particle_steps == before:
        simulation.advance()
    watch.remove()
    done = simulation.particle_steps - before
    nanoseconds = 1e9 / done
    kernels = {
        name: nanoseconds * sum(watch.spent[operation] for operation in operations)
        for name, operations in KERNELS.items()
    }
    kernels["outside"] = nanoseconds * spent - sum(kernels.values())
    return Timing(name, particles, threads, done / spent, kernels)


class Stopwatch:
    """Adds up the time in each operation of a scene, without the time in the operations that it calls."""

    def __init__(self, *owners: Any) -> None:
        self.spent: dict[str, float] = defaultdict(float)
        self._inner = [0.0]
        self._watched: list[tuple[Any, str]] = []
        for owner in owners:
            for name in dir(type(owner)):
                if not name.startswith("__") and callable(getattr(owner, name)) and name != "step":
                    self.watch(owner, name)

    def watch(self, owner: Any, name: str) -> None:
        """Add up the time in this operation, too."""
        setattr(owner, name, self._timed(name, getattr(owner, name)))
        self._watched.append((owner, name))

    def remove(self) -> None:
        for owner, name in self._watched:
            delattr(owner, name)

    def _timed(self, name: str, operation: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **options: Any) -> Any:
            self._inner.append(0.0)
            start = clock.perf_counter()
            try:
                return operation(*arguments, **options)
            finally:
                whole = clock.perf_counter() - start
                self.spent[name] += whole - self._inner.pop()
                self._inner[-1] += whole

        return call
