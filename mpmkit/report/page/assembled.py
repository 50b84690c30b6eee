"""Put a page together: one HTML file that contains its style, scripts and data."""

from __future__ import annotations

import json
from collections.abc import Sequence
from html import escape
from importlib.resources import files

from .section import Section

STYLES = ("uPlot.min.css", "page.css")
SCRIPTS = (
    "uPlot.iife.min.js",
    "unpack.js",
    "colours.js",
    "charts.js",
    "walls.js",
    "flow.js",
    "matrices.js",
    "surface.js",
    "section_view.js",
    "solid_view.js",
    "player.js",
    "page.js",
)
"""Scripts in their order in the page; they share one scope."""
FORBIDDEN = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
"""Content security policy of a page: it uses only what it contains and sends no request."""
LIVE = f"{FORBIDDEN}; connect-src 'self'"


def assembled(
    title: str,
    description: str,
    sections: Sequence[Section],
    made_by: str,
    live: bool = False,
    above: str | None = None,
) -> str:
    """The whole page.

    Args:
        title: of the page.
        description: a sentence or two below it.
        sections: in their order.
        made_by: what made the page, and with which version.
        live: whether its scripts may ask the server that it came from for newer data.
        above: address of the page that this one is a part of, relative to this one.
    """
    style = "\n".join(_static(name) for name in STYLES)
    script = "\n".join(_static(name) for name in SCRIPTS)
    data = {section.name: section.data for section in sections if section.data}
    links = "" if above is None else f'<a href="{escape(above)}">↑ all runs</a>'
    links += "".join(f'<a href="#{s.name}">{escape(s.title)}</a>' for s in sections)
    parts = "".join(
        f'<section id="{s.name}" aria-labelledby="{s.name}-title">'
        f'<h2 id="{s.name}-title">{escape(s.title)}</h2>'
        f"{s.body}</section>"
        for s in sections
    )
    said = f"<p>{escape(description)}</p>" if description else ""
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{LIVE if live else FORBIDDEN}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n<link rel="icon" href="data:,">\n'
        f"<title>{escape(title)}</title>\n<style>\n{style}\n</style>\n</head>\n<body>\n"
        f"<header><h1>{escape(title)}</h1>{said}</header>\n"
        f'<nav aria-label="Sections">{links}</nav>\n<main>{parts}</main>\n'
        f"<footer><p>{escape(made_by)}</p></footer>\n"
        f'<script type="application/json" id="data">{_json(data)}</script>\n'
        f"<script>\n(() => {{\n'use strict';\n{script}\n}})();\n</script>\n</body>\n</html>\n"
    )


def _static(name: str) -> str:
    return (files(__package__) / "static" / name).read_text(encoding="utf-8")


def _json(data: dict) -> str:
    """JSON that cannot end the script in which it stands."""
    text = json.dumps(data, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("<", "\\u003c")
