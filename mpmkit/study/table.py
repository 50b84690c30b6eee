"""The members of a study in a table."""

from __future__ import annotations

import math

import numpy as np
import xarray

COLUMNS = (
    ("t500", "T500, s", 1.0, ".3f"),
    ("final_spread", "spread, mm", 1e3, ".1f"),
    ("final_slump", "slump, mm", 1e3, ".1f"),
    ("final_height", "height, mm", 1e3, ".1f"),
    ("particles", "particles", 1.0, ",.0f"),
    ("steps", "steps", 1.0, ",.0f"),
    ("wall_seconds", "wall, s", 1.0, ".2f"),
    ("cpu_seconds", "CPU, s", 1.0, ".2f"),
    ("memory_bytes", "memory, MiB", 1 / 2**20, ".1f"),
)
"""Variable, heading, scale and format."""


BAR = r"\|"
"""A bar as text; a plain bar would end a cell."""


def table(dataset: xarray.Dataset) -> str:
    """Markdown table: a row for each member, with its labels first and how it ended last."""
    dimensions = dataset.fate.dims
    headings = [*dimensions, *(heading for _, heading, _, _ in COLUMNS), "fate"]
    lines = [f"| {' | '.join(map(str, headings))} |", f"|{'---|' * len(headings)}"]
    for place in np.ndindex(dataset.fate.shape):
        member = dataset.isel(dict(zip(dimensions, place, strict=True)))
        cells = [str(member[name].item()) for name in dimensions]
        cells += [shown_in_table(float(member[name]), scale, form) for name, _, scale, form in COLUMNS]
        cells.append(fate_of(member))
        lines.append(f"| {' | '.join(cell.replace('|', BAR) for cell in cells)} |")
    return "\n".join(lines) + "\n"


def fate_of(member: xarray.Dataset) -> str:
    """How a member ended, in a few words."""
    fate, time = str(member.fate.item()), float(member.simulated_time)
    if fate in ("finished", ""):
        return fate or "not run"
    return f"{fate} at {time:.3g} s" if math.isfinite(time) else fate


def shown_in_table(value: float, scale: float, form: str) -> str:
    """A number in the unit and the format of its column."""
    return f"{value * scale:{form}}" if math.isfinite(value) else "–"
