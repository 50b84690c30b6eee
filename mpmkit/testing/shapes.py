"""What every shape function must be: a partition of unity, linear at least, that knows its own gradient."""

from __future__ import annotations

import numpy as np

from ..contracts import ShapeFunction
from .radial import radial_tables, rings
from .tables import CELLS, DX, EMPTY, N, cloud, near_kink, nodes_of, on_all_nodes, tables
from .violation import require, require_all, require_close, require_same

DOMAINS = ("strain", "fixed", "stretch", "volume")


def _at(position: np.ndarray) -> str:
    return f"at x = {position / DX:.9g} cells"


def writes_in_place(shape: ShapeFunction) -> None:
    """The tables are written into the arrays that are given. Without that, nothing else of it can be seen."""
    x, l = cloud(2)
    base, weight, gradient = tables(shape, x, l)
    radial = dict(zip(("base", "weight", "gradient", "hoop"), radial_tables(shape, *rings()), strict=True))
    for method, found in (
        ("fill", {"base": base, "weight": weight, "gradient": gradient}),
        ("fill_radial", radial),
    ):
        for name, table in found.items():
            require(
                not (np.isnan(table).all() or (table == EMPTY).all()),
                f"its {method} left the array '{name}' as it was; it must write into it, as {name}[:] = … "
                f"does ({name} = … only makes another array of that name)",
            )


def partition_of_unity(shape: ShapeFunction) -> None:
    """No weight is below zero; weights sum to 1, gradients to 0, in one dimension and in three."""
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


def barely_touched_nodes(shape: ShapeFunction) -> None:
    """A node that is only just touched has a gradient as small as its weight, if gradients are smooth.

    The force on a node goes with the gradient and its mass with the weight: (Δx N')² ≤ 4 N over the width of
    the box in cells, to the last digit. Rounding that leaves a gradient alone throws particles out.
    """
    places = np.array([4.0, 4.2, 3.8, 3.5, 4.3])
    away = np.concatenate([[0.0], np.geomspace(1e-17, 1e-2, 60)])
    x = DX * (places[:, None, None] + np.array([-1.0, 1.0])[:, None] * away).reshape(-1, 1)
    l = np.full_like(x, 0.2 * DX)
    _, weight, gradient = tables(shape, x, l)
    squared = (gradient * DX) ** 2
    require_all(
        squared <= 4 / 0.4 * np.maximum(weight, 0.0),
        lambda p, d, a: (
            f"{_at(x[p, d])}, node base + {a} has a gradient of {gradient[p, d, a] * DX:.3g} per cell and a "
            f"weight of {weight[p, d, a]:.3g}"
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
