"""Particles to nodes and back, kernel by kernel, against dense matrices of the weights."""

from __future__ import annotations

import numpy as np
import pytest
from blocks import Blocks
from pairwise import every_pair
from tensors import symmetric

from mpmkit.kernels import gather, scatter, splines
from mpmkit.kernels.scatter import NODE
from mpmkit.kernels.vectors import LANES

pytestmark = pytest.mark.usefixtures("each_number_of_threads")
RELATIVE = 1e-13


class Scene:
    """Random particles in sorted blocks over a window, two materials; some have drifted a cell since."""

    def __init__(self, dim, support, radial=False, n=700, seed=4, affine=False):
        rng = np.random.default_rng(seed)
        self.rng, self.dim, self.support, self.n = rng, dim, support, n
        self.cells = np.array([23, 20, 14][:dim])
        self.lower = np.array([-3, -2, -2][:dim], dtype=np.int64)
        size = [int(c) + 8 for c in self.cells] + [1] * (3 - dim)
        self.shape = tuple(size)
        self.strides = (size[1] * size[2], size[2], 1)
        self.count = size[0] * size[1] * size[2]
        cell = rng.integers(0, self.cells, (n, dim)).astype(np.int32)
        blocks = Blocks.of(cell, np.sort(rng.integers(0, 2, n)))
        self.tasks = blocks.tasks()
        lowest = -1 if support > 2 else 0  # a wide particle may begin in the cell below its own
        self.base = (cell[blocks.order] + rng.integers(lowest - 1, 2, (n, dim))).astype(np.int32)
        self.weight = rng.uniform(size=(n, dim, support))
        self.weight /= self.weight.sum(axis=2, keepdims=True)
        self.gradient = rng.normal(size=(n, dim, support))
        self.hoop = rng.uniform(size=(n, support if radial else 0))
        self.mass, self.volume = rng.uniform(1, 2, n), rng.uniform(1, 2, n)
        self.velocity, self.position = rng.normal(size=(n, dim)), rng.uniform(1, 2, (n, dim))
        self.affine = rng.normal(size=(n, dim, dim)) if affine else np.zeros((n, 0, 0))
        self.stress, self.pressure = rng.normal(size=(n, 6)), rng.normal(size=n)
        self.velocity_gradient, self.rate = rng.normal(size=(n, 3, 3)), rng.normal(size=n)
        self.gravity = np.array([0.3, -0.7, -9.81][:dim])

    @property
    def tables(self):
        return self.strides, self.lower, self.base, self.weight

    def moments(self):
        """Centroid of the weights along each axis, in cells from the first node, and their second moment."""
        node = np.arange(self.support)
        centroid = self.weight @ node
        return centroid, np.sum(self.weight * (node - centroid[:, :, None]) ** 2, axis=2)

    def corners(self):
        """Each way to pick one node an axis: picks, and the flat node of every particle."""
        for pick in np.ndindex(*(self.support,) * self.dim):
            offset = self.base - self.lower + np.array(pick)
            yield pick, offset @ np.array(self.strides[: self.dim])

    def product(self, pick, slope_axis=None, hoop=False):
        """Weight of every particle at one corner; along one axis the gradient, or along r the hoop."""
        value = np.ones(self.n)
        for axis, a in enumerate(pick):
            table = self.gradient if axis == slope_axis else self.weight
            value = value * (self.hoop[:, a] if hoop and axis == 0 else table[:, axis, a])
        return value

    def scatter(self, found, momentum, forces):
        scatter.scatter(self.dim, self.support)(
            found, self.strides, self.lower, self.tasks, self.base, self.weight, self.gradient, self.hoop,
            self.mass, self.velocity, self.affine, self.volume, self.stress, self.pressure,
            self.gravity[None], CELL, momentum, forces,
        )  # fmt: skip

    def gather(self, grid, dt=0.0, flip=0.0, move=False, strain=False, affine=False):
        gather.gather(self.dim, self.support)(
            grid, *self.tables, self.gradient, self.hoop, CELL, dt, flip, self.position, self.velocity,
            self.velocity_gradient, self.rate, self.affine, move, strain, affine,
        )  # fmt: skip

    def scatter_pairs(self, found, measure, values):
        scatter_pairs = scatter.scatter_pairs(self.dim, self.support)
        scatter_pairs(found, self.strides, self.lower, self.tasks, self.base, self.weight, measure, values)

    def reference(self, momentum, forces):
        expected, dim = np.zeros((self.count, NODE)), self.dim
        cauchy = symmetric(self.stress) - self.pressure[:, None, None] * np.eye(3)
        centroid, _ = self.moments()
        for pick, node in self.corners():
            if momentum:
                velocity = self.velocity
                if self.affine.shape[1]:
                    arm = CELL * (np.array(pick) - centroid)
                    velocity = velocity + np.einsum("pij,pj->pi", self.affine, arm)
                share = self.mass * self.product(pick)
                np.add.at(expected[:, 0], node, share)
                for i in range(dim):
                    np.add.at(expected[:, 1 + i], node, share * velocity[:, i])
            if forces:
                for i in range(dim):
                    np.add.at(
                        expected[:, 1 + dim + i], node, self.mass * self.gravity[i] * self.product(pick)
                    )
                    for j in range(dim):
                        slope = self.product(pick, slope_axis=j)
                        np.add.at(expected[:, 1 + dim + i], node, -self.volume * cauchy[:, i, j] * slope)
                if self.hoop.shape[1]:
                    hoop = self.product(pick, hoop=True)
                    np.add.at(expected[:, 1 + dim], node, -self.volume * cauchy[:, 2, 2] * hoop)
        return expected


CELL = 0.3
SPACES = [(2, False), (2, True), (3, False)]
spaces = pytest.mark.parametrize(("dim", "radial"), SPACES)
supports = pytest.mark.parametrize("support", [2, 3])
supports_of_averages = pytest.mark.parametrize("support", range(2, scatter.LARGEST_SUPPORT + 1))


@spaces
@supports
@pytest.mark.parametrize(("momentum", "forces"), [(True, True), (True, False), (False, True)])
def test_scatter(dim, radial, support, momentum, forces):
    scene = Scene(dim, support, radial)
    start = scene.rng.normal(size=(scene.count, NODE))
    found = start.copy()
    scene.scatter(found, momentum, forces)
    np.testing.assert_allclose(found, start + scene.reference(momentum, forces), rtol=0, atol=1e-12)


@spaces
@supports
def test_scatter_of_an_affine_velocity(dim, radial, support):
    scene = Scene(dim, support, radial, affine=True)
    found = np.zeros((scene.count, NODE))
    scene.scatter(found, True, True)
    np.testing.assert_allclose(found, scene.reference(True, True), rtol=0, atol=1e-12)


@spaces
@pytest.mark.parametrize("affine", [False, True])
def test_scattered_mass_and_momentum_are_those_of_the_particles(dim, radial, affine):
    scene = Scene(dim, 3, radial, n=3000, affine=affine)
    found = np.zeros((scene.count, NODE))
    scene.scatter(found, True, False)
    assert found[:, 0].sum() == pytest.approx(scene.mass.sum(), rel=1e-13)
    momentum = scene.mass @ scene.velocity
    np.testing.assert_allclose(found[:, 1 : 1 + dim].sum(axis=0), momentum, rtol=0, atol=1e-10)


@spaces
def test_blocks_of_no_particle_are_skipped(dim, radial):
    scene = Scene(dim, 2, radial, n=1)
    found = np.zeros((scene.count, NODE))
    scene.scatter(found, True, True)
    np.testing.assert_allclose(found, scene.reference(True, True), rtol=0, atol=1e-14)


@spaces
@supports_of_averages
def test_scatter_pairs(dim, radial, support):
    scene = Scene(dim, support, radial)
    start, values = scene.rng.normal(size=(scene.count, scatter.PAIR)), scene.rng.normal(size=scene.n)
    found, expected = start.copy(), start.copy()
    scene.scatter_pairs(found, scene.volume, values)
    for pick, node in scene.corners():
        share = scene.volume * scene.product(pick)
        np.add.at(expected, node, np.column_stack([share, share * values]))
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)


@spaces
@supports_of_averages
def test_scatter_scalar(dim, radial, support):
    scene = Scene(dim, support, radial)
    start, expected = scene.rng.normal(size=scene.count + LANES), np.zeros(scene.count)
    found = start.copy()
    of_particles = scene.strides, scene.lower, scene.tasks, scene.base, scene.weight
    scatter.scatter_scalar(dim, support)(found[: scene.count], *of_particles, scene.volume)
    for pick, node in scene.corners():
        np.add.at(expected, node, scene.volume * scene.product(pick))
    np.testing.assert_allclose(found[: scene.count], start[: scene.count] + expected, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(found[scene.count :], start[scene.count :])


@pytest.mark.parametrize("dim", [2, 3])
def test_gather_slope_is_the_slope_of_a_quadratic_field(dim):
    """Exactly: its average over a spline differs from it by a constant."""
    scene = Scene(dim, 3)
    spacing, n = 0.5, scene.n
    place = spacing * (scene.base + 1 + scene.rng.uniform(-0.5, 0.5, (n, dim)))
    base, weight, slope = np.zeros((n, dim), np.int32), np.zeros((n, dim, 3)), np.zeros((n, dim))
    splines.fill_splines(place, 1 / spacing, base, weight)
    np.testing.assert_array_equal(base, scene.base)
    number = np.stack(np.unravel_index(np.arange(scene.count), scene.shape[:dim]), axis=1) + scene.lower
    node = spacing * number
    bend, along = scene.rng.normal(size=(dim, dim)), scene.rng.normal(size=dim)
    field = np.full((scene.count + LANES, 1), np.nan)
    field[: scene.count, 0] = np.einsum("ni,ij,nj->n", node, bend, node) + node @ along
    splines.gather_slope(dim)(
        field[: scene.count], scene.strides, scene.lower, base, weight, 1 / spacing, slope
    )
    np.testing.assert_allclose(slope, place @ (bend + bend.T) + along, rtol=0, atol=1e-10)


def gathered(scene, grid):
    """What ``gather`` must find: ṽ, Δṽ, L (n, 3, 3) and C (n, dim, dim)."""
    n, dim = scene.n, scene.dim
    new, change, L, C = np.zeros((n, dim)), np.zeros((n, dim)), np.zeros((n, 3, 3)), np.zeros((n, dim, dim))
    centroid, moment = scene.moments()
    for pick, node in scene.corners():
        N, v = scene.product(pick)[:, None], grid[node, 1 : 1 + dim]
        new += N * v
        change += N * grid[node, 1 + dim : 1 + 2 * dim]
        arm = CELL * (np.array(pick) - centroid)
        C += (N * v)[:, :, None] * (arm / (CELL**2 * np.maximum(moment, gather.LEAST_MOMENT)))[:, None, :]
        for j in range(dim):
            L[:, :dim, j] += v * scene.product(pick, slope_axis=j)[:, None]
        if scene.hoop.shape[1]:
            L[:, 2, 2] += v[:, 0] * scene.product(pick, hoop=True)
    return new, change, L, C


@every_pair(
    "space, support, flip, asked",
    SPACES,
    [2, 3],
    [1.0, 0.0, 0.3],
    [(True, False, False), (False, True, False), (False, False, True), (True, True, True)],
)
def test_gather(space, support, flip, asked):
    """What is asked for, alone or in one pass; what is not stays untouched, as does a slope off the space."""
    (dim, radial), (move, strain, affine) = space, asked
    scene, dt = Scene(dim, support, radial, affine=True), 0.07
    grid = scene.rng.normal(size=(scene.count, NODE))
    new, change, L, C = gathered(scene, grid)
    rate = np.trace(L, axis1=1, axis2=2)
    position, velocity = scene.position.copy(), scene.velocity.copy()
    if move:
        position += dt * new
        velocity = flip * (velocity + change) + (1 - flip) * new
        if radial:  # the ring's middle moves with the hoop rate
            position[:, 0] = scene.position[:, 0] * (1 + dt * L[:, 2, 2])
    if dim == 2:
        L[:, :2, 2], L[:, 2, :2] = scene.velocity_gradient[:, :2, 2], scene.velocity_gradient[:, 2, :2]
    start = {name: getattr(scene, name).copy() for name in ("velocity_gradient", "rate", "affine")}
    scene.gather(grid, dt, flip, move, strain, affine)
    np.testing.assert_allclose(scene.position, position, rtol=RELATIVE if move else 0, atol=0)
    np.testing.assert_allclose(scene.velocity, velocity, rtol=0, atol=1e-13 if move else 0)
    for name, expected, asked in (
        ("velocity_gradient", L, strain), ("rate", rate, strain), ("affine", C, affine),
    ):  # fmt: skip
        wanted, atol = (expected, 1e-12) if asked else (start[name], 0)
        np.testing.assert_allclose(getattr(scene, name), wanted, rtol=0, atol=atol, err_msg=name)


@spaces
@supports
def test_gather_is_exact_for_a_uniform_and_for_a_linear_field(dim, radial, support):
    """v = A x + c gives C = A, except along axes without a usable slope; a uniform v gives C = 0."""
    scene = Scene(dim, support, radial, affine=True)
    x = CELL * (np.stack(np.indices(scene.shape[:dim]), axis=-1).reshape(-1, dim) + scene.lower)
    A, c = scene.rng.normal(size=(dim, dim)), scene.rng.normal(size=dim)
    grid = scene.rng.normal(size=(scene.count, NODE))
    centroid, moment = scene.moments()
    known = np.minimum(1.0, moment / gather.LEAST_MOMENT)
    assert (known < 1).any()
    assert (known == 1).any()
    for slope in (A, np.zeros((dim, dim))):
        grid[:, 1 : 1 + dim] = x @ slope.T + c
        scene.position[:] = 0.0
        scene.gather(grid, dt=1.0, move=True, affine=True)
        np.testing.assert_allclose(scene.affine, slope * known[:, None, :], rtol=0, atol=1e-12)
        at = CELL * (scene.base + centroid)
        np.testing.assert_allclose(scene.velocity, at @ slope.T + c, rtol=0, atol=1e-12)


@spaces
@supports
def test_forces_do_the_work_that_the_particles_take_up(dim, radial, support):
    """Σ f·v over the nodes is Σ m g·ṽ - Σ V (s:L - p tr L): P2G of forces is the transpose of G2P."""
    scene = Scene(dim, support, radial)
    grid, forces = scene.rng.normal(size=(scene.count, NODE)), np.zeros((scene.count, NODE))
    scene.velocity_gradient[:] = 0.0
    scene.gather(grid, move=True, strain=True)
    scene.scatter(forces, False, True)
    work = np.einsum("pij,pij->p", symmetric(scene.stress), scene.velocity_gradient)
    work = scene.volume * (work - scene.pressure * scene.rate)
    taken_up = scene.mass @ scene.velocity @ scene.gravity - work.sum()
    given = np.vdot(forces[:, 1 + dim : 1 + 2 * dim], grid[:, 1 : 1 + dim])
    assert given == pytest.approx(taken_up, rel=1e-11, abs=1e-10)


@spaces
@supports
def test_momentum_and_its_affine_part_are_mapped_by_transposes(dim, radial, support):
    """Σ p·v over the nodes is Σ m (v·ṽ + C:C̃ D), D as ``gather`` has it."""
    scene = Scene(dim, support, radial, affine=True)
    velocity, C = scene.velocity.copy(), scene.affine.copy()
    grid, found = scene.rng.normal(size=(scene.count, NODE)), np.zeros((scene.count, NODE))
    scene.scatter(found, True, False)
    scene.gather(grid, move=True, affine=True)
    D = CELL**2 * np.maximum(scene.moments()[1], gather.LEAST_MOMENT)
    expected = np.einsum("p,pi,pi->", scene.mass, velocity, scene.velocity)
    expected += np.einsum("p,pij,pij,pj->", scene.mass, C, scene.affine, D)
    mapped = np.vdot(found[:, 1 : 1 + dim], grid[:, 1 : 1 + dim])
    assert mapped == pytest.approx(expected, rel=1e-11, abs=1e-10)


@spaces
@supports_of_averages
def test_gather_scalar_is_the_transpose_of_scatter_pairs(dim, radial, support):
    scene = Scene(dim, support, radial)
    field = scene.rng.normal(size=scene.count + LANES)
    field[scene.count :] = np.nan  # is read along with the last row, and must not count
    found, expected = np.empty(scene.n), np.zeros(scene.n)
    gather.gather_scalar(dim, support)(field[: scene.count, None], *scene.tables, found)
    for pick, node in scene.corners():
        expected += scene.product(pick) * field[node]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13)
    values, one = scene.rng.normal(size=scene.n), np.ones(scene.n)
    sums = np.zeros((scene.count, scatter.PAIR))
    scene.scatter_pairs(sums, one, values)
    assert field[: scene.count] @ sums[:, 1] == pytest.approx(found @ values, rel=1e-11)


# --- Nodes alone --------------------------------------------------------------------------------------------
