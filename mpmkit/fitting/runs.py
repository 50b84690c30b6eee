"""Runs of all tests at points of the parameters: in parallel, stored, and never made twice."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray

from ..errors import GuardStop, MpmkitError
from ..output.netcdf import read_dataset
from ..study import execute
from ..study.execute import Listener
from ..study.members import Member
from ..study.store import Store
from ..study.work import FAILED
from .measurements import Bounds, Measured, Predicted, bounds_of_stopped, predicted
from .model import Budget
from .stages import Stage

FINISHED = "finished"
LEFT = "particle-outside"
"""The guard that stops a run whose material reaches the end of its domain: up to then the run is valid."""


class Spent(Exception):
    """The budget is too small for the next runs."""


@dataclass(frozen=True)
class Test:
    """A test with its models and its measurements."""

    __test__ = False  # for pytest, which would collect it by its name

    name: str
    stages: list[Stage]
    measured: list[Measured]

    def stage(self, number: int, of: int) -> Stage:
        """Its model in a stage of all tests. A test with fewer models uses them in the last stages."""
        return self.stages[max(0, len(self.stages) - of + number)]


@dataclass(frozen=True)
class Point:
    """All tests at one point."""

    stage: int
    values: dict[str, float]
    members: list[Member]
    predicted: Predicted | None
    """None where a guard stopped a run"""
    bounds: Bounds | None
    """what the runs say if a guard stopped one; None if nothing"""
    sentence: str
    """message of a run that a guard stopped"""


class Purse:
    """The rest of the budget.

    Args:
        budget: budget of the whole fit.
    """

    def __init__(self, budget: Budget) -> None:
        self.spent = 0
        self._runs = budget.runs
        self._end = None if budget.minutes is None else clock.monotonic() + 60 * budget.minutes

    def pay(self, runs: int) -> None:
        """Take runs from the budget.

        Raises:
            Spent: there are fewer runs left, or the time is over.
        """
        if runs and (
            self.spent + runs > self._runs or (self._end is not None and clock.monotonic() >= self._end)
        ):
            raise Spent
        self.spent += runs


class Runs:
    """Runs of tests at points, kept in a store.

    Args:
        tests: of the material.
        store: keeps the result of each run.
        threads: of each run.
        purse: the rest of the budget.
        executor: runs them.
        listen: called for each run that has ended.
        page: file name of the page of the fit, to which the pages of its runs link; None for no pages.
    """

    def __init__(
        self,
        tests: Sequence[Test],
        store: Store,
        threads: int,
        purse: Purse,
        executor: Executor,
        listen: Listener | None = None,
        page: str | None = None,
    ) -> None:
        self.tests = list(tests)
        self.stages = max(len(test.stages) for test in tests)
        self.points: list[Point] = []
        self._store, self._threads, self._purse = store, threads, purse
        self._executor, self._listen, self._page = executor, listen, page
        self._histories: dict[str, xarray.Dataset] = {}
        self._known: dict[tuple[int, tuple[float, ...]], Point] = {}

    @property
    def last(self) -> int:
        """Number of the finest stage."""
        return self.stages - 1

    def at(self, stage: int, places: Sequence[dict[str, float]]) -> list[Point]:
        """The results of the tests at some points, in the order of the points.

        Raises:
            Spent: the budget is too small for them.
            MpmkitError: a run failed because of the machine; finished runs are kept.
        """
        keys = [(stage, tuple(values.values())) for values in places]
        new = {key: values for key, values in zip(keys, places, strict=True) if key not in self._known}
        members = {
            key: [test.stage(stage, self.stages).member(values) for test in self.tests]
            for key, values in new.items()
        }
        self.make([member for each in members.values() for member in each])
        for key, values in new.items():
            self._known[key] = self._point(stage, values, members[key])
            self.points.append(self._known[key])
        return [self._known[key] for key in keys]

    def make(self, members: Sequence[Member]) -> None:
        """Make the missing runs in parallel.

        Raises:
            Spent: the budget is too small for them.
        """
        waiting = {member.slug: member for member in members if not self._store.settled(member)}
        self._purse.pay(len(waiting))
        execute(
            list(waiting.values()),
            self._store,
            self._threads,
            executor=self._executor,
            listen=self._listen,
            page=self._page,
        )

    def history(self, member: Member) -> xarray.Dataset | None:
        """History of a run; None if there is none."""
        path = self._store.history(member)
        if path is not None and member.slug not in self._histories:
            self._histories[member.slug] = read_dataset(path)
        return self._histories.get(member.slug)

    def page(self, member: Member) -> Path | None:
        """Page of a run; None if there is none."""
        return self._store.page(member)

    def record(self, member: Member) -> dict:
        """Content of ``member.json`` of a run."""
        return self._store.outcome(member) or {}

    def _point(self, stage: int, values: dict[str, float], members: list[Member]) -> Point:
        parts, bounds, stopped = [], [], ""
        for test, member in zip(self.tests, members, strict=True):
            record = self.record(member)
            if record.get("fate", FAILED) == FAILED:
                raise MpmkitError(
                    f"test '{test.name}' with {said(values)}: the run failed: {record.get('sentence', '')}"
                )
            history = self.history(member)
            if record["fate"] == FINISHED:
                assert history is not None
                end = test.stage(stage, self.stages).case.end
                parts.append(predicted(test.measured, record["summary"], history, end))
                bounds.append(Bounds(parts[-1].value, parts[-1].value))
                continue
            stopped = stopped or f"{record['fate']}: {record['sentence']}"
            if record["fate"] != LEFT or history is None or history.sizes["time"] < 2:
                return Point(stage, values, members, None, None, stopped)
            bounds.append(bounds_of_stopped(test.measured, record["summary"], history))
        both = Bounds(np.concatenate([b.low for b in bounds]), np.concatenate([b.high for b in bounds]))
        if stopped:
            return Point(stage, values, members, None, both, stopped)
        result = Predicted(
            np.concatenate([part.value for part in parts]), np.concatenate([part.scale for part in parts])
        )
        return Point(stage, values, members, result, both, "")


def said(values: dict[str, float]) -> str:
    """Values in the words of a sentence."""
    return ", ".join(f"{path} = {value:.4g}" for path, value in values.items())


def require(point: Point) -> Predicted:
    """The predicted values at a point.

    Raises:
        GuardStop: a guard stopped a run there.
    """
    if point.predicted is None:
        raise GuardStop("fit", f"the run with {said(point.values)} was stopped, {point.sentence}", step=0)
    return point.predicted
