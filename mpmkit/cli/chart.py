"""``mpmkit chart``."""

from __future__ import annotations

from pathlib import Path

import click


@click.command("chart")
@click.argument("study", type=click.Path())
@click.option(
    "--variable", default="spread_diameter", show_default=True, help="History or figure to judge by."
)
@click.option(
    "--reference",
    default="finest",
    show_default=True,
    metavar="FILE|NUMBER|finest",
    help="What the error is against: a CSV file, an exact value, or the finest member.",
)
@click.option(
    "--cost", default="wall_seconds", show_default=True, help="Figure of a member that is its cost."
)
@click.option(
    "--out", type=click.Path(), metavar="FILE", help="The picture; default: chart.png of the study."
)
def command(study: str, variable: str, reference: str, cost: str, out: str | None) -> None:
    """Chart error against cost over the members of STUDY, a study's directory, and name Pareto's front."""
    import xarray

    from ..errors import CaseError
    from ..study.chart import chart
    from ..study.chart_figure import draw

    results = Path(study) / "results.nc"
    try:
        with xarray.open_dataset(results) as dataset:
            dataset.load()
        if "fate" not in dataset:
            raise ValueError
    except (OSError, ValueError):
        raise CaseError(
            f"'{study}' must be the directory of a study that was run; there is no {results} of one"
        ) from None
    found = chart(dataset, variable, reference, cost)
    path = Path(out) if out is not None else Path(study) / "chart.png"
    draw(found, str(dataset.attrs["title"]), path)
    click.echo(f"| Pareto's front | {cost} | error of {variable} against {found.against} |")
    click.echo("|---|---|---|")
    for point in found.front:
        click.echo(f"| {point.title} | {point.cost:.3g} | {100 * point.error:.3g} % |")
    click.echo(f"\nof {len(found.points)} member{'s' * (len(found.points) > 1)}; picture in {path}")
