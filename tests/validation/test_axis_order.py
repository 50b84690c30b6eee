"""The order of the axes changes nothing: Coulomb walls beside seams, symmetry planes and each other.

A scene is written in axes of its own (along the flow, across it, and away from the wall), and given to
the grid in every order of these. Gravity may point along any axis.
"""

from __future__ import annotations

import math
from itertools import permutations

import numpy as np
import pytest
from bands import below, close_to
from pairwise import pairwise

import mpmkit

pytestmark = pytest.mark.section(6)

DX, G, DEGREES, FRICTION = 0.0125, 9.81, 30.0, 0.3
RUB = {"kind": "friction", "coefficient": FRICTION}
FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 100.0, "sound_speed": 15.0}
RUBBER = {"law": "neo-hookean", "density": 1000.0, "youngs_modulus": 2e4, "poisson_ratio": 0.3}
ORDERS = [*permutations(range(2)), *permutations(range(3))]
each_order = pytest.mark.parametrize("order", ORDERS, ids=str)


def scene(places, lower, upper, domain, faces, gravity, velocity=None, material=FLUID, update="musl"
):  # fmt: skip
    """A block; the data of the scene's axis i are given to the grid's axis ``places[i]``. Lengths in cells.

    ``faces`` has a pair for each axis: the faces at its lower and its upper end; None is open. With USL
    rounding has an influence: a node that a box reaches by rounding alone is as stiff as any other.
    """
    dim = len(places)
    axes = "xyz" if dim == 3 else "xz"

    def placed(values):
        found = [None] * dim
        for i, k in enumerate(places):
            found[k] = values[i]
        return found

    kinds = placed(faces)
    case = {
        "space": "3d" if dim == 3 else "plane-strain",
        "until": 1.0,
        "gravity": placed(gravity),
        "grid": {
            "cell_size": DX,
            "domain": {axis: [DX * x for x in ends] for axis, ends in zip(axes, placed(domain), strict=True)},
            "faces": {
                f"{axis}_{side}": kind
                for axis, pair in zip(axes, kinds, strict=True)
                for side, kind in zip(("min", "max"), pair, strict=True)
                if kind is not None
            },
        },
        "bodies": [
            {
                "shape": {
                    "kind": "box",
                    "lower": [DX * x for x in placed(lower)],
                    "upper": [DX * x for x in placed(upper)],
                },
                "material": material,
                "velocity": placed(velocity or [0.0] * dim),
            }
        ],
        "scheme": {"order": update, "time_step": {"fraction": 0.4}},
    }
    return mpmkit.Simulation(mpmkit.parse_case(case))


SIDES = ["lower", "upper"]
FILMS = [
    *((order, side, "periodic") for order in permutations(range(2)) for side in SIDES),
    *pairwise(permutations(range(3)), SIDES, ["periodic", "symmetry"]),
]


@pytest.mark.parametrize(("order", "side", "edges"), FILMS, ids=str)
def test_film_slides_on_a_coulomb_wall_alike_along_every_axis(validate, order, side, edges):
    """a = g (sin θ - μ cos θ), for every order of the axes and with the wall at either end of its axis.

    The film is periodic along the flow; in three dimensions it is periodic across the flow too, or lies
    between symmetry planes.
    """
    angle, dim, height = math.radians(DEGREES), len(order), 4
    sign = 1.0 if side == "lower" else -1.0
    gravity = [G * math.sin(angle), *[0.0] * (dim - 2), -sign * G * math.cos(angle)]
    span, wall = ([0, height], [RUB, None]) if side == "lower" else ([6, 6 + height], [None, RUB])
    sizes = [[0, 2], *[[0, 3]] * (dim - 2), span]
    faces = [["periodic"] * 2, *[[edges] * 2] * (dim - 2), wall]
    lower, upper = ([ends[k] for ends in sizes] for k in (0, 1))
    simulation = scene(order, lower, upper, [*sizes[:-1], [0, 6 + height]], faces, gravity, update="usl")
    p, times, speeds = simulation.particles, [], []
    while simulation.time < 0.1:
        simulation.advance()
        times.append(simulation.time)
        speeds.append(float(p.mass @ p.velocity[:, order[0]] / p.mass.sum()))
    late = np.array(times) > 0.05
    found = np.polyfit(np.array(times)[late], np.array(speeds)[late], 1)[0]
    exact = G * (math.sin(angle) - FRICTION * math.cos(angle))
    name = f"Film on a Coulomb wall, {dim}-D, every order of axes, {edges} flanks: acceleration"
    validate(name, found, close_to(exact, rel=0.002), unit="m/s²")
    assert np.abs(p.velocity[:, list(order)[1:-1]]).max(initial=0.0) < 1e-9


def state(simulation, order, start):
    """Positions and velocities in the scene's own axes, of the particles that began at x > 0."""
    p = simulation.particles
    start, position, velocity = (
        field[:, list(order)]
        for field in (start, *(x[np.argsort(p.number)] for x in (p.position, p.velocity)))
    )
    start = start + simulation.grid.lower[list(order)]
    kept = start[:, 0] > 0
    by_place = np.lexsort(np.round(start[kept] / DX * 64).T)
    return (position + simulation.grid.lower[list(order)])[kept][by_place], velocity[kept][by_place]


@each_order
def test_half_beside_a_coulomb_wall_is_the_whole(validate, order):
    """A rubber block that falls on a Coulomb floor and slides along it, cut by a symmetry plane or not."""
    dim, found = len(order), []
    for cut in (True, False):
        begin = 0 if cut else -1
        faces = [["symmetry" if cut else None, None], *[[None, None]] * (dim - 2), [RUB, None]]
        lower, upper = [2 * begin, *[-2] * (dim - 2), 0], [2, *[2] * (dim - 2), 3]
        domain = [[6 * begin, 6], *[[-6, 8]] * (dim - 2), [0, 6]]
        velocity = [0.0, *[0.5] * (dim - 2), -0.5]
        gravity = [*[0.0] * (dim - 1), -G]
        simulation = scene(order, lower, upper, domain, faces, gravity, velocity, RUBBER)
        start = simulation.particles.position[np.argsort(simulation.particles.number)]
        while simulation.time < 0.02:
            simulation.advance(min(2e-4, 0.02 - simulation.time))
        found.append(state(simulation, order, start))
    (half, speed), (whole, _) = found
    assert len(half) == len(whole)
    assert np.abs(speed[:, 0]).max() > 0.05  # it bulges
    off = np.abs(half - whole).max() / DX
    validate(f"Half block beside a Coulomb floor, {dim}-D: off the whole, cells", off, below(1e-9, "0"))


@pytest.mark.parametrize("dim", [2, 3])
def test_corner_of_coulomb_walls_knows_no_first_axis(validate, dim):
    """A block thrown into a corner of two or three Coulomb walls, for every order of the axes."""
    found = []
    for order in permutations(range(dim)):
        faces = [[RUB, None], [{"kind": "friction", "coefficient": 0.7}, None], ["symmetry", None]]
        speeds, sizes = [-1.0, -0.6, 0.3], [3, 4, 2]
        simulation = scene(
            order, [0] * dim, sizes[:dim], [[0, 8]] * dim, faces[:dim], [-G] * dim, speeds[:dim], RUBBER
        )
        start = simulation.particles.position[np.argsort(simulation.particles.number)]
        while simulation.time < 0.02:
            simulation.advance(min(2e-4, 0.02 - simulation.time))
        found.append(state(simulation, order, start))
    assert np.abs(found[0][1]).max() > 0.1
    off = max(np.abs(position - found[0][0]).max() for position, _ in found) / DX
    validate(
        f"Block in a corner of Coulomb walls, {dim}-D: off, with axes in other orders, cells",
        off,
        below(1e-9, "0"),
    )
