"""What a person sees of a study: a bar over its members, and a line for each that ends."""

from __future__ import annotations

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from ..study import Member
from ..study.work import Outcome
from .display import console, say


class StudyProgress:
    """A context manager, called with every member that has come to its end."""

    def __init__(self, name: str, total: int, already: int) -> None:
        self._bar = Progress(
            TextColumn("[bold]{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task(name, total=total, completed=already)
        if already:
            say(f"{already} of {total} members have run before and are kept")

    def __enter__(self) -> StudyProgress:
        self._bar.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._bar.stop()

    def __call__(self, member: Member, outcome: Outcome) -> None:
        self._bar.advance(self._task)
        seconds = outcome.cost.get("wall_seconds")
        took = "" if seconds is None else f", {seconds:.1f} s"
        say(f"{member.title}: {outcome.fate}{took}{': ' if outcome.sentence else ''}{outcome.sentence}")
