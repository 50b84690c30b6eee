"""``mpmkit compare``."""

from __future__ import annotations

import click

from . import options
from .command import with_examples
from .many_runs import ManyRuns, study_runs
from .study import run_study


@with_examples("compare", "mpmkit compare cases/slump_fast.json --vary scheme.order=usl,usf --until 0.2")
@options.case_file
@click.option(
    "--vary",
    multiple=True,
    required=True,
    metavar="PATH=A,B,…",
    help="Values of one key to run side by side, such as scheme.order=usl,usf; repeat for a grid.",
)
@options.set_values
@options.until
@study_runs("runs/compare-<case name>")
def command(
    case: str, vary: tuple[str, ...], overrides: tuple[str, ...], until: float | None, how: ManyRuns
) -> None:
    """Run CASE with every combination of the given values, and collect the results as a study does."""
    from ..case.load import name_from, read_case
    from ..case.overrides import apply_overrides
    from ..errors import CaseError
    from ..study import parse_study
    from ..study.clashes import replaced
    from ..study.vary import parse_vary

    varied = parse_vary(vary)
    lost = replaced([override.partition("=")[0] for override in overrides], varied)
    if lost is not None:
        raise CaseError(
            f"--set {lost[0]} is a part of --vary {lost[1]}, which replaces it in every member; "
            f"leave it out, or make it a part of the values of --vary {lost[1]}"
        )
    data = apply_overrides(read_case(case), options.with_until(overrides, until))
    study = parse_study(
        {
            "name": f"compare-{name_from(case)}"[:100],
            "case": data,
            "vary": varied,
        },
        source="--vary",
    )
    run_study(study, how)
