"""Names of parameters in sentences and figures."""

from __future__ import annotations

from collections.abc import Mapping

from ..case.model import Case
from ..study.labels import short_names, unit_of


class Names:
    """Names and units of parameters.

    Args:
        paths: of the parameters.
        case: in which they stand.
        units: of the parameters at the top of the case.
    """

    def __init__(self, paths: list[str], case: Case, units: Mapping[str, str] | None = None) -> None:
        self._short = short_names(paths)
        self._units = {path: (units or {}).get(path) or unit_of(case, path) for path in paths}

    def name(self, path: str) -> str:
        """``plastic viscosity``."""
        return self._short[path]

    def unit(self, path: str) -> str:
        """``Pa s``; empty for a number without a unit."""
        unit = self._units[path]
        return "" if unit in (None, "1") else str(unit)

    def label(self, path: str) -> str:
        """``plastic viscosity (Pa s)``."""
        return f"{self.name(path)} ({self.unit(path)})" if self.unit(path) else self.name(path)

    def said(self, path: str, *values: float) -> str:
        """``5 Pa s``, or ``between 5 and 80 Pa s``."""
        numbers = [f"{value:.3g}" for value in values]
        text = numbers[0] if len(numbers) == 1 else f"between {numbers[0]} and {numbers[1]}"
        return f"{text} {self.unit(path)}".rstrip()


def length(value: float, unit: str) -> str:
    """A number with its unit; lengths are in millimetres."""
    return f"{1e3 * value:.3g} mm" if unit == "m" else f"{value:.3g} {unit}".rstrip()
