"""Kernels on nodes alone: images at faces, averages, the momentum equation, against plain NumPy."""

from __future__ import annotations

import numpy as np
import pytest

from mpmkit.kernels import nodes
from mpmkit.kernels.nodes import FRICTION, MIRROR, OPEN, PERIODIC, RELEASING_STICK, STICK
from mpmkit.kernels.scatter import CONTACT, NODE, PUSHED, TOUCHED

pytestmark = pytest.mark.usefixtures("each_number_of_threads")


def block(dim, seed=6):
    """Random records, shape and walls of a window whose walls stand one node inside it."""
    rng = np.random.default_rng(seed)
    shape = (8, 7, 6) if dim == 3 else (8, 7, 1)
    walls = np.array([[1, n - 2] for n in shape[:dim]], dtype=np.int64)
    records = rng.normal(size=(int(np.prod(shape)), NODE))
    records[:, 0] = rng.uniform(1, 2, len(records))
    records[:, CONTACT] = rng.integers(0, 2**dim, len(records)) + TOUCHED * rng.integers(
        0, 2**dim, len(records)
    )
    return records, shape, walls


def rows(shape):
    """All rows along the last axis of a window, and tasks of one row or none each."""
    length = shape[2] if shape[2] > 1 else shape[1]
    first = np.arange(0, int(np.prod(shape)), length)
    return np.stack([first, first + length], axis=1), np.arange(len(first) + 1)


def mirrors(shape, faces):
    """(ghost, image, wall) of the nodes behind the faces of a window of ``block``; first of each plane."""
    index = np.arange(int(np.prod(shape))).reshape(shape)
    found, first = [np.empty((0, 3), dtype=np.int64)], [0]
    for axis in range(len(faces)):
        n = shape[axis]
        of_ghost = {ghost: image for _, ghost, image in images(faces, axis)}
        for ghost in (0, n - 1, n - 2):
            if ghost in of_ghost:
                image = of_ghost[ghost]
                planes = [plane(index, axis, k).ravel() for k in (ghost, image, (ghost + image) // 2)]
                found.append(np.stack(planes, axis=1))
            first.append(sum(map(len, found)))
    return np.concatenate(found), np.array(first)


def uncounted(faces, shape, sums=1):
    """Arguments by which kernels count what faces give, of a window of ``block``: tests/test_face_impulses.py
    looks at what they find."""
    n, dim = len(mirrors(shape, faces)[0]), len(faces)
    return np.zeros((n, dim)), 0.1, np.zeros((n, NODE)), False, *np.zeros((sums, 2 * dim, 2 * dim + 1))


def plane(array, axis, k):
    """View of a plane of nodes of an array (nx, ny, nz, slots)."""
    return np.moveaxis(array, axis, 0)[k]


def parity(face, dim, axis, vectors):
    """Signs of the entries of a node under reflection at a face.

    A mirror reverses the normal components of both vectors, a stick wall reverses all components.
    """
    sign = np.ones(NODE)
    if vectors and face in (STICK, RELEASING_STICK):
        sign[1 : 1 + 2 * dim] = -1.0
    elif vectors and face != PERIODIC:
        sign[[1 + axis, 1 + dim + axis]] = -1.0
    return sign


FACES_2D = [
    [[OPEN, OPEN], [OPEN, OPEN]],
    [[MIRROR, OPEN], [OPEN, MIRROR]],
    [[MIRROR, MIRROR], [FRICTION, STICK]],
    [[RELEASING_STICK, STICK], [FRICTION, RELEASING_STICK]],
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


BIT = {STICK: TOUCHED, FRICTION: PUSHED, RELEASING_STICK: PUSHED}
"""What a node has where a wall acts; other faces act everywhere."""


def acts(face, contacts, axis):
    """Whether a face across an axis acts at nodes, from what they know of contact."""
    everywhere = face not in BIT
    return (contacts.astype(int) & BIT.get(face, 0) << axis > 0) | everywhere


def reflecting(records, face, axis, ghost, image, vectors):
    """Columns of nodes behind which a face reflects vectors: of a wall, those where it acts."""
    contacts = plane(records, axis, (ghost + image) // 2)[..., CONTACT]
    return acts(face, contacts, axis)[..., None] | (not vectors)


@each_set_of_faces
@pytest.mark.parametrize("vectors", [True, False], ids=["vectors", "scalars"])
def test_fold(faces, vectors):
    faces = np.array(faces)
    dim = len(faces)
    records, shape, _ = block(dim)
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
    nodes.fold(records, faces, *mirrors(shape, faces), 0, last, vectors)
    np.testing.assert_allclose(records.reshape(expected.shape), expected, rtol=0, atol=1e-13)
    assert records[:, 0].sum() == pytest.approx(total, rel=1e-14)  # mass is moved, never lost


@each_set_of_faces
@pytest.mark.parametrize("vectors", [True, False], ids=["vectors", "scalars"])
def test_fill(faces, vectors):
    faces = np.array(faces)
    dim = len(faces)
    records, shape, _ = block(dim)
    expected = records.copy().reshape(*shape, NODE)
    last = 1 + 2 * dim
    for axis in reversed(range(dim)):
        for face, ghost, image in images(faces, axis):
            sign = parity(face, dim, axis, vectors)
            where = reflecting(expected, face, axis, ghost, image, vectors)
            behind, before = plane(expected, axis, ghost), plane(expected, axis, image)
            behind[..., 1:last] = np.where(where, sign * before, behind)[..., 1:last]
    nodes.fill(records, faces, *mirrors(shape, faces), 1, last, vectors)
    np.testing.assert_allclose(records.reshape(expected.shape), expected, rtol=0, atol=0)


@each_set_of_faces
def test_fill_is_the_transpose_of_fold(faces):
    """⟨fold a, b⟩ = ⟨a, fill b⟩ for all a and b whose ghosts are what ``fill`` makes of them.

    And where walls act at a ghost in their plane as they do at its image, as ``kernels.touch`` marks them.
    """
    faces = np.array(faces)
    dim = len(faces)
    a, shape, _ = block(dim, seed=7)
    b, *_ = block(dim, seed=8)
    nodes.fill(a, faces, *mirrors(shape, faces), CONTACT, NODE, False)
    b[:, CONTACT] = a[:, CONTACT]
    last = 1 + 2 * dim
    filled = b.copy()
    nodes.fill(filled, faces, *mirrors(shape, faces), 0, last, True)
    folded = a.copy()
    nodes.fold(folded, faces, *mirrors(shape, faces), 0, last, True)
    assert np.vdot(folded[:, :last], filled[:, :last]) == pytest.approx(
        np.vdot(a[:, :last], filled[:, :last]), rel=1e-12, abs=1e-12
    )


def test_clear_keeps_nothing_but_contact():
    records, shape, _ = block(3)
    start = records.copy()
    nodes.clear(records, *rows(shape))
    assert (records[:, :CONTACT] == 0).all()
    np.testing.assert_array_equal(records[:, CONTACT], start[:, CONTACT])


@each_set_of_faces
def test_averages_at_nodes(faces):
    """Σ w f / Σ w with what lies on ghosts at their images, at the ghosts too; zero where nothing is."""
    faces = np.array(faces)
    dim = len(faces)
    records, shape, _ = block(dim)
    pairs, average = records[:, :2].copy(), np.full((len(records), 1), np.nan)
    pairs[::5] = 0.0
    expected = np.zeros_like(records)
    expected[:, :2] = pairs
    nodes.fold(expected, faces, *mirrors(shape, faces), 0, 2, False)
    weight, sums = expected[:, 0], expected[:, 1]
    expected[:, 0] = np.divide(sums, weight, out=np.zeros_like(sums), where=weight > 0)
    nodes.fill(expected, faces, *mirrors(shape, faces), 0, 1, False)
    nodes.divide_pairs(pairs, average, *rows(shape), faces, *mirrors(shape, faces))
    np.testing.assert_allclose(average[:, 0], expected[:, 0], rtol=0, atol=1e-13)
    assert (pairs == 0).all()  # ready for the next average


def constrained(velocity, change, contact, faces, friction, walls, solved):
    """Reference of the conditions on the faces, on (nx, ny, nz, dim); ``contact`` as in the records.

    All walls at once: what each pushes is the velocity towards it before any of them acts.
    """
    dim = velocity.shape[-1]
    start, grips = velocity.copy(), []
    for axis, side in np.ndindex(dim, 2):
        code, k, inward = faces[axis, side], int(walls[axis, side]), 1 - 2 * side
        v, known = plane(velocity, axis, k), plane(contact, axis, k)
        held = acts(code, known, axis)
        if code in (FRICTION, RELEASING_STICK) and solved:
            push = np.maximum(-inward * plane(start, axis, k)[..., axis], 0.0) * acts(STICK, known, axis)
            held = push > 0
            coefficient = friction[axis, side] if code == FRICTION else 1e300
            grips.append((axis, k, coefficient * push))
        if code in (STICK, RELEASING_STICK):
            v[held] = 0.0
        elif code in (MIRROR, FRICTION):
            v[..., axis][held] = 0.0
    for axis, k, grip in grips:
        v = plane(velocity, axis, k)
        slip = np.linalg.norm(np.delete(v, axis, axis=-1), axis=-1)
        keep = np.maximum(1 - grip / np.where(slip > 0, slip, 1.0), 0.0)[..., None]
        v *= np.where(np.arange(dim) == axis, 1.0, keep)
    if solved:
        change += velocity - start


@pytest.mark.parametrize(
    "faces",
    [f for f in FACES_2D + FACES_3D if not any(PERIODIC in pair for pair in f)]
    + [[[FRICTION, FRICTION], [FRICTION, FRICTION], [FRICTION, FRICTION]], [[STICK, STICK], [STICK, MIRROR]]]
    + [[[FRICTION, FRICTION], [MIRROR, STICK], [FRICTION, MIRROR]]]
    + [[[RELEASING_STICK, FRICTION], [STICK, RELEASING_STICK], [FRICTION, MIRROR]]],
    ids=str,
)
def test_momentum_equation_and_conditions_on_the_faces(faces):
    faces, dt = np.array(faces), 0.03
    dim = len(faces)
    friction = np.full((dim, 2), 0.4)
    records, shape, walls = block(dim)
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

    nodes.momentum_to_velocity(
        records, *rows(shape), faces, *mirrors(shape, faces), friction, *uncounted(faces, shape)
    )
    constrained(velocity, np.zeros(grid), contact, faces, friction, walls, solved=False)
    inner = tuple(slice(1, n - 1) if n > 1 else slice(None) for n in shape)
    found = records.reshape(*shape, NODE)
    np.testing.assert_allclose(found[inner][..., 1 : 1 + dim], velocity[inner], rtol=0, atol=1e-14)
    np.testing.assert_array_equal(records[:, 1 + dim : 1 + 2 * dim], force)

    change = np.zeros((len(m), dim))
    change[full] = dt * force[full] / m[full, None]
    change = change.reshape(grid)
    velocity = velocity + change
    nodes.solve_momentum(
        records, *rows(shape), faces, *mirrors(shape, faces), friction, *uncounted(faces, shape, 2), dt
    )
    full = full.reshape(shape)[..., None]  # an empty node keeps its force as change: no particle sees it
    constrained(velocity, change, contact, faces, friction, walls, solved=True)
    np.testing.assert_allclose(found[inner][..., 1 : 1 + dim], velocity[inner], rtol=0, atol=1e-14)
    np.testing.assert_allclose(
        (found[..., 1 + dim : 1 + 2 * dim] * full)[inner], (change * full)[inner], rtol=0, atol=1e-14
    )


def test_friction_never_reverses_the_slip():
    """A wall that pushes hard stops the slip; it neither reverses it nor pulls."""
    records = np.zeros((9, NODE))
    records[:, 0] = 1.0
    faces = np.array([[OPEN, OPEN], [FRICTION, OPEN]])
    friction = np.array([[0.0, 0.0], [0.5, 0.0]])
    slip, into = np.array([1.0, 0.2, 1.0]), np.array([-1.0, -1.0, +1.0])
    for i in range(3):
        records[3 * i, 1:3] = slip[i], into[i]
        records[3 * i, CONTACT] = TOUCHED << 1
    behind = np.array([[k + 1, k + 2, k] for k in (0, 3, 6)])  # ghosts and images that are not used
    plane_first = np.array([0, 0, 0, 0, 3, 3, 3])
    counted = np.zeros((3, 2)), 0.1, np.zeros((3, NODE)), False, np.zeros((4, 4)), np.zeros((4, 4))
    nodes.solve_momentum(records, *rows((3, 3, 1)), faces, behind, plane_first, friction, *counted, 1.0)
    np.testing.assert_allclose(records[[0, 3, 6], 1], [0.5, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(records[[0, 3, 6], 2], [0.0, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(records[[0, 3, 6], 3], [-0.5, -0.2, 0.0], atol=1e-15)
    np.testing.assert_allclose(records[[0, 3, 6], 4], [1.0, 1.0, 0.0], atol=1e-15)
    pushed = records[[0, 3, 6], CONTACT].astype(int) - (TOUCHED << 1)
    assert (pushed == [PUSHED << 1, PUSHED << 1, 0]).all()  # remembered as the bit of its axis
