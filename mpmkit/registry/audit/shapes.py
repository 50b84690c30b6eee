"""Shape functions: what they write, to which nodes, and whether they reproduce linear fields."""

from __future__ import annotations

import numpy as np

from ...contracts import Plugin, ShapeFunction
from ...errors import PluginFault
from ...kernels.compile import CHUNK
from ...kernels.tables import first_untrue, near, near_in_parallel
from .fences import READ, WRITTEN, Fenced, require_intact, require_unchanged, sample
from .returned import FEW

CLOSE = 1e-6
"""Largest error of the sums of weights: far above rounding errors, and far below any effect on results."""
DOMAINS = ("strain", "fixed", "stretch", "volume")
"""The rules by which the domain of a particle can follow the deformation."""


def rehearse_shape(
    shape: ShapeFunction, position: np.ndarray, half_size: np.ndarray, cell_size: float, radial: bool
) -> None:
    """Evaluate a shape function on copies of a sample of the particles.

    Raises:
        PluginFault: it wrote to memory that it must not change, or its tables cannot be used.
    """
    which = sample(len(position))
    n, dim = len(which), position.shape[1]
    given = {"position": Fenced(position[which], READ), "half_size": Fenced(half_size[which], READ)}
    base = Fenced(np.full((n, dim), -(2**31), dtype=np.int32), WRITTEN)
    weight, gradient = (Fenced(np.full((n, dim, shape.support), np.nan), WRITTEN) for _ in range(2))
    hoop = Fenced(np.full((n, shape.support if radial else 0), np.nan), WRITTEN)
    x, half = given["position"].rows, given["half_size"].rows
    shape.fill(x, half, cell_size, base.rows, weight.rows, gradient.rows)
    if radial:
        tables = base.rows[:, 0], weight.rows[:, 0], gradient.rows[:, 0]
        shape.fill_radial(x[:, 0], half[:, 0], cell_size, *tables, hoop.rows)
    require_intact(shape, {"base": base, "weight": weight, "gradient": gradient, "hoop": hoop})
    require_unchanged(shape, given)
    for name, table in (("weight", weight), ("gradient", gradient), ("hoop", hoop)):
        if not np.isfinite(table.rows).all():
            raise PluginFault(shape, f"left '{name}' without a finite number for some particles")
    cells, last = x / cell_size, base.rows + shape.support - 1
    if (base.rows < np.floor(cells - CLOSE) - 1).any() or (last > np.floor(cells + CLOSE) + 2).any():
        raise PluginFault(shape, "gave a 'base' that leads to nodes more than a cell from the particle's own")
    if np.abs(weight.rows.sum(axis=-1) - 1).max() > CLOSE:
        raise PluginFault(shape, "gave weights that do not sum to one")
    if np.abs(gradient.rows.sum(axis=-1)).max() * cell_size > CLOSE:
        raise PluginFault(shape, "gave gradients that do not sum to zero")
    nodes = base.rows[:, :, None] + np.arange(shape.support)
    _require_linear(
        shape, nodes - cells[:, :, None], weight.rows, cell_size * gradient.rows, half / cell_size, radial
    )
    if radial and np.abs((hoop.rows * nodes[:, 0]).sum(axis=-1) * cell_size - 1).max() > CLOSE:
        raise PluginFault(shape, "gave a 'hoop' with which Σ hoop r, of the nodes' radii r, is not one")


def _require_linear(
    shape: ShapeFunction,
    away: np.ndarray,
    weight: np.ndarray,
    gradient: np.ndarray,
    half: np.ndarray,
    radial: bool,
) -> None:
    """Require Σ N (x_node - x) = 0 and Σ ∇N x_node = 1 along every axis; all lengths are in cells.

    In an axisymmetric scene the weights are averages weighted with the radius. Their centre is farther out
    than the particle, but within its domain.
    """
    if np.abs((gradient * away).sum(axis=-1) - 1).max() > CLOSE:
        raise PluginFault(shape, "gave gradients of which that of a linear field, Σ ∇N x, is not one")
    off = np.abs((weight * away).sum(axis=-1))
    if radial:
        off[:, 0] = np.maximum(off[:, 0] - half[:, 0], 0.0)
    if off.max() > CLOSE:
        raise PluginFault(
            shape, "gave weights whose mean position of the nodes, Σ N x, is not the particle's"
        )


def require_bounds(
    shape: ShapeFunction, position: np.ndarray, cell_size: float, base: np.ndarray, numbers: np.ndarray
) -> None:
    """Raise PluginFault if ``base`` of a shape function leads to nodes too far from a particle.

    This is checked in every step, because compiled loops do not check ``base``.
    """
    look = near if len(base) < FEW else near_in_parallel
    # Node numbers are integers. So "at least floor(x) - 1" is the same as "more than x - 2", and "at most
    # floor(x) + 2" is the same as "at most x + 2".
    least, most = -2 - CLOSE, 3 - shape.support + CLOSE
    if look(position, 1 / cell_size, base, least, most):
        return
    away = base - position / cell_size
    bad = int(np.argmax(((away < least) | (away > most)).any(axis=1)))
    cells = ", ".join(str(int(cell)) for cell in position[bad] // cell_size)
    gave = ", ".join(str(first) for first in base[bad])
    raise PluginFault(
        shape,
        f"gave particle {numbers[bad]}, in cell {cells}, the 'base' {gave}, which leads to nodes more than a "
        "cell from the particle's own",
        particle=int(numbers[bad]),
    )


def require_weights(
    shape: Plugin, weight: np.ndarray, gradient: np.ndarray, cell_size: float, numbers: np.ndarray
) -> None:
    """Raise PluginFault if weights do not sum to one, or gradients to zero, or if a sum is ``nan``."""
    firsts = np.empty(len(weight) // CHUNK + 1, dtype=np.int64)
    bad = int(first_untrue(weight, gradient, cell_size, CLOSE, firsts))
    if bad < 0:
        return
    sums = weight[bad].sum(axis=-1)
    if np.abs(sums - 1).max() <= CLOSE:
        what = "gradients that do not sum to zero"
    else:
        what = f"weights that sum to {np.prod(sums):.9g} and not to 1"
    raise PluginFault(shape, f"gave particle {numbers[bad]} {what}", particle=int(numbers[bad]))


def particle_domain(shape: ShapeFunction) -> str:
    """The rule by which particle domains follow the deformation.

    Raises:
        PluginFault: there is no such rule.
    """
    rule = shape.particle_domain
    if rule not in DOMAINS:
        raise PluginFault(shape, f"has a particle_domain of {rule!r}; it must be one of {', '.join(DOMAINS)}")
    return rule
