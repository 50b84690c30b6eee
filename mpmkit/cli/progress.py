"""Display of a study: expected time, a bar over its members, and a line for each finished member."""

from __future__ import annotations

import time as clock
from collections.abc import Callable

from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
)
from rich.text import Text

from ..plan.rough import rough_seconds
from ..study import Member
from ..study.work import Outcome
from .display import console, say
from .duration import duration

WORTH_SAYING = 10.0
"""The expected time of a study is printed if it is at least this, s."""


class StudyProgress:
    """A context manager, called with every member that has come to its end.

    Args:
        name: of the study.
        waiting: members that are to be run.
        already: number of those that have run before.
        at_once: members that run at once.
        threads: of each member.
    """

    def __init__(self, name: str, waiting: list[Member], already: int, at_once: int, threads: int) -> None:
        self._expected = {member.slug: _expected(member, threads) for member in waiting}
        self._at_once = max(1, min(at_once, len(waiting)))
        self._taken = self._of_those = 0.0
        self._since = clock.monotonic()
        total = len(waiting) + already
        self._bar = Progress(
            TextColumn("[bold]{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            _TimeLeft(self._words),
            console=console,
            disable=not console.is_terminal,
        )
        if already:
            say(f"{already} of {total} members have run before and are kept")
        if self._left() >= WORTH_SAYING:
            longest = max(self._expected.values())
            say(
                f"{len(waiting)} members to run, {self._at_once} at once: {self._words()}, "
                f"the longest member about {duration(longest)} (roughly; mpmkit plan measures a member)"
            )
        self._task = self._bar.add_task(name, total=total, completed=already)

    def __enter__(self) -> StudyProgress:
        self._bar.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._bar.stop()

    def __call__(self, member: Member, outcome: Outcome) -> None:
        expected, seconds = self._expected.pop(member.slug, 0.0), outcome.cost.get("wall_seconds")
        if outcome.fate == "finished" and seconds is not None:
            self._taken += seconds
            self._of_those += expected
        self._since = clock.monotonic()
        self._bar.update(self._task, advance=1)
        took = "" if seconds is None else f", {seconds:.1f} s"
        say(f"{member.title}: {outcome.fate}{took}{': ' if outcome.sentence else ''}{outcome.sentence}")

    def _left(self) -> float:
        """Remaining time, s: the rough times of the waiting members, corrected by the real times of others.

        Between the ends of two members, the elapsed time is subtracted.
        """
        correction = self._taken / self._of_those if self._of_those > 0 else 1.0
        each = [correction * seconds for seconds in self._expected.values()]
        left = max(sum(each) / self._at_once, max(each, default=0.0))
        return max(0.0, left - (clock.monotonic() - self._since))

    def _words(self) -> str:
        if not self._expected:
            return ""
        left = self._left()
        return f"about {duration(left)} left" if left > 0 else "longer than expected"


class _TimeLeft(ProgressColumn):
    """The remaining time, computed whenever the bar is drawn."""

    def __init__(self, words: Callable[[], str]) -> None:
        super().__init__()
        self._words = words

    def render(self, task: Task) -> Text:
        return Text(self._words())


def _expected(member: Member, threads: int) -> float:
    """Rough time of a member, s; 0 if a plug-in is faulty, which is reported when the member is run."""
    try:
        return rough_seconds(member.case, threads)
    except Exception:
        return 0.0
