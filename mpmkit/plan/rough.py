"""The time of a run from its case alone: rough, but at once, for many cases and without running any."""

from __future__ import annotations

import math

from ..case.model import Case
from ..solver.memory import expected_particles
from ..solver.scene import material_group
from ..solver.time_step import choose_step, limits

STEP = 1e-4
"""Seconds that a step takes beside its particles."""
RATE = {2: 3e6, 3: 1e6}
"""Particles that a core moves on by a step in a second, by the number of dimensions (docs/performance.md)."""


def rough_seconds(case: Case, threads: int = 1) -> float:
    """Seconds that a run takes, give or take a factor of three.

    From the step at the start and the particles at the start: a sound speed that follows the flow, and
    particles that are split, are left out.
    """
    groups = [material_group(case, body.material, slice(0, 0)) for body in case.bodies]
    materials = [(group, group.wave_speed) for group in groups]
    fastest = max(body.largest_speed for body in case.bodies)
    step, _ = choose_step(case.scheme, limits(materials, case.grid.cell_size, fastest, case.scale.rate))
    particles = expected_particles(case)
    if not step > 0:
        return math.inf
    return case.end / step * (STEP + particles / RATE[case.space_.dim] / threads)
