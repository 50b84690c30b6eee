"""When something is due: at multiples of an interval and at a list of times."""

from __future__ import annotations

from .case.model import Case


class Schedule:
    """Times that are waited for, in order."""

    def __init__(self, interval: float, until: float, extra: tuple[float, ...] = ()) -> None:
        count = int(until / interval * (1 + 1e-12))
        regular = (k * interval for k in range(count + 1))
        self._times = sorted({t for t in (*regular, *extra) if t <= until * (1 + 1e-12)})
        self._next = 0
        self.last = -1
        """Step at which it was last acted on."""

    def passed(self, now: float) -> bool:
        """Whether a time has come that had not come before."""
        before = self._next
        while self._next < len(self._times) and self._times[self._next] <= now:
            self._next += 1
        return self._next > before


def history_schedule(case: Case, rows: int) -> Schedule:
    """Times of the history's rows: ``rows`` of them unless the case says otherwise."""
    return Schedule(case.output.history_interval or case.until / rows, case.until)


def frame_schedule(case: Case, frames: int) -> Schedule:
    """Times of the frames: those of the interval, and those that the report draws."""
    interval = case.output.frame_interval or case.until / frames
    return Schedule(interval, case.until, tuple(case.output.snapshot_times))
