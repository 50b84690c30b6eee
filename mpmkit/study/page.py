"""The page of a study: a table of its members, charts of their histories and of error against cost."""

from __future__ import annotations

import json
from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
import xarray

from ..errors import CaseError
from ..output.atomic import replacing
from ..report.page.assembled import assembled
from ..report.page.histories import listed
from ..report.page.section import Section, charts, folded, note, paragraph
from .chart import chart
from .chart_figure import LEAST_ERROR
from .figures import SHOWN, members
from .labels import short_names
from .quantities import COSTS
from .table import COLUMNS, fate_of, shown_in_table

NAME = "index.html"
MOST_CURVES = 40
"""Most members whose histories are drawn; of more members, an even selection is drawn."""
JUDGED = ("spread_diameter", "height", "kinetic_energy")
"""Histories for the error of members; the first that the dataset has is used."""


def write_page(dataset: xarray.Dataset, directory: Path) -> Path:
    """Write the page of a study.

    Args:
        dataset: of ``collect``.
        directory: of the study; it contains the directories of the members.

    Raises:
        OutputError: where it cannot be written.
    """
    path = directory / NAME
    sections = [
        _overview(dataset),
        _cost(dataset),
        _histories(dataset),
        _table(dataset, directory),
        _made(dataset),
    ]
    page = assembled(
        str(dataset.attrs["title"]),
        str(dataset.attrs.get("description", "")),
        [section for section in sections if section is not None],
        f"Made by mpmkit {dataset.attrs.get('mpmkit', '')} from results.nc. It needs no network.",
    )
    with replacing(path) as partial:
        partial.write_text(page, encoding="utf-8")
    return path


def _overview(dataset: xarray.Dataset) -> Section:
    fates = [str(fate) for fate in dataset.fate.values.ravel()]
    finished, waiting = fates.count("finished"), fates.count("")
    said = f"{finished} of {len(fates)} members finished."
    if waiting:
        said += f" {waiting} have not run yet."
    if stopped := len(fates) - finished - waiting:
        said += f" {stopped} stopped before the end; the table says why."
    varied = ", ".join(f"{name} ({dataset.sizes[name]})" for name in map(str, dataset.fate.dims))
    return Section("overview", "Results", paragraph(said, "lead") + paragraph(f"Varied: {varied}."))


def _cost(dataset: xarray.Dataset) -> Section | None:
    """Error against cost of the finished members; None if there are no two to compare, or if the members
    solve different problems: the difference between two materials is not an error."""
    for variable in JUDGED:
        try:
            found = chart(dataset, variable)
        except CaseError:
            continue
        points = sorted(found.points, key=lambda point: point.cost)
        front = found.front
        errors = np.array([max(point.error, LEAST_ERROR) for point in points])
        best = np.array([point in front for point in points])
        unit, words = COSTS[found.cost]
        data = {
            "title": f"Error of the {variable.replace('_', ' ')} against cost",
            "unit": "",
            "x": listed(np.array([point.cost for point in points])),
            "xLabel": words,
            "xUnit": unit,
            "names": [point.title for point in points],
            "curves": [
                {"label": "cheapest for its error", "points": True, "values": _where(best, errors)},
                {"label": "others", "points": True, "values": _where(~best, errors)},
            ],
            "logarithmic": True,
        }
        body = charts({"cost": f"Error of {variable} against cost"}) + note(
            f"The error is the largest difference between the history and that of {found.against}, relative "
            "to its largest value. A member is called cheapest for its error if no other one is both cheaper "
            "and more accurate."
        )
        return Section("cost", "Error against cost", body, {"charts": {"cost": data}})
    return None


def _where(chosen: np.ndarray, values: np.ndarray) -> list[float | None]:
    return listed(np.where(chosen, values, np.nan))


def _histories(dataset: xarray.Dataset) -> Section | None:
    names = [name for name in SHOWN if name in dataset and bool(dataset[name].notnull().any())]
    drawn = [(t, m) for t, m in members(dataset) if any(bool(m[name].notnull().any()) for name in names)]
    if not drawn:
        return None
    every = -(-len(drawn) // MOST_CURVES)
    found: dict[str, dict[str, Any]] = {}
    for name in names:
        label, scale = SHOWN[name]
        title, _, unit = label.rpartition(" (")
        curves = [{"label": t, "values": listed(m[name].values * scale)} for t, m in drawn[::every]]
        found[name.replace("_", "-")] = {
            "title": title.capitalize(),
            "unit": unit.rstrip(")"),
            "x": listed(dataset.time.values),
            "xLabel": "time",
            "xUnit": "s",
            "curves": curves,
        }
    body = charts({name: f"{of['title']} of the members against time" for name, of in found.items()})
    if every > 1:
        body += note(f"The charts show one in {every} members; results.nc has all.")
    return Section("histories", "Histories", body, {"charts": found})


def _table(dataset: xarray.Dataset, directory: Path) -> Section:
    """A row for each member, with a link to its page."""
    places = _directories(directory)
    dimensions = [str(name) for name in dataset.fate.dims]
    headings = [*_named(dataset, dimensions), *(heading for _, heading, _, _ in COLUMNS), "how it ended"]
    rows = ""
    for title, member in members(dataset):
        labels = [str(member[name].item()) for name in dimensions]
        place = places.get(tuple(labels))
        name = escape(labels[0])
        first = (
            name if place is None else f'<a href="{escape(quote(place))}" title="{escape(title)}">{name}</a>'
        )
        cells = [*map(escape, labels[1:])]
        cells += [shown_in_table(float(member[key]), scale, form) for key, _, scale, form in COLUMNS]
        cells.append(escape(fate_of(member)))
        rows += f'<tr><th scope="row">{first}</th>{"".join(f"<td>{cell}</td>" for cell in cells)}</tr>'
    head = "".join(f'<th scope="col">{escape(heading)}</th>' for heading in headings)
    body = (
        '<div class="scroll" tabindex="0" role="region" aria-label="Members"><table>'
        f"<thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>"
    )
    return Section("members", "Members", body)


def _named(dataset: xarray.Dataset, dimensions: list[str]) -> list[str]:
    """Short names of the dimensions, with units."""
    short = short_names(dimensions)
    units = {name: str(dataset[name].attrs.get("units", "1")) for name in dimensions}
    return [short[name] + ("" if units[name] == "1" else f" ({units[name]})") for name in dimensions]


def _directories(directory: Path) -> dict[tuple[str, ...], str]:
    """Pages of the members, or their directories if they have none, relative to the study's directory."""
    from .members import shown

    found = {}
    for path in sorted(directory.glob("members/*/member.json")):
        try:
            labels = json.loads(path.read_text(encoding="utf-8"))["labels"]
        except (OSError, ValueError, KeyError):
            continue
        page = NAME if (path.parent / NAME).exists() else ""
        found[tuple(shown(label) for label in labels.values())] = f"members/{path.parent.name}/{page}"
    return found


def _made(dataset: xarray.Dataset) -> Section:
    text = json.dumps(json.loads(dataset.attrs.get("study", "{}")), indent=2, ensure_ascii=False)
    body = paragraph("To run the missing members and make the results again:")
    command = "mpmkit study DIRECTORY/study.json --out DIRECTORY"
    body += f'<pre class="command" tabindex="0"><code>{command}</code></pre>'
    body += folded("The whole study", f'<pre tabindex="0"><code>{escape(text)}</code></pre>')
    return Section("repeat", "How the study was made", body)
