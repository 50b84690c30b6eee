"""What methods of plug-ins return: numbers, arrays and sentences."""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Real
from typing import Any

import numpy as np

from ...contracts import Plugin
from ...contracts.law import LEAST_RATIO, MOST_RATIO
from ...errors import PluginFault
from ...kernels.compile import CHUNK
from ...kernels.locate import first_not_finite

DOUBLE = np.dtype(np.float64)
FEW = 20_000
"""Particles up to which all numbers are looked at in every step."""
NOTHING = 1e-6
"""Energy that counts as none, over that of the fastest wave, ρ c²: far above rounding."""


def require_number(plugin: Plugin, what: str, value: Any) -> float:
    """The number that a plug-in gave for ``what``, which may be no number, ``nan``, all the same.

    Raises:
        PluginFault: it is not a real number of Python or numpy, nor an array of one.
    """
    if isinstance(value, float):
        return value
    single = isinstance(value, np.ndarray) and value.size == 1 and value.dtype.kind in "fiu"
    if not isinstance(value, Real) and not single:
        raise PluginFault(plugin, f"gave {described(value)} as {what}; it must be a number")
    return float(value.item() if single else value)


def require_truth(plugin: Plugin, what: str, value: Any) -> bool:
    """The yes or no that a plug-in returned from ``what``.

    Raises:
        PluginFault: it is neither ``True`` nor ``False``.
    """
    if isinstance(value, bool | np.bool_):
        return bool(value)
    raise PluginFault(plugin, f"returned {described(value)} from {what}; it must be True or False")


def require_sentences(plugin: Plugin, what: str, value: Any) -> list[str]:
    """The sentences that a plug-in returned from ``what``.

    Raises:
        PluginFault: it is no list of strings.
    """
    if isinstance(value, list | tuple) and all(isinstance(sentence, str) for sentence in value):
        return list(value)
    raise PluginFault(plugin, f"returned {described(value)} from {what}; it must be a list of sentences")


def require_array(plugin: Plugin | None, what: str, returned: Any, shape: tuple[int, ...]) -> None:
    """Raise PluginFault unless what a method of a plug-in returned is an array of real numbers of a shape."""
    if type(returned) is np.ndarray and returned.shape == shape and returned.dtype is DOUBLE:
        return  # as nearly always, in every step
    if type(returned) not in (np.ndarray, np.memmap) or returned.shape != shape:
        raise PluginFault(
            plugin, f"returned {described(returned)} from {what}; it must be an array of shape {shape}"
        )
    if returned.dtype not in (np.float64, np.float32):
        raise PluginFault(
            plugin, f"returned an array of {returned.dtype} from {what}; it must be one of float64"
        )


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
    bad = first_bad(written)
    if bad < 0:
        return
    if all(first_bad(array) < 0 for array in given):
        raise PluginFault(
            plugin,
            f"gave particle {numbers[bad]} {what} that is not finite, though all that it was given is",
            particle=int(numbers[bad]),
        )


def require_energy(
    plugin: Plugin,
    density: np.ndarray,
    numbers: np.ndarray,
    volume_ratio: np.ndarray,
    stress: np.ndarray,
    modulus: float,
) -> None:
    """Raise PluginFault if stored energies, ``(n,)``, J/m³, are not finite, or negative beyond rounding.

    Such an energy would be missed in, or hide, what the guard of the energy counts.

    Args:
        volume_ratio, stress: what it was computed from; where they are beyond sense, the run has diverged.
        modulus: ρ c² of the fastest wave, Pa.
    """
    worst = int(np.argmin(density))  # which is that of the first nan, where there is one
    if density[worst] >= -NOTHING * modulus and np.isfinite(density.max()):
        return
    sound = volume_ratio.min() >= LEAST_RATIO and volume_ratio.max() <= MOST_RATIO
    if not sound or first_bad(stress) >= 0 or not math.isfinite(modulus):
        return
    require_finite(plugin, "an energy", density, numbers, ())
    if density[worst] < 0:
        raise PluginFault(
            plugin,
            f"gave particle {numbers[worst]} an energy of {density[worst]:.4g} J/m³; what is stored cannot "
            "be negative",
            particle=int(numbers[worst]),
        )


def first_bad(array: np.ndarray) -> int:
    """First row with an entry that is not finite; -1 if there is none."""
    if len(array) < FEW and math.isfinite(
        np.add.reduce(array, axis=None)
    ):  # for few, less than the call of a kernel
        return -1
    firsts = np.empty(len(array) // CHUNK + 1, dtype=np.int64)
    return int(first_not_finite(array.reshape(len(array), -1), firsts))


def described(value: Any) -> str:
    """A value as sentences have it."""
    if value is None:
        return "nothing"
    if type(value) in (np.ndarray, np.memmap):
        return f"an array of shape {value.shape}"
    if isinstance(value, str):
        return f"the text {value[:40]!r}"
    return f"a {type(value).__name__}"
