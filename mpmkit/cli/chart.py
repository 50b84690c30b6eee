"""``mpmkit chart``."""

from __future__ import annotations

from pathlib import Path

import click

from .command import with_examples
from .paths import PATH, refuse_existing
from .printing import echo


@with_examples(
    "chart",
    "mpmkit compare cases/slump_fast.json --vary grid.cell_size=0.02,0.03 --until 0.2 --out runs/cells",
    "mpmkit chart runs/cells",
)
@click.argument("study", type=PATH)
@click.option(
    "--variable", default="spread_diameter", show_default=True, help="History or number that is compared."
)
@click.option(
    "--reference",
    default="finest",
    show_default=True,
    type=PATH,
    metavar="FILE|NUMBER|finest",
    help="Reference of the error: a CSV file, an exact value, or the finest member.",
)
@click.option(
    "--cost", default="wall_seconds", show_default=True, help="Number that is the cost of a member."
)
@click.option("--out", type=PATH, metavar="FILE", help="The picture; default: chart.png of the study.")
@click.option("--overwrite", is_flag=True, help="Replace a file that --out names.")
def command(study: str, variable: str, reference: str, cost: str, out: str | None, overwrite: bool) -> None:
    """Draw error against cost for the members of the study in the directory STUDY, with the Pareto front."""
    from ..errors import CaseError
    from ..output.netcdf import read_dataset
    from ..study.chart import chart
    from ..study.chart_figure import draw

    if out is not None:  # chart.png of the study is always replaced
        refuse_existing(Path(out), overwrite)
    results = Path(study) / "results.nc"
    try:
        dataset = read_dataset(results)
        if "fate" not in dataset:
            raise ValueError
    except (OSError, RuntimeError, ValueError):
        raise CaseError(
            f"'{study}' must be the directory of a study that was run; it has no valid {results.name}"
        ) from None
    found = chart(dataset, variable, reference, cost)
    path = Path(out) if out is not None else Path(study) / "chart.png"
    draw(found, str(dataset.attrs["title"]), path)
    echo(f"| Pareto's front | {cost} | error of {variable} against {found.against} |")
    echo("|---|---|---|")
    for point in found.front:
        echo(f"| {point.title} | {point.cost:.3g} | {100 * point.error:.3g} % |")
    echo(f"\nof {len(found.points)} member{'s' * (len(found.points) > 1)}; picture in {path}")
