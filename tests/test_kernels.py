"""Every compiled kernel against a plain NumPy reference that is written to be read, on small random data."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from mpmkit.kernels import domains, gather, locate, nodes, scatter, tensors
from mpmkit.kernels.compile import CHUNK, chunk_count
from mpmkit.kernels.nodes import FRICTION, MIRROR, OPEN, PERIODIC, STICK

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
    """Random particles in sorted slabs over a window, two materials, and a dense matrix of the weights."""

    def __init__(self, dim, support, radial=False, n=700, seed=4, affine=False):
        rng = np.random.default_rng(seed)
        self.rng, self.dim, self.support, self.n = rng, dim, support, n
        self.cells = np.array([23, 6, 5][:dim])
        self.lower = np.array([-3, -1, -2][:dim], dtype=np.int64)
        size = [int(c) + 6 for c in self.cells] + [1] * (3 - dim)
        self.shape = tuple(size)
        self.strides = (size[1] * size[2], size[2], 1)
        self.count = size[0] * size[1] * size[2]
        groups = np.sort(rng.integers(0, 2, n))
        base = rng.integers(0, self.cells, (n, dim)).astype(np.int32)
        slab = base[:, 0] // 5
        order = np.lexsort((slab, groups))
        self.base, groups, slab = base[order], groups[order], slab[order]
        edges = np.arange(int(slab.max()) + 2)
        starts = [np.searchsorted(groups, g) for g in range(2)]
        self.slabs = np.array([starts[g] + np.searchsorted(slab[groups == g], edges) for g in range(2)])
        self.weight = rng.uniform(size=(n, dim, support))
        self.weight /= self.weight.sum(axis=2, keepdims=True)
        self.gradient = rng.normal(size=(n, dim, support))
        self.hoop = rng.uniform(size=(n, support if radial else 0))
        self.mass, self.volume = rng.uniform(1, 2, n), rng.uniform(1, 2, n)
        self.velocity, self.position = rng.normal(size=(n, dim)), rng.uniform(1, 2, (n, dim))
        self.affine = rng.normal(size=(n, dim, dim)) if affine else np.zeros((n, 0, 0))
        self.stress, self.pressure = rng.normal(size=(n, 6)), rng.normal(size=n)
        self.gravity = np.array([0.3, -0.7, -9.81][:dim])

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
        kernel = scatter.scatter_2d if self.dim == 2 else scatter.scatter_3d
        kernel(
            found, self.strides, self.lower, self.slabs, self.base, self.weight, self.gradient, self.hoop,
            self.mass, self.velocity, self.affine, self.volume, self.stress, self.pressure, self.gravity,
            CELL, momentum, forces,
        )  # fmt: skip

    def reference(self, momentum, forces):
        expected, dim = np.zeros((self.count, NODE)), self.dim
        cauchy = symmetric(self.stress) - self.pressure[:, None, None] * np.eye(3)
        centroid = np.einsum("a,pda->pd", np.arange(self.support), self.weight)
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
def test_slabs_of_no_particle_are_skipped(dim, radial):
    scene = Scene(dim, 2, radial, n=1)
    found = np.zeros((scene.count, NODE))
    scene.scatter(found, True, True)
    np.testing.assert_allclose(found, scene.reference(True, True), rtol=0, atol=1e-14)


@spaces
@supports
def test_scatter_scalar(dim, radial, support):
    scene = Scene(dim, support, radial)
    values = scene.rng.normal(size=scene.n)
    found = np.zeros((scene.count, 2))
    scatter.scatter_scalar(
        found, scene.strides, scene.lower, scene.slabs, scene.base, scene.weight, scene.volume, values
    )
    expected = np.zeros_like(found)
    for pick, node in scene.corners():
        share = scene.volume * scene.product(pick)
        np.add.at(expected, node, np.column_stack([share, share * values]))
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)


@spaces
@supports
@pytest.mark.parametrize("flip", [1.0, 0.0, 0.3])
def test_advance(dim, radial, support, flip):
    scene, dt = Scene(dim, support, radial), 0.07
    grid = scene.rng.normal(size=(scene.count, NODE))
    new, change, hoop_rate = np.zeros((scene.n, dim)), np.zeros((scene.n, dim)), np.zeros(scene.n)
    for pick, node in scene.corners():
        N = scene.product(pick)[:, None]
        new += N * grid[node, 1 : 1 + dim]
        change += N * grid[node, 1 + dim : 1 + 2 * dim]
        if radial:
            hoop_rate += scene.product(pick, hoop=True) * grid[node, 1]
    position, velocity = scene.position + dt * new, flip * (scene.velocity + change) + (1 - flip) * new
    if radial:  # the ring's middle moves with the hoop rate
        position[:, 0] = scene.position[:, 0] * (1 + dt * hoop_rate)
    kernel = gather.advance_2d if dim == 2 else gather.advance_3d
    kernel(
        grid, scene.strides, scene.lower, scene.base, scene.weight, scene.hoop, dt, flip, scene.position,
        scene.velocity,
    )  # fmt: skip
    np.testing.assert_allclose(scene.position, position, rtol=RELATIVE, atol=1e-14)
    np.testing.assert_allclose(scene.velocity, velocity, rtol=0, atol=1e-13)


@spaces
@supports
def test_velocity_gradient(dim, radial, support):
    scene = Scene(dim, support, radial)
    grid = scene.rng.normal(size=(scene.count, NODE))
    start = scene.rng.normal(size=(scene.n, 3, 3))
    found, expected = start.copy(), start.copy()
    expected[:, :dim, :dim] = 0.0
    if radial:
        expected[:, 2, 2] = 0.0
    for pick, node in scene.corners():
        for i in range(dim):
            for j in range(dim):
                expected[:, i, j] += grid[node, 1 + i] * scene.product(pick, slope_axis=j)
        if radial:
            expected[:, 2, 2] += grid[node, 1] * scene.product(pick, hoop=True)
    kernel = gather.gradient_2d if dim == 2 else gather.gradient_3d
    kernel(grid, scene.strides, scene.lower, scene.base, scene.weight, scene.gradient, scene.hoop, found)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)  # components off the plane untouched


@spaces
@supports
def test_gather_scalar_is_the_transpose_of_scatter_scalar(dim, radial, support):
    scene = Scene(dim, support, radial)
    field = scene.rng.normal(size=scene.count)
    found, expected = np.empty(scene.n), np.zeros(scene.n)
    gather.gather_scalar(field, scene.strides, scene.lower, scene.base, scene.weight, found)
    for pick, node in scene.corners():
        expected += scene.product(pick) * field[node]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13)
    values, one = scene.rng.normal(size=scene.n), np.ones(scene.n)
    sums = np.zeros((scene.count, 2))
    scatter.scatter_scalar(
        sums, scene.strides, scene.lower, scene.slabs, scene.base, scene.weight, one, values
    )
    assert field @ sums[:, 1] == pytest.approx(found @ values, rel=1e-11)


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


def test_trace_and_volume():
    rng = np.random.default_rng(11)
    n, dt = CHUNK + 3, 0.01
    L, J = random_gradients(rng, n), rng.uniform(0.5, 1.5, n)
    rate, start = np.empty(n), J.copy()
    tensors.trace(L, rate)
    np.testing.assert_allclose(rate, np.trace(L, axis1=1, axis2=2), rtol=0, atol=1e-14)
    tensors.stretch_volume(rate, dt, J)
    np.testing.assert_allclose(J, start * (1 + dt * rate), rtol=RELATIVE)


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


def test_domains_follow_the_normal_strain():
    """l exp(∫ D_ii dt) for a steady stretch; nothing for a spin or a simple shear."""
    L = np.zeros((3, 3, 3))
    L[0] = np.diag([0.5, -0.2, -0.3])
    L[1, 0, 1], L[1, 1, 0] = 0.7, -0.7
    L[2, 0, 2] = 4.0
    found = np.ones((3, 3))
    for _ in range(1000):
        domains.follow_strain(L, 1e-3, found)
    np.testing.assert_allclose(found[0], np.exp([0.5, -0.2, -0.3]), rtol=2e-4)
    assert (found[1:] == 1).all()


# --- Where particles are ------------------------------------------------------------------------------------


class Sorted:
    """Particles in two groups and four slabs of 5 cells, from cell 10 of the first axis."""

    width, first, cell = 5, 2, 0.1

    def __init__(self, n=4 * CHUNK, seed=15):
        rng = np.random.default_rng(seed)
        self.extent = np.array([5.0, 2.0])
        group = np.sort(rng.integers(0, 2, n))
        slab = rng.integers(0, 4, n)
        slab[(group == 1) & (slab == 2)] = 3  # one slab of one group is empty
        order = np.lexsort((slab, group))
        self.group, self.slab = group[order], slab[order]
        self.slabs = np.empty((2, 5), dtype=np.int64)
        for g in range(2):
            start = np.searchsorted(self.group, g)
            self.slabs[g] = start + np.searchsorted(self.slab[self.group == g], np.arange(5))
        x = (self.first + self.slab + rng.uniform(size=n)) * self.width * self.cell
        z = rng.uniform(0.5, 1.0, n)
        self.position = np.column_stack([x, z])
        self.half_size = np.full((n, 2), 0.25 * self.cell)
        self.low, self.high = np.array([8, 3]), np.array([31, 11])
        self.verdicts = np.empty((n // CHUNK + 1, 2), dtype=np.int64)

    def ask(self):
        return locate.locate(
            self.position, self.half_size, self.extent, 1 / self.cell, self.slabs, self.width, self.first,
            self.low, self.high, self.verdicts,
        )  # fmt: skip


def test_particles_in_place_are_here():
    assert Sorted().ask()[0] == locate.HERE


@pytest.mark.parametrize("size", [0.0, -0.01, np.nan, np.inf])
def test_a_particle_without_a_box_is_noticed(size):
    particles = Sorted()
    particles.half_size[300, 1] = size
    assert particles.ask() == (locate.LOST, 300)


@pytest.mark.parametrize("p", [0, 300, 777, 4 * CHUNK - 1])
@pytest.mark.parametrize(
    ("axis", "where", "verdict"),
    [
        (0, lambda s, p: (s.first + s.slab[p]) * 5 - 0.5, locate.HERE),  # within a cell below its slab
        (0, lambda s, p: (s.first + s.slab[p]) * 5 - 1.5, locate.STRAYED),
        (0, lambda s, p: (s.first + s.slab[p] + 1) * 5 + 0.5, locate.HERE),
        (0, lambda s, p: (s.first + s.slab[p] + 1) * 5 + 1.5, locate.STRAYED),
        (1, lambda s, p: 3.5, locate.HERE),
        (1, lambda s, p: 2.5, locate.STRAYED),
        (1, lambda s, p: 11.5, locate.HERE),
        (1, lambda s, p: 12.5, locate.STRAYED),
        (1, lambda s, p: -0.01, locate.LOST),
        (1, lambda s, p: 20.01, locate.LOST),
        (0, lambda s, p: np.nan, locate.LOST),
        (0, lambda s, p: np.inf, locate.LOST),
        (1, lambda s, p: -np.inf, locate.LOST),
        (1, lambda s, p: np.nan, locate.LOST),
    ],
)
def test_a_particle_elsewhere_is_noticed(p, axis, where, verdict):
    particles = Sorted()
    particles.position[p, axis] = where(particles, p) * particles.cell
    found, who = particles.ask()
    assert found == verdict
    if verdict == locate.LOST:
        assert who == p


@pytest.mark.parametrize(("cell", "verdict"), [(8.5, locate.STRAYED), (31.5, locate.STRAYED)])
def test_a_particle_outside_the_window_has_strayed_whatever_its_slab(cell, verdict):
    """The window is laid around the cells that were occupied; a slab may reach far beyond it."""
    particles = Sorted()
    particles.low[0], particles.high[0] = 11, 28
    inside = (particles.position[:, 0] > 1.12) & (particles.position[:, 0] < 2.88)
    particles.position[~inside, 0] = (particles.first + particles.slab[~inside] + 0.5) * 0.5
    assert particles.ask()[0] == locate.HERE
    p = int(np.flatnonzero(particles.slab == (0 if cell < 20 else 3))[0])
    particles.position[p, 0] = (10.5 if cell < 20 else 29.5) * particles.cell
    assert particles.ask()[0] == verdict


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
