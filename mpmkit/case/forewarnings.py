"""Known problems of a scene, reported before the run: one sentence each.

Plug-ins report their own problems (``Plugin.cautions``); this module reports those of bodies, walls and
gravity.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations, islice

import numpy as np

from ..registry import audit
from ..registry.blame import blaming_plugins
from .bodies import Body
from .material import Material
from .model import Case
from .plausibility import implausible
from .walls import ROUNDING, wall_between

CLOSED = ("slip", "stick", "symmetry")
PULLING = ("symmetry",)
"""Faces that fix the normal velocity of material at them, whether it presses or leaves."""
MOST = 5
"""Most sentences of one kind; for a hundred drops, five pairs are enough."""
CONTIGUOUS = 1e-6
"""Largest gap, in cells, between two pieces of one solid; a wider gap is intended to be open."""
ENOUGH_IN_3D = 27
"""Particles per cell, see docs/stability/long_shear.md."""
ENOUGH_OF_A_WALL = 3.0
"""Cells: a wall with material on both sides needs one and a half for each, as far as splines reach."""
SURELY_HELD = 2**0.5
"""Cells: a bar of this diameter has a node in it wherever it stands, in a scene in which it is a disc."""
NOTICED = 0.1
"""Least part of gravity directed away from a wall that gives a sentence."""


def forewarnings(case: Case) -> list[str]:
    """A sentence for each known problem of the scene, and for each implausible value."""
    kinds = (_falls_out, _hangs, _swings_off, _thin, _touching, _few_particles, _needless, implausible)
    with np.errstate(all="ignore"):  # products of the numbers of a case may overflow
        return [sentence for kind in kinds for sentence in islice(kind(case), MOST)]


# --- Particles


def _few_particles(case: Case) -> Iterator[str]:
    """3-D fluids with too few particles per cell to keep their yield stress when particles are disordered."""
    if case.space_.dim < 3 or not case.scheme.redistribution.equal_boxes:
        return
    for where, body in zip(case.materials, case.filled, strict=True):
        count = math.prod(body.particles_along_axes(case.space_.dim))
        if count < ENOUGH_IN_3D and body.material.constitutive_law.uses_equation_of_state:
            yield (
                f"{where.removesuffix('.material')} has {count} particles per cell: in three dimensions a "
                "fluid that is sheared far flows too easily with fewer than "
                f"{ENOUGH_IN_3D} (a slump at 10 mm spread 1.6 % too far "
                "with 8, 0.2 % with 27); see particles_per_cell"
            )


def _needless(case: Case) -> Iterator[str]:
    """Settings without effect because a redistribution keeps boxes of equal sides."""
    scheme = case.scheme
    if not scheme.redistribution.equal_boxes:
        return
    fluids = [one for one in case.filled if one.material.constitutive_law.uses_equation_of_state]
    kept = f"scheme.redistribution '{scheme.redistribution.name}' keeps boxes of fluids of equal sides"
    if scheme.splitting and fluids:
        name = scheme.refinement.name
        yield f"scheme.refinement is '{name}', but {kept}, which are hardly ever longer than a cell"
    if scheme.shape.particle_domain == "stretch" and fluids:
        yield f"{kept}: the domain 'stretch' of scheme.shape '{scheme.shape.name}' acts on solids only"


# --- Walls


def _falls_out(case: Case) -> Iterator[str]:
    """Bodies without support that gravity moves to an open face before the end."""
    g = case.gravity_at_start
    if not g.any():
        return
    axis = int(np.argmax(np.abs(g)))
    side = _side(case, axis, upwards=g[axis] > 0)
    if case.grid.faces.get(side, "open") != "open":
        return
    held = [
        number
        for number, body in enumerate(case.bodies)
        if _is_held(case, body, axis) or _has_a_wall_below(case, body, axis)
    ]
    for number, body in enumerate(case.bodies):
        if number in held or any(_is_below(case, case.bodies[other], body, axis) for other in held):
            continue
        lower, upper = _bounds(case, body)
        ends = case.grid.domain[case.space_.axes[axis]]
        distance = float(ends[1] - upper[axis]) if g[axis] > 0 else float(lower[axis] - ends[0])
        speed = float(case.velocity_at_start(body)[axis] * np.sign(g[axis]))
        pull = abs(float(g[axis]))
        if _is_a_sink(case, axis, upper=bool(g[axis] > 0)):
            continue
        time = (math.hypot(speed, math.sqrt(2 * pull * max(0.0, distance))) - speed) / pull
        if time <= case.end:
            when = "at once" if time < 1e-6 * case.end else f"after about {time:.2g} s"
            yield (
                f"bodies.{number} has no floor: gravity pulls it to the face {side}, which is open, and it "
                f'leaves the grid there {when}; for a floor write "{side}": "stick", or "slip", in grid.faces'
            )


def _is_a_sink(case: Case, axis: int, upper: bool) -> bool:
    """Whether a sink takes material at the middle of a face."""
    lower_end, upper_end = case.domain_bounds
    beyond = (lower_end + upper_end) / 2
    beyond[axis] = upper_end[axis] + case.grid.cell_size if upper else lower_end[axis] - case.grid.cell_size
    with blaming_plugins([("sink", sink) for sink in case.sinks.values()]):
        return any(np.any(sink.takes(beyond[None], 0.0, case.domain_bounds)) for sink in case.sinks.values())


def _hangs(case: Case) -> Iterator[str]:
    """Bodies that gravity or their own motion would move away from a symmetry face, which holds them."""
    g = case.gravity_at_start
    for axis in range(case.space_.dim):
        for upwards in (False, True):
            side = _side(case, axis, upwards)
            face = case.grid.faces.get(side)
            if face not in PULLING or (case.space_.radial and side == "r_min"):
                continue
            inward = -1.0 if upwards else 1.0
            for number, body in enumerate(case.bodies):
                moves = inward * case.velocity_at_start(body)[axis] > 0
                falls = inward * g[axis] > NOTICED * float(np.linalg.norm(g)) > 0
                opposite = case.grid.faces.get(_side(case, axis, not upwards))
                between = opposite in CLOSED and _touches(case, body, axis, not upwards)
                if (moves or falls) and not between and _touches(case, body, axis, upwards):
                    why = "gravity pulls" if falls else "its velocity takes"
                    yield (
                        f"bodies.{number} hangs from the face {side}: {why} it away from there, but a "
                        f'"{face}" face does not release material that touches it; "slip" does'
                    )


def _swings_off(case: Case) -> Iterator[str]:
    """Bodies that a standing wave moves away from a slip wall, which does not pull, without weight on it."""
    for number, body in enumerate(case.bodies):
        fluid = body.material.constitutive_law.uses_equation_of_state
        if (
            body.velocity is None
            or isinstance(body.velocity, list)
            or (fluid and case.gravity_at_start.any())
        ):
            continue
        for axis in (axis for axis, size in enumerate(body.velocity.amplitude) if size):
            for upwards in (False, True):
                side = _side(case, axis, upwards)
                if case.grid.faces.get(side) == "slip" and _touches(case, body, axis, upwards):
                    yield (
                        f'bodies.{number} is not held by the face {side}: it oscillates, and a "slip" wall '
                        "pushes but does not pull, unlike in versions before 0.8; for a plane that holds it "
                        f'write "{side}": "symmetry" in grid.faces'
                    )


def _thin(case: Case) -> Iterator[str]:
    """Walls with material on both sides in which weights of the two sides overlap."""
    for name, wall in case.walls.items():
        cells = audit.placed(wall.surface, case.space_).thickness / case.grid.cell_size
        if cells < SURELY_HELD * (1 - ROUNDING):
            yield (
                f"walls.{name} is {cells:.2g} cells thick: a wall acts through the nodes in it, and a bar of "
                "fewer than 1.41 cells may have none, and let material through; make the cells smaller"
            )
        elif cells < ENOUGH_OF_A_WALL * (1 - ROUNDING):
            yield (
                f"walls.{name} is {cells:.2g} cells thick: the nodes in it that belong to its other side are "
                "within reach of the material, so the pressure on it can be wrong by a tenth, and energy can "
                f"be created; make it at least {ENOUGH_OF_A_WALL:g} cells thick, or the cells smaller"
            )


# --- Bodies that touch


def _touching(case: Case) -> Iterator[str]:
    """Pairs of bodies that touch or will touch, and are not two pieces of one body."""
    materials: list[Material] = []
    for body in case.bodies:
        if body.material not in materials:
            materials.append(body.material)
    of = [materials.index(body.material) for body in case.bodies]
    fluid = [material.constitutive_law.uses_equation_of_state for material in materials]
    for i, j in combinations(range(len(case.bodies)), 2):
        a, b = case.bodies[i], case.bodies[j]
        at_one = a.velocity == b.velocity and a.initial == b.initial
        if (
            of[i] == of[j]
            and at_one
            and (fluid[of[i]] or _gap(case, a, b) <= CONTIGUOUS * case.grid.cell_size)
        ):
            continue  # two pieces of one body
        if not _meet(case, a, b):
            continue
        if of[i] != of[j] and fluid[of[i]] and fluid[of[j]]:
            yield (
                f"bodies.{i} and bodies.{j} are two fluids that touch, or will touch: if they move along "
                "each other they lose energy that they should keep (a wave between two thin liquids lost all "
                "of it in less than a period), so do not trust their motion"
            )
        else:
            yield (
                f"bodies.{i} and bodies.{j} touch, or will touch: bodies share the velocity of the grid, so "
                "they stop 0.5 to 1.1 cells apart, drag each other without any friction in the case, and do "
                "not separate as they should; there is no contact between bodies yet"
            )


def _meet(case: Case, a: Body, b: Body) -> bool:
    """Whether two bodies are within a cell of each other, or move or fall towards each other."""
    if _gap(case, a, b) <= case.grid.cell_size:
        return bool(case.gravity_at_start.any()) or any(map(case.speed_at_start, (a, b)))
    relative = (case.velocity_at_start(b) - case.velocity_at_start(a)) * case.end
    if relative.any() and _gap(case, a, b, relative) <= case.grid.cell_size:
        return True
    if not case.gravity_at_start.any():
        return False
    axis = int(np.argmax(np.abs(case.gravity_at_start)))
    return _is_below(case, a, b, axis) or _is_below(case, b, a, axis)


def _gap(case: Case, a: Body, b: Body, shift: np.ndarray | None = None) -> float:
    """Distance, m, of the boxes around two bodies, with the second box extended by ``shift``."""
    (low_a, high_a), (low_b, high_b) = _bounds(case, a), _bounds(case, b)
    shift = np.zeros(case.space_.dim) if shift is None else shift
    low_b, high_b = low_b + np.minimum(shift, 0), high_b + np.maximum(shift, 0)
    apart = np.maximum(np.maximum(low_b - high_a, low_a - high_b), 0.0)
    return float(np.linalg.norm(apart))


def _is_below(case: Case, lower: Body, upper: Body, axis: int) -> bool:
    """Whether the second body would fall on the first, along the axis on which gravity acts most."""
    (low_a, high_a), (low_b, high_b) = _bounds(case, lower), _bounds(case, upper)
    others = [a for a in range(case.space_.dim) if a != axis]
    over = all(low_a[a] < high_b[a] and low_b[a] < high_a[a] for a in others)
    tolerance = 1e-6 * case.grid.cell_size
    if case.gravity_at_start[axis] < 0:
        return bool(over and low_b[axis] >= high_a[axis] - tolerance)
    return bool(over and high_b[axis] <= low_a[axis] + tolerance)


def _is_held(case: Case, body: Body, axis: int) -> bool:
    """Whether a body is at a wall that could hold it against gravity along an axis."""
    faces = case.grid.faces
    for a in range(case.space_.dim):
        for upwards in (False, True):
            face = faces.get(_side(case, a, upwards), "open")
            rough = face == "stick" or not isinstance(face, str)
            if (rough or (a == axis and face in CLOSED)) and _touches(case, body, a, upwards):
                return True
    return False


def _has_a_wall_below(case: Case, body: Body, axis: int) -> bool:
    """Whether a part of a wall is between a body and the face in the direction of gravity."""
    if not case.walls:
        return False
    (lower, upper), (least, most) = _bounds(case, body), case.domain_bounds
    if case.gravity_at_start[axis] < 0:
        lower[axis], upper[axis] = least[axis], lower[axis]
    else:
        lower[axis], upper[axis] = upper[axis], most[axis]
    return bool((lower < upper).all()) and wall_between(case, (lower, upper))


def _touches(case: Case, body: Body, axis: int, upwards: bool) -> bool:
    lower, upper = _bounds(case, body)
    ends = case.grid.domain[case.space_.axes[axis]]
    distance = ends[1] - upper[axis] if upwards else lower[axis] - ends[0]
    return bool(distance < case.grid.cell_size / 2)


def _side(case: Case, axis: int, upwards: bool) -> str:
    return f"{case.space_.axes[axis]}_{'max' if upwards else 'min'}"


def _bounds(case: Case, body: Body) -> tuple[np.ndarray, np.ndarray]:
    lower, upper = body.shape.bounds(case.space_)
    return np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
