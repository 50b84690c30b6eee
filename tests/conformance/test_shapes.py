"""Requirements on every registered shape function: a partition of unity with the right gradients.

Every shape function passes the conformance kit for third parties and the tests below, with its default
parameters. Averages over the box of a particle are checked only for shape functions whose weights change with
the half-size.
"""

from __future__ import annotations

from itertools import pairwise

import numba
import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

from mpmkit.registry import installed
from mpmkit.testing import shape_checks
from mpmkit.testing.radial import radial_tables, rings
from mpmkit.testing.tables import CELLS, DX, cloud, tables

SHAPES = {name: plugin() for name, plugin in installed().of_kind("shape").items()}


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{n}: {check.name}")
        for n, shape in SHAPES.items()
        for check in shape_checks(shape)
    ],
)
def test_conformance(check):
    check()


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
def test_thread_count_changes_no_bit(shape):
    position, half_size = cloud(3, n=5000)
    single = tables(shape, position, half_size)
    numba.set_num_threads(2)
    double = tables(shape, position, half_size)
    for one, two in zip(single, double, strict=True):
        np.testing.assert_array_equal(one, two)


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
def test_weight_and_gradient_of_a_barely_touched_node_vanish_together(shape, side):
    """A box of width w (in cells) that overlaps a node by e gives it the weight e²/2w and the gradient e/w,
    for any e. If rounding made the weight zero and the gradient not, there would be a force on a node without
    mass."""
    w, node = 0.5, 1 if side < 0 else 2
    x = (node - side * w / 2) * DX + side * np.arange(1, 400) * np.spacing(DX)
    half_size = np.full_like(x, w / 2 * DX)
    base, weight, gradient = tables(shape, x[:, None], half_size[:, None])
    over, touched = base[:, 0] == node - 1, 0 if side < 0 else 2
    weight, slope = weight[over, 0, touched], gradient[over, 0, touched] * DX
    assert over.sum() > 390
    np.testing.assert_allclose(weight, w / 2 * slope**2, rtol=1e-6)
    _, weight, gradient, hoop = radial_tables(shape, x, half_size)
    weight, slope, hoop = weight[over, touched], gradient[over, touched] * DX, hoop[over, touched] * DX
    mean_radius = node - side * w / 2  # in cells; with r in the integrals, both numbers are node over it
    np.testing.assert_allclose(weight, w / 2 * slope**2 * mean_radius / node, rtol=1e-6)
    np.testing.assert_allclose(hoop * node, weight, rtol=1e-6)


@averaging
def test_a_cell_full_of_contiguous_boxes_is_seen_as_continuous_matter(shape):
    """Contiguous boxes of one density give every inner node the mass of one cell."""
    per_cell = 3
    x = (np.arange(per_cell * CELLS)[:, None] + 0.5) * DX / per_cell
    base, weight, _ = tables(shape, x, np.full_like(x, DX / per_cell / 2))
    mass = np.zeros(CELLS + 3)
    for a in range(shape.support):
        np.add.at(mass, base[:, 0] + a + 1, weight[:, 0, a] / per_cell)
    np.testing.assert_allclose(mass[2 : CELLS + 1], 1.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(mass[[1, CELLS + 1]], 0.5, rtol=0, atol=1e-12)
