"""``mpmkit fit``."""

from __future__ import annotations

from typing import Any

import click

from .command import with_examples
from .many_runs import ManyRuns, many_runs
from .paths import PATH
from .printing import echo


@with_examples("fit", "mpmkit fit cases/fits/final_spread.json")
@click.argument("fit", type=PATH)
@many_runs(
    "fit",
    "run",
    "runs/<fit name>",
    "Replace the result of another fit in the directory; its runs are kept.",
)
def command(fit: str, how: ManyRuns) -> None:
    """Find the parameters of cases from the measurements that FIT describes.

    Runs that are kept in the directory, of the same case and with the same versions, are not run again.
    """
    from ..errors import Interrupted
    from ..fitting import fit as find
    from ..fitting import load_fit
    from ..fitting.directory import PAGE
    from ..running.interrupts import take_signals_as_interrupts

    wanted = load_fit(fit)
    directory = how.directory(wanted.name)
    take_signals_as_interrupts()
    with how.cluster() as executor:
        try:
            result = find(
                wanted,
                directory,
                overwrite=how.overwrite,
                threads=how.threads,
                workers=how.workers,
                executor=executor,
                listen=None if how.quiet else _Counter(wanted.budget.runs),
            )
        except KeyboardInterrupt:
            raise Interrupted(
                f"interrupted; the runs that had finished are in '{directory}', and the same command "
                "continues from there"
            ) from None
    if how.quiet:
        return
    for found in result.parameters.values():
        unit = f" {found.unit}" if found.unit else ""
        interval = f"from {found.low:.4g} to {found.high:.4g}{unit} at {100 * found.level:g} %"
        if found.identifiable:
            echo(f"{found.path} = {found.value:.4g}{unit}, {interval}")
        else:
            echo(f"{found.path} is not known from these measurements: {interval}")
    for one in result.comparisons:
        echo(one.sentence)
    for sentence in result.sentences:
        echo(sentence)
    echo(f"based on {result.runs} runs; results in {directory}; open {directory / PAGE} in a browser")


class _Counter:
    """A line for each run that has ended.

    Args:
        most: largest number of runs that the budget allows.
    """

    def __init__(self, most: int) -> None:
        self._count, self._most = 0, most

    def __call__(self, member: Any, outcome: Any) -> None:
        from .display import say

        self._count += 1
        seconds = outcome.cost.get("wall_seconds")
        took = "" if seconds is None else f" in {seconds:.1f} s"
        cell = 1e3 * member.case.grid.cell_size
        said = f"{member.name}, cells of {cell:.3g} mm: {outcome.fate}{took}"
        say(f"fit: run {self._count} of at most {self._most}, {said}")
