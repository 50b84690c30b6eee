"""A rough estimate of the run time from the case alone, without running it."""

from __future__ import annotations

import math

from ..case.model import Case
from ..solver.memory import expected_particles
from ..solver.scene import material_group
from ..solver.time_step import choose_step, limits

STEP = 1e-4
"""Seconds per step, without the cost of particles."""
RATE = {2: 3e6, 3: 1e6}
"""Particle-steps per second and core, by the number of dimensions (docs/performance.md)."""


def rough_seconds(case: Case, threads: int = 1) -> float:
    """Seconds that a run takes, within a factor of about three.

    The estimate uses the step and the particles at the start. It neglects sound speeds that follow the flow,
    and splitting of particles.
    """
    groups = [material_group(case, material, slice(0, 0)) for material in case.materials.values()]
    materials = [(group, group.wave_speed) for group in groups]
    fastest = max(
        [0.0, *map(case.speed_at_start, case.bodies)]
        + [case.source_speed(name, 0.0, case.end) for name in case.sources]
    )
    step, _ = choose_step(case.scheme, limits(materials, case.grid.cell_size, fastest, case.scale.rate))
    particles = expected_particles(case)
    if not step > 0:
        return math.inf
    return case.end / step * (STEP + particles / RATE[case.space_.dim] / threads)
