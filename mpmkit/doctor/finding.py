"""The facts and the problems of one part of an installation."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

MEBI = 2**20


@dataclass
class Finding:
    """Facts by name, and a sentence for each problem."""

    facts: dict[str, Any] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)


def mebibytes(size: float) -> str:
    """A number of bytes in words."""
    return f"{size / MEBI:,.0f} MiB" if size >= MEBI else f"{size / 1024:,.0f} KiB"
