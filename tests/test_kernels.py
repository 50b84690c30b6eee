"""Every compiled kernel against a plain NumPy reference that is written to be read, on small random data."""

from __future__ import annotations

import numba
import numpy as np
import pytest
from blocks import Blocks

from mpmkit.kernels import domains, gather, locate, nodes, scatter, tensors, volumes
from mpmkit.kernels.compile import CHUNK, chunk_count
from mpmkit.kernels.nodes import FRICTION, MIRROR, OPEN, PERIODIC, STICK
from mpmkit.kernels.sort import BLOCK_WIDTH
from mpmkit.kernels.vectors import LANES

NODE, CONTACT = scatter.NODE, scatter.CONTACT
RELATIVE = 1e-13


@pytest.fixture(autouse=True, params=[1, 2], ids=["1 thread", "2 threads"])
def _threads(request):
    numba.set_num_threads(request.param)


def symmetric(six):
    """(n, 6) in the order xx, yy, zz, yz, xz, xy to (n, 3, 3)."""
    return six[:, [0, 5, 4, 5, 1, 3, 4, 3, 2]].reshape(-1, 3, 3)


def random_gradients(rng, n, size=1.0):
    return rng.normal(size=(n, 3, 3)) * size


# --- Particles, nodes and the tables between them -----------------------------------------------------------


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
            self.mass, self.velocity, self.affine, self.volume, self.stress, self.pressure, self.gravity,
            CELL, momentum, forces,
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
spaces = pytest.mark.parametrize(("dim", "radial"), [(2, False), (2, True), (3, False)])
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


@spaces
@supports
@pytest.mark.parametrize("flip", [1.0, 0.0, 0.3])
@pytest.mark.parametrize(
    ("move", "strain", "affine"),
    [(True, False, False), (False, True, False), (False, False, True), (True, True, True)],
    ids=["move", "strain", "affine", "all"],
)
def test_gather(dim, radial, support, flip, move, strain, affine):
    """What is asked for, alone or in one pass; what is not stays untouched, as does a slope off the space."""
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
    """v = A x + c gives C = A, but for axes on which the particle barely knows a slope; uniform, C = 0."""
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


def block(dim, seed=6):
    """Random records, shape, strides and walls of a window whose walls stand one node inside it."""
    rng = np.random.default_rng(seed)
    shape = (8, 7, 6) if dim == 3 else (8, 7, 1)
    strides = (shape[1] * shape[2], shape[2], 1)
    walls = np.array([[1, n - 2] for n in shape[:dim]], dtype=np.int64)
    records = rng.normal(size=(int(np.prod(shape)), NODE))
    records[:, 0] = rng.uniform(1, 2, len(records))
    records[:, CONTACT] = rng.integers(0, 2**dim, len(records))
    return records, shape, strides, walls


def plane(array, axis, k):
    """View of a plane of nodes of an array (nx, ny, nz, slots)."""
    return np.moveaxis(array, axis, 0)[k]


def parity(face, dim, axis, vectors):
    """What reflection at a face does to the slots of a node.

    A mirror turns the normal components of both vectors round, a stick wall all of them.
    """
    sign = np.ones(NODE)
    if vectors and face == STICK:
        sign[1 : 1 + 2 * dim] = -1.0
    elif vectors and face != PERIODIC:
        sign[[1 + axis, 1 + dim + axis]] = -1.0
    return sign


FACES_2D = [
    [[OPEN, OPEN], [OPEN, OPEN]],
    [[MIRROR, OPEN], [OPEN, MIRROR]],
    [[MIRROR, MIRROR], [FRICTION, STICK]],
    [[PERIODIC, PERIODIC], [MIRROR, OPEN]],
    [[PERIODIC, PERIODIC], [PERIODIC, PERIODIC]],
]
FACES_3D = [
    [[OPEN, OPEN], [OPEN, OPEN], [OPEN, OPEN]],
    [[MIRROR, MIRROR], [MIRROR, OPEN], [FRICTION, STICK]],
    [[PERIODIC, PERIODIC], [MIRROR, STICK], [PERIODIC, PERIODIC]],
]
each_set_of_faces = pytest.mark.parametrize("faces", FACES_2D + FACES_3D, ids=str)


def images(faces, axis):
    """(face, ghost plane, image plane) of an axis of a window of ``block``: walls at 1 and n - 2.

    Along a periodic axis these two walls are the same plane, n - 3 cells apart.
    """
    n, (low, high) = (8, 7, 6)[axis], faces[axis]
    if low == PERIODIC:
        return [(low, 0, n - 3), (low, n - 2, 1), (low, n - 1, 2)]
    both = [(low, 0, 2), (high, n - 1, n - 3)]
    return [(face, ghost, image) for face, ghost, image in both if face != OPEN]


def reflecting(records, face, axis, ghost, image, vectors):
    """Columns of nodes behind which a face reflects: of a Coulomb wall, those that touch it."""
    contacts = plane(records, axis, (ghost + image) // 2)[..., CONTACT].astype(int)
    everywhere = face != FRICTION or not vectors
    return ((contacts & 1 << axis) > 0)[..., None] | everywhere


@each_set_of_faces
@pytest.mark.parametrize("vectors", [True, False], ids=["vectors", "scalars"])
def test_fold(faces, vectors):
    faces = np.array(faces)
    dim = len(faces)
    records, shape, strides, walls = block(dim)
    expected = records.copy().reshape(*shape, NODE)
    last = 1 + 2 * dim
    for axis in range(dim):  # axis by axis: corners reach their image in as many moves
        for face, ghost, image in images(faces, axis):
            sign = parity(face, dim, axis, vectors)
            where = reflecting(expected, face, axis, ghost, image, vectors)
            behind, before = plane(expected, axis, ghost), plane(expected, axis, image)
            before[..., :last] += np.where(where, sign * behind, 0.0)[..., :last]
            behind[..., :last] = np.where(where, 0.0, behind)[..., :last]
    total = records[:, 0].sum()
    nodes.fold(records, shape, strides, dim, faces, walls, 0, last, vectors)
    np.testing.assert_allclose(records.reshape(expected.shape), expected, rtol=0, atol=1e-13)
    assert records[:, 0].sum() == pytest.approx(total, rel=1e-14)  # mass is moved, never lost


@each_set_of_faces
@pytest.mark.parametrize("vectors", [True, False], ids=["vectors", "scalars"])
def test_fill(faces, vectors):
    faces = np.array(faces)
    dim = len(faces)
    records, shape, strides, walls = block(dim)
    expected = records.copy().reshape(*shape, NODE)
    last = 1 + 2 * dim
    for axis in reversed(range(dim)):
        for face, ghost, image in images(faces, axis):
            sign = parity(face, dim, axis, vectors)
            where = reflecting(expected, face, axis, ghost, image, vectors)
            behind, before = plane(expected, axis, ghost), plane(expected, axis, image)
            behind[..., 1:last] = np.where(where, sign * before, behind)[..., 1:last]
    nodes.fill(records, shape, strides, dim, faces, walls, 1, last, vectors)
    np.testing.assert_allclose(records.reshape(expected.shape), expected, rtol=0, atol=0)


@each_set_of_faces
def test_fill_is_the_transpose_of_fold(faces):
    """⟨fold a, b⟩ = ⟨a, fill b⟩ for all a and b whose ghosts are what ``fill`` makes of them."""
    faces = np.array(faces)
    dim = len(faces)
    a, shape, strides, walls = block(dim, seed=7)
    b, *_ = block(dim, seed=8)
    b[:, CONTACT] = a[:, CONTACT]
    last = 1 + 2 * dim
    filled = b.copy()
    nodes.fill(filled, shape, strides, dim, faces, walls, 0, last, True)
    folded = a.copy()
    nodes.fold(folded, shape, strides, dim, faces, walls, 0, last, True)
    assert np.vdot(folded[:, :last], filled[:, :last]) == pytest.approx(
        np.vdot(a[:, :last], filled[:, :last]), rel=1e-12, abs=1e-12
    )


def test_walls_outside_the_window_are_left_alone():
    records, shape, strides, _ = block(2)
    faces = np.array([[MIRROR, MIRROR], [STICK, FRICTION]])
    walls = np.array([[-5, 40], [-5, 40]], dtype=np.int64)
    start = records.copy()
    nodes.fold(records, shape, strides, 2, faces, walls, 0, 5, True)
    nodes.fill(records, shape, strides, 2, faces, walls, 0, 5, True)
    np.testing.assert_array_equal(records, start)


def test_clear_keeps_nothing_but_contact():
    records, *_ = block(3)
    start = records.copy()
    nodes.clear(records)
    assert (records[:, :CONTACT] == 0).all()
    np.testing.assert_array_equal(records[:, CONTACT], start[:, CONTACT])


@each_set_of_faces
def test_averages_at_nodes(faces):
    """Σ w f / Σ w with what lies on ghosts at their images, at the ghosts too; zero where nothing is."""
    faces = np.array(faces)
    dim = len(faces)
    records, shape, strides, walls = block(dim)
    pairs, average = records[:, :2].copy(), np.full((len(records), 1), np.nan)
    pairs[::5] = 0.0
    expected = np.zeros_like(records)
    expected[:, :2] = pairs
    nodes.fold(expected, shape, strides, dim, faces, walls, 0, 2, False)
    weight, sums = expected[:, 0], expected[:, 1]
    expected[:, 0] = np.divide(sums, weight, out=np.zeros_like(sums), where=weight > 0)
    nodes.fill(expected, shape, strides, dim, faces, walls, 0, 1, False)
    nodes.divide_pairs(pairs, average, shape, strides, dim, faces, walls)
    np.testing.assert_allclose(average[:, 0], expected[:, 0], rtol=0, atol=1e-13)
    assert (pairs == 0).all()  # ready for the next average


def constrained(velocity, change, contact, faces, friction, walls, solved):
    """Reference of the conditions on the faces, on (nx, ny, nz, dim); ``contact`` has a bit an axis."""
    dim = velocity.shape[-1]
    for axis in range(dim):
        for side in range(2):
            code, k, inward = faces[axis, side], int(walls[axis, side]), 1 - 2 * side
            v, dv = plane(velocity, axis, k), plane(change, axis, k)
            if code == MIRROR:
                v[..., axis] = 0.0
                if solved:
                    dv[..., axis] = 0.0
            elif code == STICK:
                v[...] = 0.0
                if solved:
                    dv[...] = 0.0
            elif code == FRICTION and not solved:
                v[..., axis][plane(contact, axis, k) >> axis & 1 > 0] = 0.0
            elif code == FRICTION:
                push = np.maximum(-inward * v[..., axis], 0.0)
                into = push > 0
                tangent = v.copy()
                tangent[..., axis] = 0.0
                slip = np.linalg.norm(tangent, axis=-1)
                keep = 1 - friction[axis, side] * push / np.where(slip > 0, slip, 1.0)
                end = np.maximum(keep, 0.0)[..., None] * tangent
                dv[into] += (end - v)[into]
                v[into] = end[into]


@pytest.mark.parametrize(
    "faces",
    [f for f in FACES_2D + FACES_3D if not any(PERIODIC in pair for pair in f)]
    + [[[FRICTION, FRICTION], [FRICTION, FRICTION], [FRICTION, FRICTION]], [[STICK, STICK], [STICK, MIRROR]]],
    ids=str,
)
def test_momentum_equation_and_conditions_on_the_faces(faces):
    faces, dt = np.array(faces), 0.03
    dim = len(faces)
    friction = np.full((dim, 2), 0.4)
    records, shape, strides, walls = block(dim)
    records[::5, 0] = 0.0
    records[::5, 1:] = 0.0  # empty nodes
    m = records[:, 0]
    full = m > 0
    grid = (*shape, dim)
    velocity = np.zeros((len(m), dim))
    velocity[full] = records[full, 1 : 1 + dim] / m[full, None]
    velocity = velocity.reshape(grid)
    contact = records[:, CONTACT].reshape(shape).astype(int)
    force = records[:, 1 + dim : 1 + 2 * dim].copy()

    nodes.momentum_to_velocity(records, shape, strides, dim, faces, walls, friction)
    constrained(velocity, np.zeros(grid), contact, faces, friction, walls, solved=False)
    inner = tuple(slice(1, n - 1) if n > 1 else slice(None) for n in shape)
    found = records.reshape(*shape, NODE)
    np.testing.assert_allclose(found[inner][..., 1 : 1 + dim], velocity[inner], rtol=0, atol=1e-14)
    np.testing.assert_array_equal(records[:, 1 + dim : 1 + 2 * dim], force)

    change = np.zeros((len(m), dim))
    change[full] = dt * force[full] / m[full, None]
    change = change.reshape(grid)
    velocity = velocity + change
    nodes.solve_momentum(records, shape, strides, dim, faces, walls, friction, dt)
    full = full.reshape(shape)[..., None]  # an empty node keeps its force as change: no particle sees it
    constrained(velocity, change, contact, faces, friction, walls, solved=True)
    np.testing.assert_allclose(found[inner][..., 1 : 1 + dim], velocity[inner], rtol=0, atol=1e-14)
    np.testing.assert_allclose(
        (found[..., 1 + dim : 1 + 2 * dim] * full)[inner], (change * full)[inner], rtol=0, atol=1e-14
    )


def test_friction_never_turns_the_slip_round():
    """A wall that pushes hard stops the slip; it neither reverses it nor pulls."""
    records = np.zeros((9, NODE))
    records[:, 0] = 1.0
    shape, strides = (3, 3, 1), (3, 1, 1)
    walls = np.array([[-9, 9], [0, 9]], dtype=np.int64)
    faces = np.array([[OPEN, OPEN], [FRICTION, OPEN]])
    friction = np.array([[0.0, 0.0], [0.5, 0.0]])
    slip, into = np.array([1.0, 0.2, 1.0]), np.array([-1.0, -1.0, +1.0])
    for i in range(3):
        records[3 * i, 1:3] = slip[i], into[i]
    nodes.solve_momentum(records, shape, strides, 2, faces, walls, friction, 1.0)
    np.testing.assert_allclose(records[[0, 3, 6], 1], [0.5, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(records[[0, 3, 6], 2], [0.0, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(records[[0, 3, 6], 3], [-0.5, -0.2, 0.0], atol=1e-15)
    np.testing.assert_allclose(records[[0, 3, 6], 4], [1.0, 1.0, 0.0], atol=1e-15)
    assert (records[[0, 3, 6], CONTACT] == [2, 2, 0]).all()  # remembered as the bit of its axis


# --- Tensors ------------------------------------------------------------------------------------------------


def deviatoric_rate(L):
    D = (L + L.transpose(0, 2, 1)) / 2
    return D - np.trace(D, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)


def test_shear_rate():
    rng = np.random.default_rng(9)
    L = random_gradients(rng, 3 * CHUNK + 5)
    L[:7] = 0.0
    deviator = deviatoric_rate(L)
    expected = np.sqrt(2 * np.einsum("pij,pij->p", deviator, deviator))
    np.testing.assert_allclose(tensors.shear_rate(L), expected, rtol=RELATIVE)
    floored = tensors.shear_rate(L, 2.0)
    np.testing.assert_allclose(floored, np.maximum(expected, 2.0), rtol=RELATIVE)


def test_shear_rate_of_simple_shear_is_the_shear():
    L = np.zeros((1, 3, 3))
    L[0, 0, 2] = 5.0
    assert tensors.shear_rate(L)[0] == pytest.approx(5.0, rel=1e-15)


def test_viscous_stress():
    rng = np.random.default_rng(10)
    L, mu = random_gradients(rng, CHUNK + 17), rng.uniform(0, 3, CHUNK + 17)
    found = np.empty((len(L), 6))
    tensors.viscous_stress(L, mu, found)
    np.testing.assert_allclose(
        symmetric(found), 2 * mu[:, None, None] * deviatoric_rate(L), rtol=0, atol=1e-13
    )


def test_volumes_follow_the_rate():
    """J (1 + Δt tr L) and V = V0 J."""
    rng = np.random.default_rng(11)
    n, dt = CHUNK + 3, 0.01
    rate, J, initial = rng.normal(size=n), rng.uniform(0.5, 1.5, n), rng.uniform(1, 2, n)
    volume, start = np.full(n, np.nan), J.copy()
    volumes.stretch(rate, dt, initial, J, volume)
    np.testing.assert_allclose(J, start * (1 + dt * rate), rtol=RELATIVE)
    np.testing.assert_allclose(volume, initial * start * (1 + dt * rate), rtol=RELATIVE)


@pytest.mark.parametrize("part", [0.0, 0.25, 1.0])
def test_volume_ratios_are_drawn_to_their_mean(part):
    rng = np.random.default_rng(18)
    J, mean = rng.uniform(0.5, 1.5, (2, CHUNK + 3))
    expected = (1 - part) * J + part * mean
    volumes.draw(J, mean, part)
    np.testing.assert_allclose(J, expected, rtol=RELATIVE)


def test_deformation_and_determinant():
    rng = np.random.default_rng(12)
    n, dt = 2 * CHUNK + 1, 0.02
    L, F = random_gradients(rng, n), np.eye(3) + random_gradients(rng, n, 0.1)
    expected = (np.eye(3) + dt * L) @ F
    tensors.deform(L, dt, F)
    np.testing.assert_allclose(F, expected, rtol=0, atol=1e-14)
    found = np.empty(n)
    tensors.determinant(F, found)
    np.testing.assert_allclose(found, np.linalg.det(F), rtol=1e-12, atol=1e-13)


# --- Particle domains ---------------------------------------------------------------------------------------


def right_stretch(F):
    """U = √(FᵀF) through the eigenvectors of FᵀF."""
    values, vectors = np.linalg.eigh(F.transpose(0, 2, 1) @ F)
    return np.einsum("pik,pk,pjk->pij", vectors, np.sqrt(values), vectors)


def rotations(rng, n):
    q, r = np.linalg.qr(rng.normal(size=(n, 3, 3)))
    q = q * np.sign(np.einsum("pii->pi", r))[:, None, :]
    q[:, :, 0] *= np.linalg.det(q)[:, None]
    return q


def deformations(kind, rng, n):
    if kind == "moderate":
        return np.eye(3) + random_gradients(rng, n, 0.15)
    if kind == "tiny":
        return np.eye(3) + random_gradients(rng, n, 1e-9)
    if kind == "rotation":
        return rotations(rng, n)
    if kind == "two equal stretches":
        return rotations(rng, n) @ np.diag([2.0, 2.0, 0.5]) @ rotations(rng, n)
    if kind == "uniform":
        return rotations(rng, n) * 0.8
    if kind == "strong":  # a spread sheet: a hundredfold between the stretches
        Q = rotations(rng, n)
        return rotations(rng, n) @ Q @ np.diag([5.0, 4.0, 0.05]) @ Q.transpose(0, 2, 1)
    raise ValueError(kind)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(
    ("kind", "tolerance"),
    [
        ("moderate", 1e-10),
        ("tiny", 1e-12),
        ("rotation", 1e-12),
        ("two equal stretches", 1e-7),
        ("uniform", 1e-12),
        ("strong", 1e-8),
    ],
)
def test_domains_follow_the_right_stretch(dim, kind, tolerance):
    rng = np.random.default_rng(13)
    n = CHUNK + 40
    F = deformations(kind, rng, n)
    initial = rng.uniform(0.5, 1.0, (n, dim))
    found = np.empty((n, dim))
    domains.follow_stretch(F, initial, found)
    U = right_stretch(F)
    expected = initial * np.einsum("pii->pi", U)[:, :dim]
    np.testing.assert_allclose(found, expected, rtol=tolerance)


@pytest.mark.parametrize("dim", [2, 3])
def test_domains_follow_the_volume(dim):
    rng = np.random.default_rng(14)
    J, initial = rng.uniform(0.2, 3.0, CHUNK + 2), rng.uniform(0.5, 1.0, (CHUNK + 2, dim))
    found = np.empty_like(initial)
    domains.follow_volume(J, initial, found)
    np.testing.assert_allclose(found, initial * J[:, None] ** (1 / dim), rtol=RELATIVE)


@pytest.mark.parametrize("follows", [True, False])
def test_domains_follow_the_normal_strain(follows):
    """l exp(∫ D_ii dt) for a steady stretch; nothing for a spin or a simple shear."""
    L = np.zeros((3, 3, 3))
    L[0] = np.diag([0.5, -0.2, -0.3])
    L[1, 0, 1], L[1, 1, 0] = 0.7, -0.7
    L[2, 0, 2] = 4.0
    box, half_size, least = np.ones((3, 3)), np.full((3, 3), 7.0), np.full((3, 3), 0.8)
    for _ in range(100):
        domains.follow_strain(L, 1e-2, box, least if follows else least[:0], half_size)
    np.testing.assert_allclose(box[0], np.exp([0.5, -0.2, -0.3]), rtol=2e-3)
    assert (box[1:] == 1).all()
    # The shape function sees the boxes, none below the least; or something else altogether.
    np.testing.assert_array_equal(half_size, np.maximum(box, least) if follows else 7.0)


@pytest.mark.parametrize("dim", [2, 3])
def test_every_domain_follows_its_own_strain(dim):
    rng = np.random.default_rng(19)
    n, dt = 2 * CHUNK + 7, 0.02
    L, box, least = random_gradients(rng, n), rng.uniform(0.5, 1, (n, dim)), rng.uniform(0.5, 1, (n, dim))
    half_size, expected = np.empty((n, dim)), box * (1 + dt * np.einsum("pii->pi", L)[:, :dim])
    domains.follow_strain(L, dt, box, least, half_size)
    np.testing.assert_allclose(box, expected, rtol=RELATIVE)
    np.testing.assert_array_equal(half_size, np.maximum(box, least))


# --- Where particles are ------------------------------------------------------------------------------------


class Sorted:
    """Particles in two groups and 4 × 2 blocks from cell (10, 5), in a domain of 50 × 20 cells."""

    cell = 0.1

    def __init__(self, n=4 * CHUNK, seed=15):
        rng = np.random.default_rng(seed)
        self.extent = np.array([5.0, 2.0])
        low, size = np.array([10, 5]), np.array([4, 2]) * BLOCK_WIDTH
        cell = (low + rng.integers(0, size, (n, 2))).astype(np.int32)
        cell[0], cell[-1] = low, low + size - 1
        group = np.sort(rng.integers(0, 2, n))
        kept = (group == 0) | ((cell - low) // BLOCK_WIDTH != [2, 0]).any(axis=1)  # an empty block of a group
        cell, group = cell[kept], group[kept]
        self.blocks = Blocks.of(cell, group)
        assert (np.diff(self.blocks.first) == 0).any()
        self.block = self.blocks.cell[self.blocks.number]
        """Lowest cell of each particle's block."""
        self.position = self.cell * (cell[self.blocks.order] + rng.uniform(0.01, 0.99, cell.shape))
        self.half_size = np.full(cell.shape, 0.25 * self.cell)
        self.low, self.high = low - 1, low + size
        self.verdicts = np.empty((len(self.blocks.cell), 2), dtype=np.int64)

    def ask(self):
        return locate.locate(2)(
            self.position, self.half_size, self.extent, 1 / self.cell, self.blocks.first, self.blocks.cell,
            self.low, self.high, self.verdicts,
        )  # fmt: skip


def test_particles_in_place_are_here():
    assert Sorted().ask() == (locate.HERE, -1)


@pytest.mark.parametrize("size", [0.0, -0.01, np.nan, np.inf])
def test_a_particle_without_a_box_is_noticed(size):
    particles = Sorted()
    particles.half_size[300, 1] = size
    assert particles.ask() == (locate.LOST, 300)


@pytest.mark.parametrize("p", [0, 300, 777, -1])
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize(
    ("where", "verdict"),
    [
        (lambda block: block - 0.5, locate.HERE),  # within a cell below its block
        (lambda block: block - 1.5, locate.STRAYED),
        (lambda block: block + BLOCK_WIDTH + 0.5, locate.HERE),
        (lambda block: block + BLOCK_WIDTH + 1.5, locate.STRAYED),
        (lambda block: -0.01, locate.LOST),
        (lambda block: 50.01, locate.LOST),
        (lambda block: np.nan, locate.LOST),
        (lambda block: np.inf, locate.LOST),
        (lambda block: -np.inf, locate.LOST),
    ],
)
def test_a_particle_elsewhere_is_noticed(p, axis, where, verdict):
    particles = Sorted()
    p %= len(particles.position)
    particles.position[p, axis] = where(particles.block[p, axis]) * particles.cell
    found, who = particles.ask()
    assert found == verdict
    assert who == (p if verdict == locate.LOST else -1)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("upper", [False, True], ids=["low", "high"])
def test_a_particle_outside_the_window_has_strayed_whatever_its_block(axis, upper):
    """The window is laid around the cells that were occupied; a block may reach far beyond it."""
    particles = Sorted()
    edge = particles.block[:, axis].max() + 2 if upper else particles.block[:, axis].min() + 3
    (particles.high if upper else particles.low)[axis] = edge
    cells = particles.position[:, axis] / particles.cell
    np.clip(cells, *((0, edge + 0.5) if upper else (edge + 0.5, 99)), out=cells)
    particles.position[:, axis] = cells * particles.cell
    assert particles.ask()[0] == locate.HERE
    p = int(np.flatnonzero(cells == edge + 0.5)[7])
    particles.position[p, axis] = (edge + (1.5 if upper else -0.5)) * particles.cell
    assert particles.ask() == (locate.STRAYED, -1)


def test_a_lost_particle_matters_more_than_those_that_have_strayed():
    for strays, lost in ([0, -1], 300), ([300], 0), ([300], -1), ([299], 300), ([301], 300):
        particles = Sorted()
        particles.position[strays, 0] = 0.05
        particles.position[lost, 1] = np.nan
        assert particles.ask() == (locate.LOST, lost % len(particles.position))


def test_wrap():
    rng = np.random.default_rng(16)
    position = rng.uniform(-3, 5, (CHUNK + 9, 3))
    position[:3, 1] = [0.0, 2.0, -1e-18]
    expected = position.copy()
    expected[:, 1] = position[:, 1] - np.floor(position[:, 1] / 2.0) * 2.0
    locate.wrap(position, 1, 2.0)
    np.testing.assert_allclose(position, expected, rtol=0, atol=1e-15)
    assert (position[:, 1] >= 0).all()
    assert (position[:, 1] <= 2.0).all()


@pytest.mark.parametrize("dim", [2, 3])
def test_largest_speed(dim):
    velocity = np.random.default_rng(17).normal(size=(3 * CHUNK + 1, dim))
    scratch = np.empty(len(velocity) // CHUNK + 1)
    found = locate.largest_speed(velocity, scratch)
    assert found == pytest.approx(np.linalg.norm(velocity, axis=1).max(), rel=1e-15)


@pytest.mark.parametrize(("n", "chunks"), [(0, 0), (1, 1), (CHUNK, 1), (CHUNK + 1, 2)])
def test_chunks(n, chunks):
    assert chunk_count(n) == chunks
