"""The nodes that particles can reach: all of them are processed, ghosts and images included, with the same
results."""

from __future__ import annotations

import copy
from itertools import pairwise, product

import numpy as np
import pytest

from mpmkit.case import parse_case
from mpmkit.kernels import nodes as kernels
from mpmkit.kernels.nodes import FRICTION, MIRROR, OPEN, PERIODIC, PLANES, STICK
from mpmkit.solver import active_nodes
from mpmkit.solver.active_nodes import ActiveNodes
from mpmkit.solver.grid import Grid, Window
from mpmkit.solver.simulation import Simulation

FACES = [
    [[OPEN, OPEN], [MIRROR, OPEN]],
    [[MIRROR, MIRROR], [STICK, FRICTION]],
    [[PERIODIC, PERIODIC], [MIRROR, OPEN]],
    [[MIRROR, STICK], [OPEN, MIRROR], [MIRROR, OPEN]],
    [[PERIODIC, PERIODIC], [MIRROR, MIRROR], [PERIODIC, PERIODIC]],
]


def reached(faces, cells, seed):
    """Grid, window and reach of three boxes of cells in a domain of that many cells."""
    dim = len(faces)
    grid = Grid(
        np.zeros(dim), np.array(cells), 1.0, np.array(faces), np.zeros((dim, 2)), ("x", "y", "z")[:dim]
    )
    rng = np.random.default_rng(seed)
    low = rng.integers(0, cells, (3, dim))
    high = np.minimum(low + rng.integers(0, 4, (3, dim)), np.array(cells) - 1)
    window = Window(grid)
    window.cover(low.min(axis=0), high.max(axis=0))
    return grid, window, (low, high), ActiveNodes(window, low, high)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("faces", FACES, ids=str)
def test_every_node_that_a_particle_can_touch_is_in_a_row(faces, seed):
    grid, window, boxes, active = reached(faces, [40, 30, 20][: len(faces)], seed)
    inside = np.zeros(int(np.prod(window.shape)), dtype=int)
    for begin, end in active.rows:
        inside[begin:end] += 1
    assert inside.max() == 1  # no node is gone through twice
    assert (np.diff(active.tasks) >= 0).all()
    assert list(active.tasks[[0, -1]]) == [0, len(active.rows)]
    for low, high in zip(*boxes, strict=True):
        for cell in product(*map(range, low, high + 1)):
            nodes = np.array(list(product(*(range(k - 1, k + 3) for k in cell))))
            nodes = nodes[((nodes >= -1) & (nodes <= grid.cells + 1)).all(axis=1)]
            assert inside[(nodes - window.lower) @ window.strides[: grid.dim]].all()
    if PERIODIC not in np.array(faces):
        assert inside.sum() < 0.7 * len(inside)  # and most others are not


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("faces", FACES, ids=str)
def test_ghosts_and_their_images_are_listed_once_and_both_are_processed(faces, seed):
    grid, window, boxes, active = reached(faces, [12, 9, 7][: len(faces)], seed)
    inside = np.zeros(window.shape[: grid.dim], dtype=bool)
    for begin, end in active.rows:
        inside.reshape(-1)[begin:end] = True
    for k, (first, behind) in enumerate(zip(active.plane_first[:-1], active.plane_first[1:], strict=True)):
        axis, place = divmod(k, PLANES)
        side = min(place, 1)
        kind, (lower, upper) = grid.faces[axis, side], window.walls[axis]
        ghosts = [lower - 1, upper + 1, upper][place]
        expected = []
        for node in map(np.array, np.argwhere(inside)):
            image = node.copy()
            if node[axis] != ghosts or kind == OPEN or (place == 2 and kind != PERIODIC):
                continue
            if kind == PERIODIC:
                image[axis] = lower + (node[axis] - lower) % grid.cells[axis]
            else:
                image[axis] = 2 * window.walls[axis, side] - node[axis]
            expected.append([node @ window.strides[: grid.dim], image @ window.strides[: grid.dim]])
        found = active.mirrors[first:behind, :2].tolist()
        held = [pair for pair in expected if pair in found]
        assert sorted(found) == sorted(held)
        assert len(found) == len(set(map(tuple, found)))
        for ghost, image in expected:
            if [ghost, image] not in found:  # within a row, but between what particles can touch
                assert not active_nodes._touched(window, *boxes).reshape(-1)[[ghost, image]].any()
        assert inside.reshape(-1)[active.mirrors[first:behind, :2]].all()


def narrow(cells):
    """Sets of faces of domains of 1, 2 and 3 cells along an axis, in two and three dimensions."""
    pairs = [[PERIODIC, PERIODIC], [MIRROR, STICK], [FRICTION, OPEN]]
    return [
        (list(faces), size)
        for dim in (2, 3)
        for faces in product(pairs, repeat=dim)
        for size in product(cells, repeat=dim)
    ]


def test_no_two_entries_of_a_plane_share_a_node():
    """Along a periodic axis of one cell three planes have the same image."""
    for faces, cells in narrow([1, 2, 3]):
        _, _, _, active = reached(faces, cells, 0)
        for first, behind in pairwise(active.plane_first):
            written = active.mirrors[first:behind, :2]
            assert len(np.unique(written)) == written.size, (faces, cells)


@pytest.mark.parametrize("cells", [1, 2, 3])
@pytest.mark.parametrize("size", [(0, 400), (400, 0), (0, 7, 6), (7, 0, 6), (7, 6, 0)], ids=str)
def test_no_mass_is_lost_across_a_narrow_period(size, cells):
    """Sums of ones are exact."""
    across = size.index(0)
    faces = [[PERIODIC, PERIODIC] if axis == across else [OPEN, OPEN] for axis in range(len(size))]
    number = np.array([n or cells for n in size])
    grid = Grid(np.zeros(len(size)), number, 1.0, np.array(faces), np.zeros((len(size), 2)), ("x", "y", "z"))
    window, lowest = Window(grid), np.zeros((1, len(size)), dtype=np.int64)
    window.cover(lowest[0], number - 1)
    active = ActiveNodes(window, lowest, number[None] - 1)
    window.nodes[:, 0] = 1.0
    kernels.fold(window.nodes, active.faces, active.mirrors, active.plane_first, 0, 1, True)
    assert window.nodes[:, 0].sum() == len(window.nodes)


@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
@pytest.mark.parametrize(
    "faces",
    [
        {"z_min": "slip", "x_min": "symmetry", "y_max": "stick"},
        {
            "z_min": {"kind": "friction", "coefficient": 0.3},
            "x_min": "periodic",
            "x_max": "periodic",
            "y_max": "slip",
        },
    ],
    ids=["walls", "periodic"],
)
def test_leaving_out_the_others_changes_no_bit(faces, order, monkeypatch):
    """A block is thrown at a corner and back: on all nodes of the window, and on the nodes in reach."""
    case = {
        "space": "3d",
        "until": 1.0,
        "grid": {"cell_size": 0.1, "domain": {"x": [0, 1.2], "y": [0, 1.2], "z": [0, 1]}, "faces": faces},
        "bodies": [
            {
                "shape": {"kind": "box", "lower": lower, "upper": upper},
                "velocity": velocity,
                "material": {"law": "newtonian", "density": 1000, "viscosity": 50, "sound_speed": 20},
                "particles_per_cell": 8,
            }
            for lower, upper, velocity in (
                ([0, 0.6, 0], [0.3, 1.2, 0.4], [-1, 1, -1]),
                ([0.6, 0.4, 0.5], [0.9, 0.7, 0.9], [2, -2, 0]),
            )
        ],
        "scheme": {"shape": "cpgimp", "order": order},
    }
    fewer = Simulation(parse_case(copy.deepcopy(case)))
    all_of_them = Simulation(parse_case(case))
    whole = active_nodes._touched
    for _ in range(60):
        fewer.advance()
        monkeypatch.setattr(active_nodes, "_touched", lambda *given: np.ones_like(whole(*given)))
        all_of_them.advance()
        monkeypatch.setattr(active_nodes, "_touched", whole)
    assert fewer.operations.sorting.sorts > 1
    for name in ("position", "velocity", "stress", "volume_ratio"):
        np.testing.assert_array_equal(
            getattr(fewer.particles, name), getattr(all_of_them.particles, name), err_msg=name
        )


def test_no_value_is_mapped_to_a_node_out_of_reach():
    """A small body flies between two at rest, so far inside its block that it is not sorted again."""

    def block(lower, upper, velocity):
        material = {"law": "newtonian", "density": 1000, "viscosity": 5, "sound_speed": 20}
        shape = {"kind": "box", "lower": lower, "upper": upper}
        return {"shape": shape, "velocity": velocity, "material": material, "particles_per_cell": 8}

    case = {
        "space": "3d",
        "until": 1.0,
        "gravity": [0, 0, 0],
        "grid": {"cell_size": 0.1, "domain": {axis: [0, 3.6] for axis in "xyz"}},
        "bodies": [
            block([0.1, 0.1, 0.1], [0.3, 0.3, 0.3], [0, 0, 0]),
            block([3.2, 3.2, 3.2], [3.4, 3.4, 3.4], [0, 0, 0]),
            block([1.3, 1.3, 1.3], [1.4, 1.4, 1.4], [3, 2, 1]),
        ],
    }
    simulation = Simulation(parse_case(case))
    operations = simulation.operations
    for _ in range(60):
        simulation.advance()
        away = np.ones(len(operations.window.nodes), dtype=bool)
        for begin, end in operations.sorting.active.rows:
            away[begin:end] = False
        assert away.sum() > 0.8 * len(away)
        assert not operations.window.nodes[away].any()
    assert operations.sorting.sorts == 1
    flown = simulation.particles.position[simulation.particles.body == 2].mean(axis=0) - 1.35
    np.testing.assert_allclose(flown, simulation.time * np.array([3, 2, 1]), rtol=1e-9)
    assert flown[0] > 3 * 0.1
