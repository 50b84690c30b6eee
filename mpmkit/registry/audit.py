"""What plug-ins give back, and what they write where they must not.

Shapes are checked in every call; that numbers are finite in every step of a small scene, and every ``LOOKS``
steps of a large one, where a pass over all arrays costs per cents.

Compiled code writes wherever its indices lead, and nothing says so. Every ``INTERVAL`` steps, the first one
included, a law and a shape function are therefore rehearsed: called on copies of a sample of the particles,
each between bands that nobody may write to. What a rehearsal gives is thrown away.

It cannot see what only happens to other particles or in other steps, nor writes beyond the bands.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..contracts import ConstitutiveLaw, Kinematics, Plugin, ShapeFunction
from ..contracts.law import LEAST_RATIO, MOST_RATIO
from ..errors import PluginFault
from ..kernels.compile import CHUNK
from ..kernels.locate import first_not_finite

FEW, LOOKS = 20_000, 20
"""Particles up to which all numbers are looked at in every step, and steps between two looks at more."""
INTERVAL = 200
"""Steps between two rehearsals: they then cost less than a hundredth of a run, however few its particles."""
SAMPLE = 500
"""Particles of a rehearsal, at most."""
BAND = 16
"""Rows of a band; an index that runs off its end is caught, one that is wild is not."""
READ, WRITTEN = 0xFF, 0x3F
"""Byte that fills the bands: of what is read it makes no number, so that reading there shows; of what is
written 5e-4, since adding to what is no number does not."""
CLOSE = 1e-6
"""How far weights may be from summing to one: far above rounding, far below what would matter."""


class Fenced:
    """A copy of rows of an array between two bands."""

    def __init__(self, rows: np.ndarray, filling: int) -> None:
        self._store = np.empty((len(rows) + 2 * BAND, *rows.shape[1:]), rows.dtype)
        self._store.view(np.uint8)[...] = filling
        self._bands = np.concatenate([self._store[:BAND], self._store[-BAND:]]).tobytes()
        self.rows = self._store[BAND:-BAND]
        self.rows[...] = rows
        self._given = self.rows.tobytes()

    @property
    def intact(self) -> bool:
        """Whether the bands are as they were."""
        return np.concatenate([self._store[:BAND], self._store[-BAND:]]).tobytes() == self._bands

    @property
    def changed(self) -> bool:
        """Whether the rows are no longer what was given."""
        return self.rows.tobytes() != self._given


def rehearse_law(
    law: ConstitutiveLaw,
    kinematics: Kinematics,
    state: Mapping[str, np.ndarray],
    stress: np.ndarray,
    dt: float,
    numbers: np.ndarray,
) -> None:
    """Call a law on copies of a sample of its particles, called ``numbers``.

    Raises:
        PluginFault: it wrote where it must not, or not as it must.
    """
    which = _sample(len(numbers))
    given = {name: Fenced(a[which], READ) for name, a in vars(kinematics).items() if isinstance(a, np.ndarray)}
    kept = {name: Fenced(array[which], WRITTEN) for name, array in state.items()}
    written = Fenced(stress[which], WRITTEN)
    rows = {name: array.rows for name, array in kept.items()}
    fenced: dict[str, Any] = {name: array.rows for name, array in given.items()}
    rehearsed = replace(kinematics, **fenced)
    returned = law.update_stress(rehearsed, rows, dt, written.rows)
    if returned is not None:
        raise PluginFault(
            law, f"returned {_described(returned)}; it must write into 'stress', and return nothing"
        )
    for name, array in kept.items():
        if rows.get(name) is not array.rows:
            raise PluginFault(
                law, f"replaced the array of its state '{name}'; it must write into the one there"
            )
    _require_intact(law, {"stress": written, **{f"state '{name}'": array for name, array in kept.items()}})
    _require_unchanged(law, given)
    require_stress(law, rehearsed, dt, written.rows, numbers[which])


def rehearse_shape(
    shape: ShapeFunction, position: np.ndarray, half_size: np.ndarray, cell_size: float, radial: bool
) -> None:
    """Evaluate a shape function on copies of a sample of the particles.

    Raises:
        PluginFault: it wrote where it must not, or its tables cannot be used.
    """
    which = _sample(len(position))
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
    _require_intact(shape, {"base": base, "weight": weight, "gradient": gradient, "hoop": hoop})
    _require_unchanged(shape, given)
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


def require_shape(plugin: Plugin, what: str, returned: Any, shape: tuple[int, ...]) -> None:
    """Raise PluginFault unless what a method of a plug-in returned is an array of a shape."""
    if not isinstance(returned, np.ndarray) or returned.shape != shape:
        raise PluginFault(
            plugin, f"returned {_described(returned)} from {what}; it must be an array of shape {shape}"
        )


def require_stress(
    law: ConstitutiveLaw, kinematics: Kinematics, dt: float, stress: np.ndarray, numbers: np.ndarray
) -> None:
    """Raise PluginFault if a law gave a stress that is not finite, and the run does not diverge as it is.

    It does where a step strains a particle by as much as its size, or its volume is beyond sense.
    """
    if _first_not_finite(stress) < 0:
        return
    ratio = kinematics.volume_ratio
    sound = ratio.min() >= LEAST_RATIO and ratio.max() <= MOST_RATIO
    if sound and np.abs(kinematics.velocity_gradient).max() * dt < 1:
        require_finite(law, "a stress", stress, numbers, (kinematics.pressure,))


def require_finite(
    plugin: Plugin, what: str, written: np.ndarray, numbers: np.ndarray, given: Iterable[np.ndarray]
) -> None:
    """Raise PluginFault if a plug-in wrote what is no finite number, though all that it was given is one.

    Args:
        plugin: who wrote it.
        what: what it is, in words.
        written: ``(n, …)``.
        numbers: ``(n,)``, what the particles are called.
        given: arrays with an entry a particle.
    """
    bad = _first_not_finite(written)
    if bad < 0:
        return
    if all(_first_not_finite(array) < 0 for array in given):
        raise PluginFault(
            plugin,
            f"gave particle {numbers[bad]} {what} that is not finite, though all that it was given is",
            particle=int(numbers[bad]),
        )


def _first_not_finite(array: np.ndarray) -> int:
    """First row with an entry that is not finite; -1 if there is none."""
    if len(array) < FEW and math.isfinite(
        np.add.reduce(array, axis=None)
    ):  # for few, less than the call of a kernel
        return -1
    firsts = np.empty(len(array) // CHUNK + 1, dtype=np.int64)
    return int(first_not_finite(array.reshape(len(array), -1), firsts))


def _sample(n: int) -> np.ndarray:
    return np.linspace(0, n - 1, min(n, SAMPLE)).astype(np.int64)


def _require_intact(plugin: Plugin, arrays: dict[str, Fenced]) -> None:
    for name, array in arrays.items():
        if not array.intact:
            raise PluginFault(plugin, f"wrote beyond the ends of the array '{name}'")


def _require_unchanged(plugin: Plugin, given: dict[str, Fenced]) -> None:
    for name, array in given.items():
        if not array.intact:
            raise PluginFault(plugin, f"wrote beyond the ends of the array '{name}'")
        if array.changed:
            raise PluginFault(plugin, f"changed '{name}', which it may only read")


def _described(value: Any) -> str:
    return (
        f"an array of shape {value.shape}" if isinstance(value, np.ndarray) else f"a {type(value).__name__}"
    )
