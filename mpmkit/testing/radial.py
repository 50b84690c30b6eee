"""What the radial tables of a shape function must be, for axisymmetric scenes."""

from __future__ import annotations

import numpy as np

from ..contracts import ShapeFunction
from .tables import CELLS, DX, EMPTY, N, nodes_of, tables
from .violation import require_all, require_close

RadialTables = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def radial_tables(shape: ShapeFunction, radius: np.ndarray, half_size: np.ndarray) -> RadialTables:
    """base ``(n,)``, weight, gradient and hoop ``(n, support)``.

    As the solver does it: all arrays but the hoop weights are strided, and nothing has filled them.
    """
    n, support = len(radius), shape.support
    r, l = (np.column_stack([values, values])[:, 0] for values in (radius, half_size))
    base = np.full((n, 2), EMPTY, dtype=np.int32)[:, 0]
    weight, gradient = np.full((2, n, 2, support), np.nan)[:, :, 0]
    hoop = np.full((n, support), np.nan)
    shape.fill_radial(r, l, DX, base, weight, gradient, hoop)
    return base, weight, gradient, hoop


def rings(seed: int = 2, n: int = N) -> tuple[np.ndarray, np.ndarray]:
    """Radii and half-sizes of rings, a quarter of which touch the axis."""
    rng = np.random.default_rng(seed)
    half_size = rng.uniform(0.05, 0.5, n) * DX
    radius = half_size + rng.uniform(0.0, CELLS * DX, n)
    radius[: n // 4] = half_size[: n // 4]
    return radius, half_size


def _places() -> tuple[np.ndarray, np.ndarray]:
    """Rings; rings down to a billionth of a cell, as a collapse may make them; and boxes across the axis."""
    radius, half_size = rings()
    near = np.geomspace(1e-9, 1.0, 200) * DX
    across, wide = np.array([0.1, 0.2, 0.3]) * DX, np.array([0.4, 0.5, 0.31]) * DX
    return (
        np.concatenate([radius, near, across]),
        np.concatenate([half_size, np.minimum(near, DX / 2), wide]),
    )


def radial_partition_of_unity(shape: ShapeFunction) -> None:
    """Weights sum to 1, gradients to 0, and neither weights nor hoop weights are below zero."""
    r, l = _places()
    _, weight, gradient, hoop = radial_tables(shape, r, l)
    for name, values, least in (("weight", weight, -1e-14), ("hoop weight", hoop * l[:, None], -1e-12)):
        require_all(
            values >= least,
            lambda p, a, n=name, v=values: (
                f"the radial {n} of node base + {a} at r = {r[p] / DX:.3g} cells is {v[p, a]:.3g}"
            ),
            -values,
        )
    require_close(
        weight.sum(axis=1), 1.0, 1e-14, lambda p: f"the sum of weights at r = {r[p] / DX:.3g} cells"
    )
    require_close(
        gradient.sum(axis=1) * DX,
        0.0,
        1e-13,
        lambda p: f"the sum of gradients at r = {r[p] / DX:.3g} cells, times the cell size,",
    )


def radial_expansion(shape: ShapeFunction) -> None:
    """u_r = e r gives D_rr = D_θθ = e, for boxes that touch the axis, or would cross it, too."""
    r, l = _places()
    base, _, gradient, hoop = radial_tables(shape, r, l)
    nodes = nodes_of(shape, base)
    rounding = 1e-15 * DX / r  # what is left of r where weights of the two sides of the axis cancel
    for name, values in (("D_rr", gradient), ("D_θθ", hoop)):
        require_close(
            (values * nodes).sum(axis=1),
            1.0,
            1e-12 + rounding,
            lambda p, n=name: f"{n} of the expansion u_r = r at r = {r[p] / DX:.3g} cells",
            "1/s",
        )


def far_from_the_axis(shape: ShapeFunction) -> None:
    """The radial tables tend to the plain ones, and the hoop weights to N / r."""
    rng = np.random.default_rng(5)
    far = 4096 * DX  # a power of two: the position in the cell keeps its digits
    r, l = far + rng.uniform(1.0, 5.0, 50) * DX, rng.uniform(0.1, 0.5, 50) * DX
    base, weight, gradient, hoop = radial_tables(shape, r, l)
    plain_base, plain_weight, plain_gradient = tables(shape, r[:, None], l[:, None])
    order = DX / far  # the next term of the expansion
    for name, found, plain, tolerance in (
        ("base", base[:, None], plain_base, 0.0),
        ("weight", weight, plain_weight[:, 0], order),
        ("gradient, times the cell size,", gradient * DX, plain_gradient[:, 0] * DX, order),
        ("hoop weight, times r,", hoop * r[:, None], plain_weight[:, 0], 10 * order),
    ):
        require_close(found, plain, tolerance, lambda p, a, n=name: f"far from the axis, the radial {n}")
