"""How much memory a case needs, before anything is allocated."""

from __future__ import annotations

import math

import numpy as np

from ..case.model import Case
from ..case.output import ROWS
from ..case.plugins import plugins_of
from ..case.sources import row_length, section_of
from ..case.state_variables import particle_variables
from ..contracts.law import initial_state
from ..errors import CaseError
from ..geometry import expected_count
from ..kernels.scatter import NODE, PAIR
from ..kernels.splines import SUPPORT
from ..kernels.wall_reach import NEAR
from ..registry import audit
from ..registry.blame import blaming_plugins
from .available_memory import tightest_limit
from .redistribution import redistributes
from .scene import tracks_deformation
from .walls.wall_nodes import MARGIN as NEAR_MARGIN

DOUBLE = 8
INDEX = 4
PASSING = 4
"""Temporary doubles per particle: keys and order of a sort, or averages and those of a law."""
DOUBLES_PER_NODE = NODE + PAIR + 1 + 3
"""Doubles per node: its record, sums of an average, the average, its volume, its crowding, and their sums."""
MIRRORED = 3
"""Doubles per node of a redistribution's lattice: its sum, its crowding, and its volume."""
COPY = 1.125
"""Size of a checkpoint's buffer relative to its content: Python's buffers grow by an eighth at a time."""
LOOKED_AT = 1 << 12
"""Most points at which the nodes near a wall are counted."""
MARGIN = 5
"""Nodes along an axis that the window has in addition to the cells of the material."""


def expected_particles(case: Case, until: float | None = None) -> float:
    """Number of particles of a case: of its bodies, from their exact volumes, and of all that comes in.

    It comes in by the time ``until``, s; default: the end of the run.
    """
    with blaming_plugins(plugins_of(case)):
        return incoming_particles(case, case.end if until is None else until) + sum(
            expected_count(
                body.shape,
                case.space_,
                case.grid.cell_size,
                body.particles_along_axes(case.space_.dim),
                keep=case.domain_bounds,
            )
            for body in case.bodies
        )


def incoming_particles(case: Case, until: float) -> float:
    """Number of particles that sources bring in by a time, s."""
    return sum(
        len(section_of(case, name).area)
        * one.source.pushed(until, case.mouth_area(name), one.material.density)
        / row_length(case, name)
        for name, one in case.sources.items()
    )


def expected_bytes(case: Case, particles: float) -> int:
    """Memory of a run at its start, without the 200 MB or so of Python and its libraries.

    As the material spreads, the window of nodes grows; but particles need most of the memory.
    """
    kept = _kept_rows(case) * _doubles_per_row(case) * DOUBLE
    of_particles = particles * (bytes_per_particle(case) + kept)
    return int(of_particles + window_nodes(case) * _doubles_per_node(case) * DOUBLE + wall_bytes(case))


def checkpoint_bytes(case: Case, particles: float) -> int:
    """Temporary memory while a checkpoint is written.

    It is a copy of the state of all particles, of their last weights, and of the rows of the history that
    are kept.
    """
    kept = _kept_rows(case) * _doubles_per_row(case) / 2
    weights = case.space_.dim * case.scheme.shape.support
    return int(COPY * particles * DOUBLE * (_state_doubles(case) + weights + kept))


def bytes_per_particle(case: Case) -> int:
    """Bytes per particle: its state, its tables of weights, and temporary data."""
    dim, support = case.space_.dim, case.scheme.shape.support
    tables = 2 * dim * support + support * case.space_.radial
    body_and_base = (1 + dim) * INDEX
    doubles = _state_doubles(case) + tables + PASSING + _of_forces(case)
    return int(DOUBLE * doubles + body_and_base + _redistributed(case))


def _of_forces(case: Case) -> int:
    """Temporary doubles per particle of forces: places, velocities, sum, and each acceleration."""
    forces = case.varying_forces.values()
    if not forces:
        return 0
    same = all(force.uniform for force in forces)
    return case.space_.dim * (2 if same else 5 + len(forces))


def _redistributed(case: Case) -> int:
    """Temporary bytes per particle of a redistribution: places of splines, its shift, parts of boxes.

    The weights of the splines lie in the tables of the step, if these are large enough.
    """
    if not redistributes(case.scheme.redistribution):
        return 0
    dim = case.space_.dim
    splines = 2 * dim * SUPPORT if case.scheme.shape.support < SUPPORT else 0
    bases, shift, parts, numbers = 2 * dim, dim, 2 * dim, 4
    return INDEX * bases + DOUBLE * (splines + shift + parts + numbers)


def _doubles_per_node(case: Case) -> float:
    """Doubles per node, including those of a finer lattice if there is a redistribution."""
    if not redistributes(case.scheme.redistribution):
        return DOUBLES_PER_NODE
    dim = case.space_.dim
    finest = max(max(one.particles_along_axes(dim)) for one in case.filled)
    return DOUBLES_PER_NODE + MIRRORED * (1 + finest**dim)


def _state_doubles(case: Case) -> int:
    """Doubles that a particle carries from step to step."""
    dim = case.space_.dim
    laws = [material.constitutive_law for material in case.materials.values()]
    with blaming_plugins(plugins_of(case)):  # plug-ins define what a particle carries
        state = max(sum(value.size for value in initial_state(law, 1).values()) for law in laws)
        has_domain = audit.particle_domain(case.scheme.shape) != "fixed"
    number_mass_volumes_pressures_rates_parts_age = 12
    vectors = 4 * dim + dim * has_domain
    affine = dim * dim * case.scheme.velocity.affine
    gradient_and_stress = 9 + 6
    return (
        number_mass_volumes_pressures_rates_parts_age
        + vectors
        + affine
        + gradient_and_stress
        + 9 * tracks_deformation(case)
        + state
    )


def window_nodes(case: Case) -> float:
    """Nodes that are stored: those around the bodies at the start, or the mouths and the material that comes
    in, and a quarter more."""
    lower, upper = _extent(case)
    return 1.25 * float(np.prod((upper - lower) / case.grid.cell_size + MARGIN))


def _extent(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner, m, of the box around all bodies, cut at the domain."""
    bounds = [body.shape.bounds(case.space_) for body in case.bodies]
    bounds += [
        (np.array(mouth.centre) - mouth.half_width, np.array(mouth.centre) + mouth.half_width)
        for mouth in case.mouths.values()
    ]
    domain_lower, domain_upper = case.domain_bounds
    lower = np.maximum(np.min([low for low, _ in bounds], axis=0), domain_lower)
    upper = np.minimum(np.max([high for _, high in bounds], axis=0), domain_upper)
    return lower, upper


def wall_bytes(case: Case) -> float:
    """Memory of the walls: some data for every node of the window, and more for nodes near a wall."""
    dim, corners = case.space_.dim, 1 << case.space_.dim
    number_place_and_face, free_distance_and_push, marks = 3 * dim * DOUBLE, 3 * DOUBLE, 2
    found_normal_and_velocity, kinds_of_node, distance = 4 * dim, 5, 1
    around, pushes, impulses = 6 * corners, (1 + corners) + (1 + 2 * dim) + 2, 4 * dim
    of_near = found_normal_and_velocity + kinds_of_node + distance + around + pushes + impulses
    nodes, total = window_nodes(case), 0.0
    with blaming_plugins(plugins_of(case)):
        for wall in case.walls.values():
            memory = len(wall.contact.memory) * DOUBLE
            total += nodes * (number_place_and_face + free_distance_and_push + marks + memory)
            total += nodes * _part_near(audit.placed(wall.surface, case.space_), case) * of_near * DOUBLE
    return total


def _part_near(surface: audit.AuditedSurface, case: Case) -> float:
    """Part of the nodes of the window that is near a wall at the start."""
    lower, upper = _extent(case)
    count = max(2, round(LOOKED_AT ** (1 / len(lower))))
    places = np.indices((count,) * len(lower)).reshape(len(lower), -1).T + 0.5
    around = MARGIN / 2 * case.grid.cell_size
    places = lower - around + places * (upper - lower + 2 * around) / count
    distance, _ = surface.distance(places, 0.0)
    return float(np.mean(np.abs(distance) <= (NEAR + NEAR_MARGIN) * case.grid.cell_size))


def _kept_rows(case: Case) -> float:
    interval = case.output.history_interval
    return ROWS if interval is None else case.end / interval


def _doubles_per_row(case: Case) -> int:
    """Doubles per particle and row of the history, counted twice: again while the file is written."""
    width = {"component": case.space_.dim, "tensor_component": 6}
    known = particle_variables(case)
    fields = [known[name] for name in case.output.particle_history]
    return 2 * sum(math.prod(f.shape or [width[dimension] for dimension in f.trailing]) for f in fields)


def require_memory(case: Case) -> None:
    """Refuse a case that needs more memory than is available, its first checkpoint included.

    Raises:
        CaseError: the sentence gives the needed and the available memory.
    """
    particles = expected_particles(case)
    needed = expected_bytes(case, particles) + checkpoint_bytes(case, particles)
    there, limit = tightest_limit()
    if needed > there:
        if window_nodes(case) * _doubles_per_node(case) * DOUBLE > needed / 2:
            raise CaseError(_too_wide(case, needed, f"{_gib(there)} is left for this run {limit}"))
        fewer_rows = "fewer rows of output.particle_history, " if case.output.particle_history else ""
        raise CaseError(
            f"grid.cell_size is {case.grid.cell_size:g} m, which makes about {particles:.3g} particles "
            f"and needs {_gib(needed)} of memory, but {_gib(there)} is left for this run {limit}; "
            f"use larger cells, fewer particles per cell, {fewer_rows}or a symmetry plane"
        )


def _too_wide(case: Case, needed: float, left: str) -> str:
    """The sentence if the nodes around and between the bodies need the memory, and not the particles."""
    lower, upper = _extent(case)
    spans = " × ".join(f"{span:.4g}" for span in upper - lower)
    between = ", the gap between them included," if len(case.filled) > 1 else ""
    closer = ", or bring the bodies closer together" if between else ""
    return (
        f"grid.cell_size is {case.grid.cell_size:g} m, and the window over all bodies{between} spans "
        f"{spans} m: its {window_nodes(case):.3g} nodes need {_gib(needed)} of memory, but "
        f"{left}; use larger cells{closer}"
    )


def _gib(size: float) -> str:
    return f"{size / 2**30:.3g} GiB"
