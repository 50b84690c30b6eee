"""Checks of what methods of plug-ins return: numbers, arrays and sentences."""

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
"""Up to this number of particles, all numbers are checked in every step."""
NOTHING = 1e-6
"""Energies below this part of ρ c² of the fastest wave count as zero: far above rounding errors."""


def require_number(plugin: Plugin, what: str, value: Any) -> float:
    """The number that a plug-in returned from ``what``; it may be ``nan``.

    Raises:
        PluginFault: it is neither a real number of Python or NumPy nor an array of one number.
    """
    if isinstance(value, float):
        return value
    single = isinstance(value, np.ndarray) and value.size == 1 and value.dtype.kind in "fiu"
    if not isinstance(value, Real) and not single:
        raise PluginFault(plugin, f"gave {described(value)} as {what}; it must be a number")
    return float(value.item() if single else value)


def require_truth(plugin: Plugin, what: str, value: Any) -> bool:
    """The truth value that a plug-in returned from ``what``.

    Raises:
        PluginFault: it is neither ``True`` nor ``False``.
    """
    if isinstance(value, bool | np.bool_):
        return bool(value)
    raise PluginFault(plugin, f"returned {described(value)} from {what}; it must be True or False")


def require_sentences(plugin: Plugin, what: str, value: Any) -> list[str]:
    """The sentences that a plug-in returned from ``what``.

    Raises:
        PluginFault: it is not a list of strings.
    """
    if isinstance(value, list | tuple) and all(isinstance(sentence, str) for sentence in value):
        return list(value)
    raise PluginFault(plugin, f"returned {described(value)} from {what}; it must be a list of sentences")


def require_array(plugin: Plugin | None, what: str, returned: Any, shape: tuple[int, ...]) -> None:
    """Raise PluginFault if a plug-in did not return an array of real numbers with this shape."""
    if type(returned) is np.ndarray and returned.shape == shape and returned.dtype is DOUBLE:
        return  # nearly always; this check is made in every step
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
    """Raise PluginFault if a plug-in wrote a number that is not finite although its arguments are finite.

    Args:
        plugin: the plug-in.
        what: the quantity in words, with its article.
        written: what the plug-in wrote, ``(n, …)``.
        numbers: the numbers of the particles, ``(n,)``.
        given: its arguments, arrays with an entry for each particle.
    """
    bad = first_bad(written)
    if bad < 0:
        return
    if all(first_bad(array) < 0 for array in given):
        raise PluginFault(
            plugin,
            f"gave particle {numbers[bad]} {what} that is not finite, although all its arguments are",
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

    Such an energy would make the balance of the energy guard wrong.

    Args:
        volume_ratio, stress: arguments of the energy; if they are out of range, the run has diverged, and the
            plug-in is not at fault.
        modulus: ρ c² of the fastest wave, Pa.
    """
    worst = int(np.argmin(density))  # argmin finds the first nan, if there is one
    if density[worst] >= -NOTHING * modulus and np.isfinite(density.max()):
        return
    sound = volume_ratio.min() >= LEAST_RATIO and volume_ratio.max() <= MOST_RATIO
    if not sound or first_bad(stress) >= 0 or not math.isfinite(modulus):
        return
    require_finite(plugin, "an energy", density, numbers, ())
    if density[worst] < 0:
        raise PluginFault(
            plugin,
            f"gave particle {numbers[worst]} an energy of {density[worst]:.4g} J/m³; a stored energy "
            "cannot be negative",
            particle=int(numbers[worst]),
        )


def first_bad(array: np.ndarray) -> int:
    """First row with an entry that is not finite; -1 if there is none."""
    if len(array) < FEW and math.isfinite(
        np.add.reduce(array, axis=None)
    ):  # for few particles this is faster than calling a kernel
        return -1
    firsts = np.empty(len(array) // CHUNK + 1, dtype=np.int64)
    return int(first_not_finite(array.reshape(len(array), -1), firsts))


def described(value: Any) -> str:
    """A value in words, for a message."""
    if value is None:
        return "nothing"
    if type(value) in (np.ndarray, np.memmap):
        return f"an array of shape {value.shape}"
    if isinstance(value, str):
        return f"the text {value[:40]!r}"
    return f"a {type(value).__name__}"
