"""A run as a notebook shows it: its figures in a table, and the pictures of its report."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator
from html import escape
from io import BytesIO
from pathlib import Path
from typing import Any

from ..output import RunDirectory
from ..output.run_directory import PICTURES
from ..output.summary import state_at_end

SHOWN = PICTURES[:2]
"""Pictures that are shown: the final shape, and the shapes before it."""
DPI = 90
LEFT, WIDE = 'style="text-align: left"', 'style="max-width: 48em; width: 100%"'
FIGURES = {
    "t500": ("T500", 1.0, "s"),
    "final_spread": ("final spread", 1e3, "mm"),
    "final_slump": ("final slump", 1e3, "mm"),
    "final_height": ("final height", 1e3, "mm"),
    "particles": ("particles", 1.0, ""),
    "steps": ("steps", 1.0, ""),
    "wall_time": ("wall time", 1.0, "s"),
}
"""Label, scale and unit of each result, by its key in the summary."""


def run_html(directory: Path, name: str, summary: dict[str, Any]) -> str:
    """The run as HTML, with its pictures in it."""
    rows = "".join(
        f"<tr><th {LEFT}>{escape(label)}</th><td>{escape(value)}</td></tr>" for label, value in _rows(summary)
    )
    head = f"<p><b>{escape(name)}</b> in <code>{escape(str(directory))}</code></p>"
    return f"<div>{head}<table>{rows}</table>{''.join(_pictures(directory))}</div>"


def _rows(summary: dict[str, Any]) -> Iterator[tuple[str, str]]:
    for key, (label, scale, unit) in FIGURES.items():
        value = summary.get(key)
        if value is not None:
            number = f"{value:,}" if isinstance(value, int) else f"{scale * value:.4g}"
            yield label, f"{number} {unit}".strip()
    ended = str(summary.get("stopped_because"))
    yield "ended", ", ".join(filter(None, [ended, state_at_end(summary)]))


def _pictures(directory: Path) -> Iterator[str]:
    """Pictures of the report; if the run has none, its shape is drawn now."""
    there = [path for name in SHOWN if (path := RunDirectory(directory).report / f"{name}.png").is_file()]
    for content in [path.read_bytes() for path in there] or _drawn(directory):
        yield f'<img alt="" {WIDE} src="data:image/png;base64,{b64encode(content).decode()}">'


def _drawn(directory: Path) -> list[bytes]:
    from ..report import outline
    from ..report.run_results import read_results
    from ..report.style import figure_style

    with figure_style():
        figure = outline.draw(read_results(directory))
        if figure is None:
            return []
        content = BytesIO()
        figure.savefig(content, format="png", dpi=DPI)
    return [content.getvalue()]
