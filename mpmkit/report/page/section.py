"""A section of a page: its HTML, and the data that its script draws."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from html import escape
from typing import Any


@dataclass(frozen=True)
class Section:
    """A part of a page with a heading of its own."""

    name: str
    """letters and '-'; the id of the section, and the key of its data"""
    title: str
    body: str
    """HTML"""
    data: dict[str, Any] = field(default_factory=dict)
    """data for its script, written as JSON; without NaN"""


def paragraph(text: str, of: str = "") -> str:
    """A paragraph of plain text, of a CSS class."""
    return f"<p{_class(of)}>{escape(text)}</p>"


def note(text: str) -> str:
    """A paragraph in smaller letters."""
    return paragraph(text, "note")


def table(headings: Iterable[str], rows: Iterable[Iterable[str]], caption: str) -> str:
    """A table of plain text; it scrolls if it is too wide."""
    head = "".join(f'<th scope="col">{escape(text)}</th>' for text in headings)
    body = "".join(f"<tr>{''.join(_cells(row))}</tr>" for row in rows)
    return (
        f'<div class="scroll" tabindex="0" role="region" aria-label="{escape(caption)}">'
        f"<table><caption>{escape(caption)}</caption><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        "</div>"
    )


def _cells(row: Iterable[str]) -> Iterable[str]:
    for column, text in enumerate(row):
        yield f'<th scope="row">{escape(text)}</th>' if column == 0 else f"<td>{escape(text)}</td>"


def pairs(rows: Iterable[tuple[str, str]]) -> str:
    """A list of terms with their descriptions."""
    said = "".join(f"<div><dt>{escape(term)}</dt><dd>{escape(text)}</dd></div>" for term, text in rows)
    return f'<dl class="pairs">{said}</dl>'


def bullets(sentences: Iterable[str], of: str = "") -> str:
    """A list of sentences."""
    return f"<ul{_class(of)}>{''.join(f'<li>{escape(text)}</li>' for text in sentences)}</ul>"


def folded(summary: str, content: str, opened: bool = False) -> str:
    """HTML that opens with a click on a line of plain text."""
    return (
        f"<details{' open' if opened else ''}><summary>{escape(summary)}</summary>"
        f'<div class="folded">{content}</div></details>'
    )


def charts(names: Mapping[str, str]) -> str:
    """Places of charts, side by side if there is room; the labels are for screen readers."""
    places = "".join(chart_place(name, label) for name, label in names.items())
    return f'<div class="charts">{places}</div>' if places else ""


def chart_place(name: str, label: str) -> str:
    """Place of the chart ``name``; the label is for screen readers."""
    return f'<figure class="chart" data-chart="{escape(name)}" aria-label="{escape(label)}"></figure>'


def _class(of: str) -> str:
    return f' class="{of}"' if of else ""
