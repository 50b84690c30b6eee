"""What every registered shape function must be: a partition of unity that knows its own gradient.

A shape function with parameters is tried with its defaults. Averages over a particle's box are checked only
for those that average, which they show by their weights changing with the half-size.
"""

from __future__ import annotations

from itertools import pairwise

import numba
import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

from mpmkit.registry import installed

SHAPES = {name: plugin() for name, plugin in installed().of_kind("shape").items()}
DX = 0.05
CELLS = 7
N = 400

each = pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
each_dim = pytest.mark.parametrize("dim", [1, 2, 3])


@pytest.fixture(autouse=True)
def _one_thread():
    numba.set_num_threads(1)


def cloud(dim, n=N, seed=1):
    """Positions and half-sizes, among them boxes as wide as a cell and positions on nodes and mid-cells."""
    rng = np.random.default_rng(seed)
    position = rng.uniform(0.0, CELLS * DX, (n, dim))
    half_size = rng.uniform(0.05, 0.5, (n, dim)) * DX
    half_size[: n // 4] = DX / 2
    half_size[n // 4 : n // 2] = DX / 4
    position[: n // 8] = DX * rng.integers(0, CELLS + 1, (n // 8, dim))
    position[n // 8 : n // 4] = DX * (rng.integers(0, CELLS, (n // 4 - n // 8, dim)) + 0.5)
    return position, half_size


def tables(shape, position, half_size, cell_size=DX):
    n, dim = position.shape
    base = np.full((n, dim), -99, dtype=np.int32)
    weight = np.full((n, dim, shape.support), np.nan)
    gradient = np.full((n, dim, shape.support), np.nan)
    shape.fill(position, half_size, cell_size, base, weight, gradient)
    return base, weight, gradient


def radial_tables(shape, radius, half_size, cell_size=DX):
    """As the solver does it: the tables of both axes first, then the radial ones over them."""
    both = np.column_stack([radius, radius])
    base, weight, gradient = tables(shape, both, np.column_stack([half_size, half_size]), cell_size)
    base, weight, gradient = base[:, 0], weight[:, 0], gradient[:, 0]  # strided views, as in a scene
    hoop = np.full((len(radius), shape.support), np.nan)
    shape.fill_radial(radius, half_size, cell_size, base, weight, gradient, hoop)
    return base, weight, gradient, hoop


def nodes_of(shape, base, cell_size=DX):
    return (base[..., None] + np.arange(shape.support)) * cell_size


def rings(seed=2, n=N):
    """Radii and half-sizes of rings, a quarter of which touch the axis."""
    rng = np.random.default_rng(seed)
    half_size = rng.uniform(0.05, 0.5, n) * DX
    radius = half_size + rng.uniform(0.0, CELLS * DX, n)
    radius[: n // 4] = half_size[: n // 4]
    return radius, half_size


# --- Plain axes ---------------------------------------------------------------------------------------------


@each
@each_dim
def test_weights_are_a_partition_of_unity(shape, dim):
    _, weight, _ = tables(shape, *cloud(dim))
    assert (weight >= -1e-15).all()
    np.testing.assert_allclose(weight.sum(axis=2), 1.0, rtol=0, atol=4e-15)


@each
@each_dim
def test_gradients_sum_to_zero(shape, dim):
    _, _, gradient = tables(shape, *cloud(dim))
    np.testing.assert_allclose(gradient.sum(axis=2) * DX, 0.0, rtol=0, atol=1e-14)


@each
@each_dim
def test_linear_fields_are_reproduced(shape, dim):
    position, half_size = cloud(dim)
    base, weight, gradient = tables(shape, position, half_size)
    x = nodes_of(shape, base)
    np.testing.assert_allclose((weight * x).sum(axis=2), position, rtol=0, atol=1e-14 * CELLS)
    np.testing.assert_allclose((gradient * x).sum(axis=2), 1.0, rtol=0, atol=1e-13)


@each
@each_dim
def test_base_is_a_node_near_the_particle(shape, dim):
    position, half_size = cloud(dim)
    base, weight, _ = tables(shape, position, half_size)
    distance = np.abs(nodes_of(shape, base) - position[..., None])
    # What has any weight is less than a cell and half a box away; the window of nodes is laid out for that.
    reach = DX + half_size[..., None] + 1e-12
    assert (distance[weight > 1e-14] <= np.broadcast_to(reach, distance.shape)[weight > 1e-14]).all()
    assert base.min() >= -1
    cell = np.floor(position / DX)
    assert (base >= cell - 1).all()
    assert (base + shape.support - 1 <= cell + 2).all()


@each
@each_dim
def test_gradient_is_the_derivative_of_the_weights(shape, dim):
    position, half_size = cloud(dim, seed=3)
    step = 1e-6 * DX
    low, high = position - step, position + step
    base, _, gradient = tables(shape, position, half_size)
    base_low, weight_low, _ = tables(shape, low, half_size)
    base_high, weight_high, _ = tables(shape, high, half_size)
    # Away from kinks: no edge of the box, nor its middle, within a few steps of a node.
    edges = np.stack([position - half_size, position, position + half_size]) / DX
    smooth = (np.abs(edges - np.rint(edges)) > 1e-4).all(axis=0)
    assert smooth.sum() > 0.4 * smooth.size
    assert (base_low[smooth] == base[smooth]).all()
    assert (base_high[smooth] == base[smooth]).all()
    slope = (weight_high - weight_low) / (2 * step)
    np.testing.assert_allclose(slope[smooth] * DX, gradient[smooth] * DX, rtol=0, atol=1e-8)


@each
def test_weights_are_continuous_across_nodes(shape):
    """Moving a particle by next to nothing over a node, or its box over one, changes no node's weight."""
    half_size = np.full((3, 1), 0.2 * DX)
    kinks = 4 * DX + np.array([[0.0], [0.2 * DX], [-0.2 * DX]])
    found = []
    for shift in (-1e-10, 1e-10):
        base, weight, _ = tables(shape, kinks + shift * DX, half_size)
        dense = np.zeros((3, CELLS + 4))
        for a in range(shape.support):
            np.add.at(dense, (np.arange(3), base[:, 0] + a + 1), weight[:, 0, a])
        found.append(dense)
    np.testing.assert_allclose(found[0], found[1], rtol=0, atol=1e-9)


@each
@pytest.mark.parametrize("cells", [2, -1, 1000])
def test_weights_do_not_depend_on_the_place_in_the_lattice(shape, cells):
    position, half_size = cloud(2)
    position += 2.25 * DX
    base, weight, gradient = tables(shape, position, half_size)
    base2, weight2, gradient2 = tables(shape, position + cells * DX, half_size)
    tolerance = 1e-12
    edges = np.stack([position - half_size, position]) / DX
    clear = (np.abs(edges - np.rint(edges)) > 1e-9).all(axis=0)  # else rounding may choose the other cell
    np.testing.assert_array_equal(base2[clear], base[clear] + cells)
    np.testing.assert_allclose(weight2[clear], weight[clear], rtol=0, atol=tolerance)
    np.testing.assert_allclose(gradient2[clear] * DX, gradient[clear] * DX, rtol=0, atol=2 * tolerance / 0.1)


@each
def test_mirrored_particles_have_mirrored_weights(shape):
    position, half_size = cloud(1)
    length = CELLS * DX
    dense = np.zeros((2, N, CELLS + 5))
    for k, x in enumerate((position, length - position)):
        base, weight, _ = tables(shape, x, half_size)
        for a in range(shape.support):
            np.add.at(dense[k], (np.arange(N), base[:, 0] + a + 2), weight[:, 0, a])
    np.testing.assert_allclose(dense[0, :, 1:-1], dense[1, :, 1:-1][:, ::-1], rtol=0, atol=1e-13)


@each
def test_thread_count_changes_no_bit(shape):
    position, half_size = cloud(3, n=5000)
    single = tables(shape, position, half_size)
    numba.set_num_threads(2)
    double = tables(shape, position, half_size)
    for one, two in zip(single, double, strict=True):
        np.testing.assert_array_equal(one, two)


# --- The radial axis ----------------------------------------------------------------------------------------


@each
def test_radial_weights_are_a_partition_of_unity(shape):
    _, weight, gradient, hoop = radial_tables(shape, *rings())
    assert (weight >= -1e-14).all()
    assert (hoop * DX >= -1e-12).all()
    np.testing.assert_allclose(weight.sum(axis=1), 1.0, rtol=0, atol=1e-14)
    np.testing.assert_allclose(gradient.sum(axis=1) * DX, 0.0, rtol=0, atol=1e-13)


@each
def test_radial_expansion_has_equal_radial_and_hoop_rates(shape):
    """u_r = e r gives D_rr = D_θθ = e, for boxes that touch the axis too."""
    base, _, gradient, hoop = radial_tables(shape, *rings())
    r = nodes_of(shape, base)
    np.testing.assert_allclose((gradient * r).sum(axis=1), 1.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose((hoop * r).sum(axis=1), 1.0, rtol=0, atol=1e-12)


@each
def test_radial_expansion_of_points_next_to_the_axis(shape):
    """At radii down to a billionth of a cell, as a collapsing or a badly sampled ring may have."""
    radius = np.geomspace(1e-9, 1.0, 200) * DX
    half_size = np.minimum(radius, DX / 2)
    base, _, gradient, hoop = radial_tables(shape, radius, half_size)
    r = nodes_of(shape, base)
    np.testing.assert_allclose((gradient * r).sum(axis=1), 1.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose((hoop * r).sum(axis=1), 1.0, rtol=0, atol=1e-12)


@each
def test_box_that_would_cross_the_axis_is_cut_there(shape):
    radius = np.array([0.1, 0.2, 0.3]) * DX
    half_size = np.array([0.4, 0.5, 0.31]) * DX
    base, weight, gradient, hoop = radial_tables(shape, radius, half_size)
    r = nodes_of(shape, base)
    assert base.min() >= -1
    np.testing.assert_allclose((gradient * r).sum(axis=1), 1.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose((hoop * r).sum(axis=1), 1.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(weight.sum(axis=1), 1.0, rtol=0, atol=1e-14)


@each
def test_radial_tables_tend_to_the_plain_ones_far_from_the_axis(shape):
    rng = np.random.default_rng(5)
    far = 4096 * DX  # a power of two: the position in the cell keeps its digits
    radius = far + rng.uniform(1.0, 5.0, 50) * DX
    half_size = rng.uniform(0.1, 0.5, 50) * DX
    base, weight, gradient, hoop = radial_tables(shape, radius, half_size)
    plain_base, plain_weight, plain_gradient = tables(shape, radius[:, None], half_size[:, None])
    np.testing.assert_array_equal(base, plain_base[:, 0])
    order = DX / far  # the next term of the expansion
    np.testing.assert_allclose(weight, plain_weight[:, 0], rtol=0, atol=order)
    np.testing.assert_allclose(gradient * DX, plain_gradient[:, 0] * DX, rtol=0, atol=order)
    np.testing.assert_allclose(hoop * far, plain_weight[:, 0], rtol=0, atol=10 * order)


# --- Averages over the box, by quadrature -------------------------------------------------------------------


def averages(shape):
    """Whether the weights are averages over the particle's box."""
    position = np.full((2, 1), 2.25 * DX)
    _, weight, _ = tables(shape, position, np.array([[0.1], [0.5]]) * DX)
    return shape.support > 2 and not np.allclose(weight[0], weight[1])


averaging = pytest.mark.parametrize(
    "shape", [s for s in SHAPES.values() if averages(s)], ids=[n for n, s in SHAPES.items() if averages(s)]
)
ABSCISSAE, QUADRATURE = leggauss(4)  # exact to degree 7: hats times r are cubic at most


def box_integral(f, low, high):
    """∫ f over each box, split at the nodes, where the hats have their kinks."""
    total = 0.0
    cuts = [low, *[k * DX for k in range(-1, CELLS + 3) if low < k * DX < high], high]
    for a, b in pairwise(cuts):
        points = 0.5 * (a + b) + 0.5 * (b - a) * ABSCISSAE
        total += 0.5 * (b - a) * float(np.sum(QUADRATURE * f(points)))
    return total


def hat(k):
    return lambda x: np.maximum(0.0, 1.0 - np.abs(x / DX - k))


def hat_slope(k):
    return lambda x: np.where(np.abs(x / DX - k) < 1, -np.sign(x / DX - k) / DX, 0.0)


@averaging
def test_averages_are_eqs_2_and_3(shape):
    """S = 1/(2 l) ∫ N dx and G = 1/(2 l) ∫ dN/dx dx over the box, by quadrature."""
    position, half_size = cloud(1, n=200)
    base, weight, gradient = tables(shape, position, half_size)
    for p in range(len(position)):
        x, l = position[p, 0], half_size[p, 0]
        for a in range(shape.support):
            k = int(base[p, 0]) + a
            S = box_integral(hat(k), x - l, x + l) / (2 * l)
            G = box_integral(hat_slope(k), x - l, x + l) / (2 * l)
            assert weight[p, 0, a] == pytest.approx(S, abs=1e-13)
            assert gradient[p, 0, a] * DX == pytest.approx(G * DX, abs=1e-12)


@averaging
def test_radial_averages_are_weighted_with_r(shape):
    """∫ N r dr / ∫ r dr, ∫ N' r dr / ∫ r dr and the hoop's ∫ N dr / ∫ r dr (Nairn & Guilkey 2015)."""
    radius, half_size = rings(n=200)
    radius = np.append(radius, [0.1 * DX, 0.3 * DX])  # the last two would cross the axis
    half_size = np.append(half_size, [0.3 * DX, 0.5 * DX])
    base, weight, gradient, hoop = radial_tables(shape, radius, half_size)
    for p in range(len(radius)):
        low, high = max(radius[p] - half_size[p], 0.0), radius[p] + half_size[p]
        area = (high**2 - low**2) / 2
        for a in range(shape.support):
            k = int(base[p]) + a
            N, slope = hat(k), hat_slope(k)
            S = box_integral(lambda r, N=N: N(r) * r, low, high) / area
            G = box_integral(lambda r, slope=slope: slope(r) * r, low, high) / area
            H = box_integral(N, low, high) / area
            assert weight[p, a] == pytest.approx(S, abs=1e-12)
            assert gradient[p, a] * DX == pytest.approx(G * DX, abs=1e-12)
            assert hoop[p, a] * DX == pytest.approx(H * DX, rel=1e-11, abs=1e-12)


@averaging
@pytest.mark.parametrize("side", [-1, 1])
def test_a_node_that_is_barely_touched_has_weight_and_gradient_small_alike(shape, side):
    """A box of w cells that reaches over a node by e gives it e²/2w and e/w, from the last digit of e on.

    A weight that rounding makes zero, beside a gradient that is not, is force on a node without mass.
    """
    dx, w, node = 0.01, 0.5, 1 if side < 0 else 2
    x = (node - side * w / 2) * dx + side * np.arange(1, 400) * np.spacing(dx)
    half_size = np.full_like(x, w / 2 * dx)
    base, weight, gradient = tables(shape, x[:, None], half_size[:, None], dx)
    over, touched = base[:, 0] == node - 1, 0 if side < 0 else 2
    weight, slope = weight[over, 0, touched], gradient[over, 0, touched] * dx
    assert over.sum() > 390
    np.testing.assert_allclose(weight, w / 2 * slope**2, rtol=1e-6)
    _, weight, gradient, hoop = radial_tables(shape, x, half_size, dx)
    weight, slope, hoop = weight[over, touched], gradient[over, touched] * dx, hoop[over, touched] * dx
    mean_radius = node - side * w / 2  # in cells; with r in the integrals, both numbers are node over it
    np.testing.assert_allclose(weight, w / 2 * slope**2 * mean_radius / node, rtol=1e-6)
    np.testing.assert_allclose(hoop * node, weight, rtol=1e-6)


@averaging
def test_a_cell_full_of_contiguous_boxes_is_seen_as_continuous_matter(shape):
    """Contiguous boxes of one density have, at every node inside, the mass of the node's cell."""
    per_cell = 3
    x = (np.arange(per_cell * CELLS)[:, None] + 0.5) * DX / per_cell
    base, weight, _ = tables(shape, x, np.full_like(x, DX / per_cell / 2))
    mass = np.zeros(CELLS + 3)
    for a in range(shape.support):
        np.add.at(mass, base[:, 0] + a + 1, weight[:, 0, a] / per_cell)
    np.testing.assert_allclose(mass[2 : CELLS + 1], 1.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(mass[[1, CELLS + 1]], 0.5, rtol=0, atol=1e-12)
