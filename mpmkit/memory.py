"""How much memory a case needs, before anything is allocated."""

from __future__ import annotations

import numpy as np
import psutil

from .case.model import Case
from .errors import CaseError
from .geometry import expected_count
from .kernels.scatter import NODE
from .solver.scene import kept_box, particles_along_axes

BYTES = 8
PARTICLE_SCALARS = 8
"""number, body, mass, initial volume, volume, volume ratio, pressure, volumetric rate."""


def expected_particles(case: Case) -> float:
    """Particles of a case, from the exact volumes of its bodies."""
    return sum(
        expected_count(
            body.shape,
            case.space_,
            case.grid.cell_size,
            particles_along_axes(body, case.space_.dim),
            keep=kept_box(case),
        )
        for body in case.bodies
    )


def bytes_per_particle(case: Case) -> int:
    """Bytes a particle of a case: its state, its tables of weights, and its share of a sort's copies."""
    dim, support = case.space_.dim, case.scheme.shape.support
    tracks = case.scheme.shape.particle_domain == "stretch" or any(
        body.material.constitutive_law.needs_deformation_gradient for body in case.bodies
    )
    laws = [body.material.constitutive_law for body in case.bodies]
    state = max(sum(int(np.prod(v.shape)) for v in law.state.values()) for law in laws)
    doubles = PARTICLE_SCALARS + 4 * dim + 9 + 6 + (9 if tracks else 0) + state  # vectors, L, stress, F
    tables = 2 * dim * support + (support if case.space_.radial else 0) + dim / 2
    sorting = 9 + 4  # a copy of the largest array; keys and order
    return int(BYTES * (doubles + tables + sorting))


def expected_bytes(case: Case, particles: float) -> int:
    """Memory that a run of the case takes, without Python and its libraries."""
    cells = case.grid.cell_size
    volume = particles * float(np.prod([cells] * case.space_.dim)) / np.prod(
        particles_along_axes(case.bodies[0], case.space_.dim)
    )
    # The window is the material's bounding box; a body is rarely emptier than a tenth of its box.
    nodes = 10 * volume / cells**case.space_.dim
    return int(particles * bytes_per_particle(case) + nodes * NODE * BYTES)


def require_memory(case: Case) -> None:
    """Refuse a case that needs more memory than the machine has.

    Raises:
        CaseError: says how much is needed and how much there is.
    """
    particles = expected_particles(case)
    needed, there = expected_bytes(case, particles), psutil.virtual_memory().total
    if needed > there:
        raise CaseError(
            f"grid.cell_size is {case.grid.cell_size:g} m, which makes about {particles:.3g} particles and needs "
            f"{needed / 2**30:.3g} GiB of memory, more than the {there / 2**30:.3g} GiB of this machine; "
            "use larger cells, fewer particles a cell, or a symmetry plane"
        )
