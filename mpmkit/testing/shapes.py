"""What every shape function must be: a partition of unity, linear at least, that knows its own gradient."""

from __future__ import annotations

import numpy as np

from ..contracts import ShapeFunction
from .violation import require, require_all, require_close, require_same

DX = 0.05
CELLS = 7
N = 400
DOMAINS = ("strain", "fixed", "stretch", "volume")

Tables = tuple[np.ndarray, np.ndarray, np.ndarray]


def cloud(dim: int, n: int = N, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Positions and half-sizes, among them boxes as wide as a cell and positions on nodes and mid-cells."""
    rng = np.random.default_rng(seed)
    position = rng.uniform(0.0, CELLS * DX, (n, dim))
    half_size = rng.uniform(0.05, 0.5, (n, dim)) * DX
    half_size[: n // 4] = DX / 2
    half_size[n // 4 : n // 2] = DX / 4
    position[: n // 8] = DX * rng.integers(0, CELLS + 1, (n // 8, dim))
    position[n // 8 : n // 4] = DX * (rng.integers(0, CELLS, (n // 4 - n // 8, dim)) + 0.5)
    return position, half_size


def tables(shape: ShapeFunction, position: np.ndarray, half_size: np.ndarray) -> Tables:
    """base ``(n, dim)``, weight and gradient ``(n, dim, support)`` on cells of ``DX``; NaN if not filled."""
    n, dim = position.shape
    base = np.full((n, dim), -99, dtype=np.int32)
    weight = np.full((n, dim, shape.support), np.nan)
    gradient = np.full((n, dim, shape.support), np.nan)
    shape.fill(position, half_size, DX, base, weight, gradient)
    return base, weight, gradient


def nodes_of(shape: ShapeFunction, base: np.ndarray) -> np.ndarray:
    """Positions of the nodes touched, m, ``(..., support)``."""
    return (base[..., None] + np.arange(shape.support)) * DX


def on_all_nodes(shape: ShapeFunction, base: np.ndarray, values: np.ndarray) -> np.ndarray:
    """``(n, CELLS + 5)`` values of one axis on the nodes from -2 on, whatever their ``base``."""
    n = len(base)
    dense = np.zeros((n, CELLS + 5))
    for a in range(shape.support):
        node = base + a + 2
        inside = (node >= 0) & (node < dense.shape[1])
        np.add.at(dense, (np.flatnonzero(inside), node[inside]), values[inside, a])
    return dense


def near_kink(position: np.ndarray, half_size: np.ndarray, within: float) -> np.ndarray:
    """Whether the middle or an edge of the box is so near, in cells, to a node or the middle of a cell."""
    edges = 2 * np.stack([position - half_size, position, position + half_size]) / DX
    return np.any(np.abs(edges - np.rint(edges)) < 2 * within, axis=0)


def _at(position: np.ndarray) -> str:
    return f"at x = {position / DX:.9g} cells"


def partition_of_unity(shape: ShapeFunction) -> None:
    """Weights are none below zero and sum to 1, gradients to 0, in one dimension and in three."""
    for dim in (1, 3):
        x, l = cloud(dim)
        _, weight, gradient = tables(shape, x, l)
        require_all(
            weight >= -1e-15,
            lambda p, d, a, x=x, w=weight: (
                f"the weight of node base + {a} is {w[p, d, a]:.3g} {_at(x[p, d])}"
            ),
            -weight,
        )
        require_close(
            weight.sum(axis=2), 1.0, 4e-15, lambda p, d, x=x: f"the sum of the weights {_at(x[p, d])}"
        )
        require_close(
            gradient.sum(axis=2) * DX,
            0.0,
            1e-14,
            lambda p, d, x=x: f"the sum of the gradients {_at(x[p, d])}, times the cell size,",
        )


def linear_reproduction(shape: ShapeFunction) -> None:
    """Σ N x_node = x and Σ N' x_node = 1."""
    for dim in (1, 3):
        x, l = cloud(dim)
        base, weight, gradient = tables(shape, x, l)
        nodes = nodes_of(shape, base)
        require_close(
            (weight * nodes).sum(axis=2),
            x,
            1e-14 * CELLS,
            lambda p, d, x=x: f"the field u = x, interpolated {_at(x[p, d])},",
            "m",
        )
        require_close(
            (gradient * nodes).sum(axis=2),
            1.0,
            1e-13,
            lambda p, d, x=x: f"the gradient of the field u = x {_at(x[p, d])}",
        )


def gradients(shape: ShapeFunction) -> None:
    """The gradients are the derivatives of the weights, by central differences away from any kink."""
    x, l = cloud(2, seed=3)
    step = 1e-6 * DX
    base, _, gradient = tables(shape, x, l)
    low, high = tables(shape, x - step, l), tables(shape, x + step, l)
    clear = ~near_kink(x, l, 1e-4)
    require_all(
        (low[0] == base) & (high[0] == base) | ~clear,
        lambda p, d: f"the base jumps {_at(x[p, d])}, away from any node or middle of a cell",
    )
    slope = (high[1] - low[1]) / (2 * step)
    require_close(
        gradient * DX,
        slope * DX,
        np.where(clear, 1e-8, np.inf)[..., None],
        lambda p, d, a: f"the gradient of node base + {a} {_at(x[p, d])}, times the cell size,",
    )


def nodes_within_reach(shape: ShapeFunction) -> None:
    """A particle touches nodes from the one below its cell to the second above its lower node, no others."""
    require(
        shape.particle_domain in DOMAINS, f"its particle_domain is '{shape.particle_domain}', not {DOMAINS}"
    )
    x, l = cloud(2)
    base, *_ = tables(shape, x, l)
    cell = np.floor(x / DX)
    last = base + shape.support - 1
    require_all(
        (base >= cell - 1) & (last <= cell + 2),
        lambda p, d: (
            f"nodes {base[p, d]} to {last[p, d]} are touched from cell {cell[p, d]:.0f}; they must be within "
            f"{cell[p, d] - 1:.0f} to {cell[p, d] + 2:.0f}"
        ),
    )


def continuity(shape: ShapeFunction) -> None:
    """No weight jumps as a particle, or an edge of its box, moves over a node or the middle of a cell.

    Nor does a gradient, if the shape function says that it is smooth.
    """
    l = np.full((5, 1), 0.2 * DX)
    kinks = DX * np.array([[4.0], [4.2], [3.8], [3.5], [4.3]])
    (below, w, g), (above, w2, g2) = (tables(shape, kinks + shift * DX, l) for shift in (-1e-10, 1e-10))
    for name, one, other in (("weight", w, w2), ("gradient", g * DX, g2 * DX))[: 1 + shape.smooth]:
        require_close(
            on_all_nodes(shape, above[:, 0], other[:, 0]),
            on_all_nodes(shape, below[:, 0], one[:, 0]),
            1e-8,
            lambda p, node, name=name: (
                f"the {name} of node {node - 2} just beyond a place {_at(kinks[p, 0])}"
            ),
        )


def place_in_the_lattice(shape: ShapeFunction) -> None:
    """A particle moved by whole cells has its nodes moved likewise, and the same weights."""
    x, l = cloud(2)
    x += 2.25 * DX
    base, weight, gradient = tables(shape, x, l)
    clear = ~near_kink(x, l, 1e-9)  # else rounding may choose the other cell
    for cells in (2, -1, 1000):
        moved, *found = tables(shape, x + cells * DX, l)
        require_all(
            (moved == base + cells) | ~clear,
            lambda p, d, m=moved, c=cells: (
                f"{c} cells further on, the base is {m[p, d]}, not {base[p, d] + c}"
            ),
        )
        for name, one, other in (("weight", weight, found[0]), ("gradient", gradient * DX, found[1] * DX)):
            require_close(
                other,
                one,
                np.where(clear, 2e-11, np.inf)[..., None],
                lambda p, d, a, n=name, c=cells: f"the {n} of node base + {a}, {c} cells further on,",
            )


def mirror(shape: ShapeFunction) -> None:
    """A mirrored particle has mirrored weights."""
    x, l = cloud(1)
    base, weight, _ = tables(shape, x, l)
    mirrored, weight2, _ = tables(shape, CELLS * DX - x, l)
    require_close(
        on_all_nodes(shape, mirrored[:, 0], weight2[:, 0])[:, ::-1],
        on_all_nodes(shape, base[:, 0], weight[:, 0]),
        1e-13,
        lambda p, node: (
            f"the weight of node {node - 2}'s mirror image, of a particle mirrored {_at(x[p, 0])},"
        ),
    )


def batch_order(shape: ShapeFunction) -> None:
    """Particles do not know each other, and positions and sizes are read alone."""
    x, l = cloud(3)
    order = np.random.default_rng(2).permutation(N)
    whole, given = tables(shape, x, l), (x.copy(), l.copy())
    for found, kept, name in zip((x, l), given, ("position", "half_size"), strict=True):
        require_same(found, kept, lambda p, d, n=name: f"{n}, which it must not change,")
    for index, how in ((order, "in another order"), (np.array([N - 1]), "alone")):
        for one, other in zip(tables(shape, x[index], l[index]), whole, strict=True):
            require_same(
                one, other[index], lambda *at, h=how: f"a table of a particle that is handed over {h}"
            )
