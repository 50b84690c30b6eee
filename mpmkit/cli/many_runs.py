"""The options of the commands that make many runs: ``study``, ``compare`` and ``fit``."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from . import options
from .paths import PATH

if TYPE_CHECKING:
    from concurrent.futures import Executor


@dataclass(frozen=True)
class ManyRuns:
    """Where and how a command makes its runs.

    Attributes:
        out: the directory that was given; None for the default.
        overwrite: whether results that do not belong to this study or fit may be replaced.
        workers: number of runs at the same time; None for as many as fit on the cores.
        threads: threads of each run; None for the number in the study or fit.
        scheduler: address of a dask.distributed scheduler; None for this machine.
        quiet: whether to print only errors.
    """

    out: str | None
    overwrite: bool
    workers: int | None
    threads: int | None
    scheduler: str | None
    quiet: bool

    def directory(self, name: str) -> Path:
        """The directory of the study or fit of this name."""
        return Path(self.out) if self.out is not None else Path("runs") / name

    def cluster(self) -> AbstractContextManager[Executor | None]:
        """The executor on the scheduler; None if the runs are made on this machine.

        Raises:
            CaseError: there is no scheduler at the address, or a package is missing.
        """
        if self.scheduler is None:
            return nullcontext()
        from ..study.cluster import cluster

        return cluster(self.scheduler)


def many_runs(of: str, run: str, directory: str, overwrite: str) -> Callable[[Callable], Callable]:
    """Decorator that gives a command these options, as one argument ``how``.

    Args:
        of: what the command runs: ``study`` or ``fit``.
        run: the name of one of its runs: ``member`` or ``run``.
        directory: the default of ``--out``.
        overwrite: the help of ``--overwrite``.
    """
    every = (
        click.option("--out", type=PATH, metavar="DIR", help=f"Directory of the {of}; default: {directory}."),
        click.option("--overwrite", is_flag=True, help=overwrite),
        click.option(
            "--workers",
            type=click.IntRange(min=1),
            metavar="N",
            help=f"Number of {run}s at the same time; default: as many as fit on the cores.",
        ),
        click.option(
            "--threads",
            type=click.IntRange(min=1),
            metavar="N",
            help=f"Threads of each {run}; default: the number in the {of}.",
        ),
        click.option(
            "--scheduler",
            metavar="ADDRESS",
            help="Run on the cluster of this dask.distributed scheduler; default: on this machine.",
        ),
        options.quiet,
    )

    def decorate(command: Callable) -> Callable:
        @wraps(command)
        def with_how(
            *,
            out: str | None,
            overwrite: bool,
            workers: int | None,
            threads: int | None,
            scheduler: str | None,
            quiet: bool,
            **others: Any,
        ) -> Any:
            how = ManyRuns(out, overwrite, workers, threads, scheduler, quiet)
            return command(how=how, **others)

        for option in reversed(every):
            with_how = option(with_how)
        return with_how

    return decorate


def study_runs(directory: str) -> Callable[[Callable], Callable]:
    """``many_runs`` for a command that runs a study, whose default of ``--out`` is ``directory``."""
    return many_runs(
        "study", "member", directory, "Replace results in the directory that do not belong to this study."
    )
