"""The page of a fit: the parameters, their limits of knowledge, and the figures."""

from __future__ import annotations

from html import escape
from pathlib import Path

from ..output.atomic import replacing
from .result import FitResult, Found, found_in

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 52rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; margin: 1rem 0; }
th, td { text-align: left; padding: .3rem .9rem .3rem 0; border-bottom: 1px solid #ddd; }
td.number { font-variant-numeric: tabular-nums; }
img { max-width: 100%; }
li { margin: .3rem 0; }
"""


def write_page(result: FitResult, pictures: list[Path], path: Path) -> None:
    """Write the page; its pictures are files in the same folder."""
    parts = [
        f"<h1>{escape(result.fit.name)}</h1>",
        f"<p>{escape(result.fit.description)}</p>" if result.fit.description else "",
        _table(result.parameters.values()),
        _list("Remarks", result.sentences),
    ]
    for one in result.evidence:
        parts.append(
            f"<h2>{escape(one.law)}</h2><p>AICc {one.aicc:.4g}, {one.difference:.3g} from the best.</p>"
        )
        parts.append(_table(found_in(result.solutions[one.law], result.fit.level).values()))
    parts += [f'<p><img src="{picture.name}" alt="{picture.stem}"></p>' for picture in pictures]
    parts.append(f"<p>{result.runs} runs; runs.nc contains all of them.</p>")
    text = (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(result.fit.name)}</title>'
        f"<style>{STYLE}</style></head><body>{''.join(parts)}</body></html>\n"
    )
    with replacing(path) as partial:
        partial.write_text(text, encoding="utf-8")


def _table(parameters) -> str:
    rows = "".join(_row(found) for found in parameters)
    return (
        "<table><tr><th>parameter</th><th>value</th><th>from</th><th>to</th><th>unit</th><th>known</th></tr>"
        f"{rows}</table>"
    )


def _row(found: Found) -> str:
    numbers = "".join(f'<td class="number">{x:.4g}</td>' for x in (found.value, found.low, found.high))
    known = f"at {100 * found.level:g} %" if found.identifiable else "not by these measurements"
    return f"<tr><td>{escape(found.path)}</td>{numbers}<td>{escape(found.unit)}</td><td>{known}</td></tr>"


def _list(title: str, sentences: list[str]) -> str:
    items = "".join(f"<li>{escape(sentence)}</li>" for sentence in sentences)
    return f"<h2>{escape(title)}</h2><ul>{items}</ul>" if items else ""
