"""A wall acts where material touches it: the touched nodes, and the effect on the motion."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from test_four_nodes import CubicSplines

import mpmkit
from mpmkit.kernels.scatter import CONTACT, PUSHED, TOUCHED
from mpmkit.registry import Registered, Registry, installed

DX, CELLS, G = 0.1, 4, 9.81
SPACES = {"plane-strain": "xz", "axisymmetric": "rz", "3d": "xyz"}
OIL = {"law": "newtonian", "density": 1000.0, "viscosity": 5.0, "sound_speed": {"factor": 10}}
WATER_ON_OIL = OIL | {"density": 500.0}
RUB, RELEASING = {"kind": "friction", "coefficient": 0.3}, {"kind": "stick", "releases": True}
WALLS = ["slip", "stick", RELEASING, RUB]


def scene(space, faces, lower, upper, gravity=-G, shape="cpgimp", materials=(OIL,), **scheme):
    """Blocks of a fluid on each other, in cells, in a domain of ``CELLS`` cells an axis."""
    axes = SPACES[space]
    heights = np.linspace(lower[-1], upper[-1], len(materials) + 1)
    bodies = [
        {
            "shape": {
                "kind": "box",
                "lower": [DX * x for x in (*lower[:-1], low)],
                "upper": [DX * x for x in (*upper[:-1], high)],
            },
            "material": material,
        }
        for material, low, high in zip(materials, heights[:-1], heights[1:], strict=True)
    ]
    case = {
        "space": space,
        "until": 1.0,
        "gravity": [0.0] * (len(axes) - 1) + [gravity],
        "grid": {"cell_size": DX, "domain": {a: [0.0, CELLS * DX] for a in axes}, "faces": faces},
        "bodies": bodies,
        "scheme": {"shape": shape, **scheme},
    }
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    splines = Registered("shape", CubicSplines, "tests", "1", "cubic-splines")
    return mpmkit.Simulation(mpmkit.parse_case(case, registry=Registry([*found, splines], [])))


# --- Which nodes are touched


def image(number, faces, axis):
    """The node in the domain that a node along an axis is, or is the image of."""
    low, high = faces[axis]
    if low == "periodic":
        return number % CELLS
    if number < 0 and low != "open":
        return -number
    return 2 * CELLS - number if number > CELLS and high != "open" else number


ON_AXIS = {"cpgimp": 1 / 6, "linear": 3 / 16, "cubic-splines": 185 / 768}
"""Room of a node on the axis, Δx² turns: Σ r N/2 of two particles per cell, at r = 1/4, 3/4, …"""


def room_of(node, faces, on_axis):
    """∫ N dV over the domain, m³."""
    room = 1.0
    for axis, number in enumerate(node):
        at_wall = (number == 0 and faces[axis][0] != "open") or (number == CELLS and faces[axis][1] != "open")
        half = at_wall and faces[axis][0] != "periodic"
        if on_axis and axis == 0:
            ring = on_axis if number == 0 else number / 2 - 1 / 6 if half else number
            room *= 2 * math.pi * DX**2 * ring
        else:
            room *= DX / 2 if half else DX
    return room


def expected(simulation, faces, on_axis):
    """Bits of the axes across which every node of a wall is touched, by its number along each axis."""
    p, o, dim = simulation.particles, simulation.operations, simulation.grid.dim
    is_wall = [[face not in ("open", "symmetry", "periodic") for face in pair] for pair in faces]
    bits, volume = {}, {}
    for q in range(len(p)):
        for offset in itertools.product(range(o.weight.shape[2]), repeat=dim):
            w = math.prod(o.weight[q, a, k] for a, k in enumerate(offset))
            if w == 0.0:
                continue
            node = tuple(image(int(o.base[q, a]) + k, faces, a) for a, k in enumerate(offset))
            volume[node] = volume.get(node, 0.0) + w * p.volume[q]
            for a, k in enumerate(offset):
                half = min(p.half_size[q, a], DX / 2)
                for side, wall in enumerate((0, CELLS)):
                    gap = abs(p.position[q, a] - wall * DX) - half
                    if is_wall[a][side] and o.base[q, a] + k == wall and gap <= 0.02 * DX:
                        bits[node] = bits.get(node, 0) | 1 << a
    for node, filled in volume.items():
        for a, number in enumerate(node):
            on_wall = (number == 0 and is_wall[a][0]) or (number == CELLS and is_wall[a][1])
            if on_wall and filled > 0.9 * room_of(node, faces, on_axis):
                bits[node] = bits.get(node, 0) | 1 << a
    return bits


def found_bits(simulation):
    """The bits of ``TOUCHED`` of all nodes that are gone through, by number."""
    window, dim = simulation.operations.window, simulation.grid.dim
    known = window.nodes[:, CONTACT].astype(int).reshape(window.shape[:dim]) // TOUCHED
    return {
        tuple(int(n) for n in index + window.lower): known[tuple(index)] for index in np.argwhere(known > 0)
    }


ROOMS = {
    "corners": ("plane-strain", [["slip", RUB], ["stick", "open"]]),
    "symmetry": ("plane-strain", [["symmetry", "slip"], [RELEASING, "stick"]]),
    "seam": ("plane-strain", [["periodic", "periodic"], [RUB, "symmetry"]]),
    "axis": ("axisymmetric", [["symmetry", "slip"], ["stick", "open"]]),
    "corners in 3-D": ("3d", [["slip", "open"], ["symmetry", "stick"], [RUB, "open"]]),
    "seams in 3-D": ("3d", [["periodic", "periodic"], [RUB, "slip"], ["stick", RELEASING]]),
}


def rooms_and_shapes():
    """Kernels of four nodes an axis in 3-D, which take long to compile, are for the slow run."""
    for name, shape in itertools.product(ROOMS, ["cpgimp", "linear", "cubic-splines"]):
        large = ROOMS[name][0] == "3d" and shape == "cubic-splines"
        yield pytest.param(name, shape, marks=pytest.mark.slow if large else ())


@pytest.mark.usefixtures("each_number_of_threads")
@pytest.mark.parametrize(("name", "shape"), list(rooms_and_shapes()))
def test_touched_nodes(name, shape):
    """Particles in disorder, some close to walls and some with weight on them: the marks of plain NumPy."""
    space, faces = ROOMS[name]
    named = {
        f"{a}_{end}": f
        for a, p in zip(SPACES[space], faces, strict=True)
        for end, f in zip(("min", "max"), p, strict=True)
    }
    if space == "axisymmetric":
        del named["r_min"]
    dim = len(faces)
    lower, upper = [0.0] * (dim - 1) + [0.0], [float(CELLS)] * (dim - 1) + [CELLS - 1.0]
    simulation = scene(space, named, lower, upper, shape=shape, materials=(OIL, WATER_ON_OIL))
    p, rng = simulation.particles, np.random.default_rng(5)
    p.position += rng.uniform(-0.2, 0.2, p.position.shape) * DX
    np.clip(p.position, 1e-3 * DX, (CELLS - 1e-3) * DX, out=p.position)
    p.volume *= rng.uniform(0.8, 1.1, len(p))
    p.volume[rng.random(len(p)) < 0.3] *= 1e-3  # where some are next to nothing, not every node is full
    assert simulation.operations.begin() is None
    found, right = (
        found_bits(simulation),
        expected(simulation, faces, ON_AXIS[shape] if space == "axisymmetric" else None),
    )
    assert {image_of(node, faces): bits for node, bits in found.items()} == right
    for node, bits in found.items():  # a ghost in the plane of a wall is touched as its image is
        assert bits == right[image_of(node, faces)]
    reached = simulation.operations.window.nodes[:, CONTACT] > 0
    of_walls = np.unique(simulation.operations.sorting.active.mirrors[:, 2])
    assert 0 < reached[of_walls].sum() < len(of_walls)  # some are touched and some are not


def image_of(node, faces):
    return tuple(image(number, faces, axis) for axis, number in enumerate(node))


@pytest.mark.parametrize("gap", [0.0, 0.015, 0.03, 0.08])
def test_a_floor_is_touched_by_boxes_within_a_fiftieth_of_a_cell_or_by_what_fills_it(gap):
    """A block over a gap fills (1 - gap)² of the room of a floor's node: 0.94 at 0.03 cells, 0.85 at 0.08."""
    simulation = scene("plane-strain", {"z_min": "stick"}, [1, 0], [3, 2])
    p = simulation.particles
    p.position[:, 1] += gap * DX
    simulation.operations.begin()
    boxes_reach, full = gap <= 0.02, (1 - gap) ** 2 > 0.9
    touched = found_bits(simulation)
    assert set(touched) == ({(n, 0) for n in (1, 2, 3)} if boxes_reach else {(2, 0)} if full else set())
    p.volume *= 0.5  # nothing is full then
    simulation.operations.begin()
    assert bool(found_bits(simulation)) == boxes_reach


def test_fullness_is_a_volume_and_not_a_mass():
    """Two materials of which one is half as dense fill a floor's nodes alike."""
    materials = (OIL, OIL | {"density": 500.0})
    simulation = scene("plane-strain", {"z_min": "stick"}, [0, 0], [4, 2], materials=materials)
    p = simulation.particles
    p.position[:, 1] += 0.03 * DX
    swapped = np.where(p.position[:, 1] < DX, p.position[:, 1] + DX, p.position[:, 1] - DX)
    for heights in (p.position[:, 1].copy(), swapped):
        p.position[:, 1] = heights
        simulation.operations.begin()
        assert {(n, 0) for n in (1, 2, 3)} <= set(found_bits(simulation))


# --- What it does


def advance(simulation, steps):
    for _ in range(steps):
        simulation.advance()
    return simulation


def by_number(simulation, name):
    p = simulation.particles
    return getattr(p, name)[np.argsort(p.number)]


@pytest.mark.parametrize("wall", WALLS, ids=str)
def test_a_wall_does_not_act_before_contact(wall):
    """A block falls freely until its boxes reach the floor."""
    block = {"lower": [1, 0.5], "upper": [3, 2.5], "order": "musl"}
    floor, free = (scene("plane-strain", faces, **block) for faces in ({"z_min": wall}, {}))
    p, acted = floor.particles, False
    while not acted:
        low = (p.position[:, 1] - p.half_size[:, 1]).min()
        dt = floor.advance()
        free.advance(dt)
        acted = np.abs(p.velocity - free.particles.velocity).max() > 1e-12
    assert -0.02 * DX < low < 0.05 * DX


@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
@pytest.mark.parametrize("wall", ["slip", RELEASING, RUB], ids=str)
def test_a_wall_releases_a_block_at_rest(wall, order):
    """Gravity points upwards: the block leaves in free fall, and the wall never pulls."""
    simulation = scene("plane-strain", {"z_min": wall}, [1, 0], [3, 2], gravity=2.0, order=order)
    advance(simulation, 1)
    assert found_bits(simulation)
    advance(simulation, 60)
    np.testing.assert_allclose(by_number(simulation, "velocity")[:, 1], 2.0 * simulation.time, rtol=1e-9)


def test_a_slip_wall_that_nothing_leaves_is_an_exact_mirror():
    """To the bit: a pool in a closed tank, with walls and with planes of symmetry."""
    shut = ("x_min", "x_max", "z_min", "z_max")
    runs = []
    for face in ("slip", "symmetry"):
        simulation = scene("plane-strain", dict.fromkeys(shut, face), [0, 0], [CELLS, CELLS], gravity=-1.0)
        simulation.particles.volume_ratio *= 0.999  # so that it pushes everywhere
        simulation.particles.volume *= 0.999
        simulation.particles.pressure += 1000.0
        runs.append(advance(simulation, 100))
    for name in ("position", "velocity", "stress", "pressure"):
        np.testing.assert_array_equal(by_number(runs[0], name), by_number(runs[1], name))


def test_what_rests_is_pushed_from_the_first_step_on():
    simulation = advance(scene("plane-strain", {"z_min": "slip"}, [1, 0], [3, 2]), 1)
    nodes = simulation.operations.window.nodes[:, CONTACT].astype(int)
    assert (nodes & PUSHED << 1 > 0).sum() == (nodes & TOUCHED << 1 > 0).sum() == 3


def test_a_domain_without_walls_has_nothing_to_touch():
    faces = {"x_min": "symmetry", "z_min": "periodic", "z_max": "periodic"}
    simulation = scene("plane-strain", faces, [0, 0], [2, 2])
    assert not simulation.grid.walled
    advance(simulation, 3)
    assert not simulation.operations.window.nodes[:, CONTACT].any()
