"""The models of a test, from the coarsest to the finest, as the content of case files."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any

from ..case import parse_case
from ..case.allowed import shown
from ..case.load import read_case
from ..case.model import Case
from ..case.overrides import assign
from ..case.resolved import resolved
from ..case.synonyms import nearest
from ..errors import CaseError
from ..plan import cheaper_models
from ..study.members import Member, laws_made_over
from .measurements import Measured, last_time
from .model import Changes, Test

CELLS = {"grid.cell_size", "grid.domain"}
"""The only paths that a model with coarser cells changes."""


@dataclass(frozen=True)
class Stage:
    """One model of a test."""

    where: str
    data: dict[str, Any]
    """content of a case file"""
    case: Case

    def member(self, values: dict[str, Any]) -> Member:
        """The run with these values of the parameters; its name is the hash of its content.

        Raises:
            CaseError: the values are not valid in the case.
        """
        data = copy.deepcopy(self.data)
        for path, value in values.items():
            assign(data, path, value)
        case = parse_case(data, source=self.where)
        content = Member({}, resolved(case), case)
        name = ", ".join(f"{path} = {_short(value)}" for path, value in values.items())
        return Member({"run": content.case_digest[:16]}, content.data, case, name=name)


def _short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else shown(value)


def stages_of(name: str, test: Test, changes: Changes, measured: list[Measured]) -> list[Stage]:
    """The models of a test, the finest last.

    Args:
        name: of the test.
        test: the test in the fit file.
        changes: values by path, in addition to those of the test.
        measured: its measurements, which determine how long a run must last.

    Raises:
        CaseError: a case is not valid.
    """
    where = f"tests.{name}"
    base = read_case(test.case) if isinstance(test.case, str) else dict(test.case)
    try:
        base, _ = laws_made_over(base, test.changes | changes)
        for path, value in (test.changes | changes).items():
            assign(base, path, value)
    except ValueError as error:
        raise CaseError(f"{where}: {error}") from None
    case = parse_case(base, source=f"{where}.case")
    given = _coarser(case) if test.stages is None else test.stages
    found = []
    for number, more in enumerate(given):
        data = copy.deepcopy(base)
        place = f"{where}.stages.{number}" if test.stages is not None else f"{where}.case"
        try:
            for path, value in more.items():
                assign(data, path, value)
        except ValueError as error:
            raise CaseError(f"{place}: {error}") from None
        data["until"] = last_time(parse_case(data, source=place), measured)
        data["output"] = {"report": False, "frame_interval": data["until"]}
        found.append(Stage(place, data, parse_case(data, source=place)))
    return found


def _coarser(case: Case) -> list[Changes]:
    """Changes that make the cells coarser, the coarsest first; the last entry is empty."""
    coarser = [model for model in cheaper_models(case) if set(model.changes) == CELLS]
    coarser.sort(key=lambda model: -model.case.grid.cell_size)
    return [*(model.changes for model in coarser), {}]


def check_path(stage: Stage, path: str) -> None:
    """Refuse a path that does not lead to a number of a case.

    Raises:
        CaseError: the sentence says what the path leads to.
    """
    here: Any = resolved(stage.case)
    keys = path.split(".")
    for depth, key in enumerate(keys):
        if isinstance(here, dict) and key in here:
            here = here[key]
        elif isinstance(here, list) and key.isascii() and key.isdigit() and int(key) < len(here):
            here = here[int(key)]
        else:
            known = list(here) if isinstance(here, dict) else []
            meant = nearest(key, known)
            place = ".".join(keys[:depth]) or "the case"
            if isinstance(here, list):
                there = f"is a list of {len(here)}, whose entries are counted from 0"
            elif known:
                there = f"has {', '.join(known)}" + (f"; did you mean '{meant}'?" if meant else "")
            else:
                there = f"is {shown(here)}, with nothing in it"
            raise CaseError(f"parameters.{path}: {stage.where} has no such place; {place} {there}")
    if isinstance(here, bool) or not isinstance(here, int | float):
        raise CaseError(
            f"parameters.{path}: it is {shown(here)} in {stage.where}; a parameter must be a real number"
        )
    if isinstance(here, int):
        raise CaseError(
            f"parameters.{path}: it is a whole number in {stage.where}; a parameter must change continuously"
        )
