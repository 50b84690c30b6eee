"""The models of a test, from the coarsest to the finest, as the content of case files."""

from __future__ import annotations

import copy
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from ..case import parse_case
from ..case.allowed import shown
from ..case.ending import latest
from ..case.load import read_case
from ..case.model import Case
from ..case.overrides import assign
from ..case.parameters import BLOCK, expand, parameters, refuse_unused
from ..case.resolved import resolved
from ..case.synonyms import nearest
from ..errors import CaseError
from ..plan import cheaper_models
from ..study.members import Member, laws_made_over
from .measurements import Measured, end_of
from .model import Changes, Test

CELLS = {"grid.cell_size", "grid.domain"}
"""The only paths that a model with coarser cells changes."""


@dataclass(frozen=True)
class Stage:
    """One model of a test."""

    where: str
    data: dict[str, Any]
    """content of a case file, which may have parameters and formulas"""
    changes: Changes
    """values by path that replace those of the case"""
    until: dict[str, Any] | float
    """end of its runs"""
    case: Case

    @property
    def units(self) -> dict[str, str]:
        """Units of the parameters at the top of the case, by path."""
        return {f"{BLOCK}.{name}": entry.unit for name, entry in parameters(self.data).items()}

    def member(self, values: Changes) -> Member:
        """The run with these values of parameters, and perhaps of ``output``; it is stored under its hash.

        Raises:
            CaseError: the values are not valid in the case.
        """
        case = _case(self.where, self.data, self.changes | _of_a_run(self.until) | values)
        content = Member({}, resolved(case), case)
        named = {path: value for path, value in values.items() if not path.startswith("output.")}
        name = ", ".join(f"{path} = {_short(value)}" for path, value in named.items())
        return Member({"run": content.case_digest[:16]}, content.data, case, name=name)


def _short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else shown(value)


def _of_a_run(until: Any) -> Changes:
    """What every run of a fit has, besides its values."""
    output = {"report": False, "frame_interval": latest(until)}
    return {"until": until} | {f"output.{key}": value for key, value in output.items()}


def _case(where: str, base: dict[str, Any], changes: Changes) -> Case:
    """A case with changes: its parameters first, from which its other numbers are computed, then the others.

    Raises:
        CaseError: it is not valid.
    """
    data = copy.deepcopy(base)
    own = {path: value for path, value in changes.items() if path.partition(".")[0] == BLOCK}
    others = {path: value for path, value in changes.items() if path not in own}
    try:
        for path, value in own.items():
            assign(data, path, value)
        data = expand(data, where)
        data.pop("output", None)  # of the runs that a user looks at
        data, _ = laws_made_over(data, others)
        for path, value in others.items():
            assign(data, path, value)
    except ValueError as error:
        raise CaseError(f"{where}: {error}") from None
    return parse_case(data, source=where)


def base_of(name: str, test: Test) -> dict[str, Any]:
    """The content of the case file of a test.

    Raises:
        CaseError: it cannot be read.
    """
    base = read_case(test.case) if isinstance(test.case, str) else dict(test.case)
    refuse_unused(base, f"tests.{name}.case")
    return base


def case_of(name: str, test: Test, base: dict[str, Any], changes: Changes) -> Case:
    """The case of a test with its changes.

    Raises:
        CaseError: it is not valid.
    """
    return _case(f"tests.{name}.case", base, test.changes | changes)


def stages_of(
    name: str, test: Test, base: dict[str, Any], changes: Changes, measured: list[Measured]
) -> list[Stage]:
    """The models of a test, the finest last.

    Args:
        name: of the test.
        test: the test in the fit file.
        base: content of its case file.
        changes: values by path, in addition to those of the test.
        measured: its measurements, which determine how long a run must last.

    Raises:
        CaseError: a case is not valid.
    """
    where = f"tests.{name}"
    given = _coarser(base, case_of(name, test, base, changes)) if test.stages is None else test.stages
    found = []
    for number, more in enumerate(given):
        place = f"{where}.stages.{number}" if test.stages is not None else f"{where}.case"
        every = test.changes | changes | more
        until = end_of(_case(place, base, every), measured)
        found.append(Stage(place, base, every, until, _case(place, base, every | _of_a_run(until))))
    return found


def _coarser(base: dict[str, Any], case: Case) -> list[Changes]:
    """Changes that make the cells coarser, the coarsest first; the last entry is empty.

    If a parameter at the top of the case is the size of the cells, it is changed, since other numbers of the
    case are computed from it.
    """
    coarser = [model for model in cheaper_models(case) if set(model.changes) == CELLS]
    coarser.sort(key=lambda model: -model.case.grid.cell_size)
    size = str(base["grid"]["cell_size"]).removeprefix("=").strip()
    known = parameters(base).get(size)
    if known is not None and known.given:
        return [*({f"{BLOCK}.{size}": model.case.grid.cell_size} for model in coarser), {}]
    return [*(model.changes for model in coarser), {}]


def check_path(stage: Stage, path: str, base_changes: Collection[str] = ()) -> None:
    """Refuse a path that does not lead to a number of a case.

    Raises:
        CaseError: the sentence says what the path leads to.
    """
    first = path.split(".")[0]
    if first in ("until", "output", "scheme") or path in ("grid.cell_size", "grid.domain"):
        raise CaseError(
            f"parameters.{path}: it is a setting of the calculation; a parameter must be a property of the "
            "material or of the test"
        )
    if path in stage.changes and path not in base_changes:
        raise CaseError(
            f"{stage.where} changes {path}, which is a parameter of the fit; leave it out of the stage"
        )
    here: Any = resolved(stage.case)
    known_numbers = {name: entry.value for name, entry in parameters(stage.data).items() if entry.given}
    if known_numbers:
        here = {BLOCK: known_numbers} | here
    keys = path.split(".")
    for depth, key in enumerate(keys):
        if isinstance(here, dict) and key in here:
            here = here[key]
        elif isinstance(here, list) and key in map(str, range(len(here))):
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
