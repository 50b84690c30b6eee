"""The page of a stability map: the figure, drawn as part of the page, and its table."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from pathlib import Path

from ..output.atomic import cannot_write, replacing
from ..report.page.assembled import assembled
from ..report.page.section import Section, note, paragraph, table
from ..version import __version__
from .figure import WRONG
from .trials import Trials, section

NAME = "index.html"
LEAST, MOST = 0.04, 2.6
"""Ends of the axis, as fractions of the limit."""
TICKS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0)
ROW, BAR = 30, 12
"""Heights of a row and of its bar."""
WIDTH = 560


def write_page(
    rows: list[dict], kinds: list[str], title: str, directory: Path, trials: Sequence[Trials] = ()
) -> Path:
    """Write the page of a map into a directory, which is made.

    Args:
        rows: a combination each, as ``mpmkit stability`` finds them.
        kinds: of plug-ins that are varied.
        title: of the case.
        directory: of the map.
        trials: those at the limit of each combination, in the order of the rows; none are shown by default.

    Raises:
        OutputError: where it cannot be written.
    """
    path = directory / NAME
    names = [name_of(row, kinds, title) for row in rows]
    sections = [_map(rows, kinds, title), _table(rows, kinds, title)]
    if trials and (shown := section(rows, names, trials)) is not None:
        sections.append(shown)
    page = assembled(
        f"{title}: largest stable step",
        "The largest time step up to which each combination of schemes creates no energy and no momentum, "
        "and gives the result of a fine solution.",
        sections,
        f"Made by mpmkit {__version__}. It needs no network.",
    )
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(directory, error) from error
    with replacing(path) as partial:
        partial.write_text(page, encoding="utf-8")
    return path


def name_of(row: dict, kinds: list[str], title: str) -> str:
    """A combination by its plug-ins."""
    return ", ".join(str(row[kind]) for kind in kinds) or title


def _map(rows: list[dict], kinds: list[str], title: str) -> Section:
    lines = [(f"{name_of(row, kinds, title)} ({row['limit']})", _bar(row)) for row in rows]
    drawn = "".join(
        f'<div class="map-row"><span>{escape(name)}</span>{svg}</div>'
        for name, svg in [*lines, ("", _axis())]
    )
    body = f'<div class="map">{drawn}</div>'
    body += note(
        "A bar ends at the largest stable step, relative to the limit in brackets. The cross is the smallest "
        "unstable step. The line is the largest step that the schemes use."
    )
    return Section("map", "Map", body)


def _across(part: float) -> float:
    """Position along the logarithmic axis."""
    within = min(max(part, LEAST), MOST)
    return WIDTH * math.log(within / LEAST) / math.log(MOST / LEAST)


def _bar(row: dict) -> str:
    top, middle = (ROW - BAR) / 2, ROW / 2
    stable, declared = _across(row["fraction"]), _across(row["declared"])
    said = f"stable up to {row['fraction']:.3g}"
    parts = f'<rect class="stable" x="0" y="{top}" width="{stable:.1f}" height="{BAR}"/>'
    if row["unstable"] != math.inf:
        x = _across(row["unstable"])
        parts += f'<path class="broken" d="M{x - 5:.1f} {middle - 5}l10 10m0 -10l-10 10"/>'
        said += f"; {WRONG.get(row['broken'], row['broken'])} at {row['unstable']:.3g}"
    parts += f'<path class="declared" d="M{declared:.1f} {top - 4}v{BAR + 8}"/>'
    return (
        f'<svg viewBox="-6 0 {WIDTH + 12} {ROW}" role="img" aria-label="{escape(said)}">'
        f"<title>{escape(said)}</title>{parts}</svg>"
    )


def _axis() -> str:
    marks = "".join(
        f'<path class="tick" d="M{_across(tick):.1f} 0v5"/>'
        f'<text x="{_across(tick):.1f}" y="20" text-anchor="middle">{tick:g}</text>'
        for tick in TICKS
    )
    return f'<svg viewBox="-6 0 {WIDTH + 12} 26" aria-hidden="true">{marks}</svg>'


def _table(rows: list[dict], kinds: list[str], title: str) -> Section:
    headings = ["combination", "limit", "stable up to", "unstable at", "what breaks", "schemes take at most"]
    cells = [
        (
            name_of(row, kinds, title),
            row["limit"],
            f"{row['fraction']:.3g}",
            "–" if row["unstable"] == math.inf else f"{row['unstable']:.3g}",
            WRONG.get(row["broken"], row["broken"]) or "–",
            f"{row['declared']:g}",
        )
        for row in rows
    ]
    body = paragraph(f"{len(rows)} combinations; steps are fractions of the limit.")
    return Section("table", "Table", body + table(headings, cells, "Largest stable steps"))
