"""The page of a fit: parameters with intervals, measured and fitted values, figures, and all runs."""

from __future__ import annotations

import base64
import math
from html import escape
from pathlib import Path
from urllib.parse import quote

import numpy as np

from ..output.atomic import replacing
from ..report.page.assembled import assembled
from ..report.page.section import Section, bullets, note, paragraph, table
from ..version import __version__
from .result import FitResult, found_in, names_of
from .runs import Point
from .solve import Solution

CAPTIONS = {
    "fitted": "Measured and fitted values. The bars are standard uncertainties, and the band holds all "
    "curves of parameters that fit.",
    "misfit": "How well other values fit. Points are runs, and the red line is the limit of the values that "
    "fit. √Δχ² is the distance from the best fit in standard deviations.",
    "flow_curve": "Flow curve of the material, with the band of all parameters that fit.",
}
"""What the pictures show, by the names of their files."""


def write_page(result: FitResult, pictures: list[Path], path: Path) -> None:
    """Write the page, which contains its pictures.

    Raises:
        OutputError: where it cannot be written.
    """
    sections = [_parameters(result), _laws(result), _figures(pictures), _runs(result, path.parent)]
    text = assembled(
        result.fit.name,
        result.fit.description,
        [section for section in sections if section is not None],
        f"Made by mpmkit {__version__}. It needs no network.",
    )
    with replacing(path) as partial:
        partial.write_text(text, encoding="utf-8")


def _parameters(result: FitResult) -> Section:
    body = _table(result, result.solution, "Parameters") + _measurements(result)
    for title, sentences in (
        ("What these measurements cannot tell", result.unknown),
        ("What else to measure", [result.advice]),
        ("Remarks", result.remarks),
    ):
        if sentences:
            body += f"<h3>{escape(title)}</h3>" + bullets(sentences)
    return Section("parameters", "Results", body)


def _measurements(result: FitResult) -> str:
    """A row for each measured number, with its fitted value; a sentence for each curve."""
    rows = [
        (
            one.test,
            f"{one.variable} ({one.unit})" if one.unit not in ("", "1") else one.variable,
            f"{float(one.measured.value[0]):.4g}",
            f"{float(one.fitted[0]):.4g}",
            f"{float(one.uncertainty[0]):.2g}",
            f"{float(one.off[0] / one.uncertainty[0]):+.2f}",
        )
        for one in result.comparisons
        if not one.is_curve
    ]
    headings = (
        "test",
        "measurement",
        "measured",
        "fitted",
        "uncertainty",
        "(fitted − measured) / uncertainty",
    )
    body = (
        table(headings, rows, "Measured and fitted values; the uncertainty includes the model error")
        if rows
        else ""
    )
    return body + bullets([f"{one.sentence}." for one in result.comparisons if one.is_curve])


def _laws(result: FitResult) -> Section | None:
    """The parameters of each law, if several were fitted."""
    if not result.evidence:
        return None
    body = ""
    for one in result.evidence:
        body += f"<h3>{escape(one.law)}</h3>" + paragraph(
            f"AICc {one.aicc:.4g}, {one.difference:.3g} from the best."
        )
        body += _table(result, result.solutions[one.law], f"Parameters of {one.law}")
    return Section("laws", "Laws", body)


def _table(result: FitResult, solution: Solution, caption: str) -> str:
    """The parameters by name; a value that is not known is not shown as if it were."""
    names, level = names_of(solution), f"{100 * result.fit.level:g} %"
    rows = [
        (
            names.label(found.path),
            f"{found.value:.4g}" if found.identifiable else "not known",
            f"{found.low:.4g}",
            f"{found.high:.4g}",
            found.path,
        )
        for found in found_in(solution, result.fit.level).values()
    ]
    headings = ("parameter", "value", "from", "to", "in the case")
    return table(headings, rows, f"{caption}, with their intervals at {level}")


def _figures(pictures: list[Path]) -> Section:
    body = ""
    for picture in pictures:
        caption = escape(CAPTIONS[picture.stem])
        data = base64.b64encode(picture.read_bytes()).decode()
        body += (
            '<figure class="picture"><div class="scroll" tabindex="0" role="region" '
            f'aria-label="{picture.stem.replace("_", " ")}">'
            f'<img src="data:image/png;base64,{data}" alt="{caption}" style="min-width: 34rem"></div>'
            f"<figcaption>{caption}</figcaption></figure>"
        )
    return Section("figures", "Figures", body)


def _runs(result: FitResult, directory: Path) -> Section:
    """A row for each run, those with the least misfit first, with a link to its page."""
    several = len(result.solutions) > 1
    rows = sorted(
        (
            (_chi2(solution, point), law, solution, point)
            for law, solution in result.solutions.items()
            for point in solution.runs.points
        ),
        key=lambda row: (row[0], row[1]),
    )
    values = ", ".join(result.names.label(path) for path in result.parameters)
    head = [*(["law"] if several else []), "values" if several else values, "model", "misfit χ²", "pages"]
    body = ""
    for chi2, law, solution, point in rows:
        cells = [_values(point), _model(solution, point), "–" if math.isinf(chi2) else f"{chi2:.4g}"]
        body += f"<tr>{_law(law) if several else ''}{''.join(map(_cell, cells))}"
        body += f"<td>{_links(solution, point, directory)}</td></tr>"
    headings = "".join(f'<th scope="col">{escape(heading)}</th>' for heading in head)
    listed = (
        '<div class="scroll tall" tabindex="0" role="region" aria-label="Runs"><table>'
        f"<thead><tr>{headings}</tr></thead><tbody>{body}</tbody></table></div>"
    )
    said = f"{result.runs} runs, those that fit best first; runs.nc contains all of them. "
    return Section("runs", "Runs", note(f"{said}Model 1 is the coarsest.") + listed)


def _law(name: str) -> str:
    return f'<th scope="row">{escape(name)}</th>'


def _cell(text: str) -> str:
    return f"<td>{escape(text)}</td>"


def _values(point: Point) -> str:
    return ", ".join(f"{value:.4g}" for value in point.values.values())


def _model(solution: Solution, point: Point) -> str:
    return f"{point.stage + 1} of {solution.runs.stages}"


def _links(solution: Solution, point: Point, directory: Path) -> str:
    """Links to the pages of the tests at a point; their names where there is no page."""
    found = []
    for test, member in zip(solution.runs.tests, point.members, strict=True):
        page = solution.runs.page(member)
        name = escape(test.name)
        if page is not None:
            name = f'<a href="{escape(quote(page.relative_to(directory).as_posix()))}">{name}</a>'
        found.append(name)
    return ", ".join(found)


def _chi2(solution: Solution, point: Point) -> float:
    """Misfit of a point; infinite where a guard stopped a run."""
    if point.predicted is None:
        return math.inf
    return float(np.sum(solution.survey.likelihood.misfit.residuals(point.predicted.value) ** 2))
