"""The members of a study: one case each, with its place along the varied dimensions."""

from __future__ import annotations

import copy
import hashlib
import itertools
import json
import re
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from ..case import parse_case
from ..case.load import read_case
from ..case.model import Case
from ..case.overrides import assign
from ..case.parameters import BLOCK, expand, refuse_unused
from ..case.resolved import resolved
from ..errors import CaseError
from ..registry import installed
from ..rheology.refit import with_law
from ..running.case_files import portable
from ..running.provenance import plugins_used
from ..version import __version__
from .model import Changes, Study, shown

MOST = 10_000
"""Most members of a study."""
MEMBER = "member"
"""The one dimension of a list of members."""


@dataclass(frozen=True)
class Member:
    """One variation."""

    labels: dict[str, Any]
    """its place along each dimension: a value, or the name of a set of values"""
    data: dict[str, Any]
    """its case, as the content of a case file"""
    case: Case
    remarks: list[str] = field(default_factory=list)
    """changes of the case that the study did not ask for explicitly"""
    name: str = ""
    """title of its page; default: its place along the dimensions"""

    @property
    def title(self) -> str:
        """Its name in figures and messages."""
        return ", ".join(shown(label) for label in self.labels.values())

    @property
    def heading(self) -> str:
        """The title of its page."""
        if self.name or list(self.labels) == [MEMBER]:
            return self.name or self.title
        return ", ".join(f"{dimension} = {shown(label)}" for dimension, label in self.labels.items())

    @property
    def slug(self) -> str:
        """Name of its directory: readable and unique."""
        readable = re.sub(r"[^A-Za-z0-9.-]+", "-", self.title).strip("-.")[:60]
        own = hashlib.sha256(json.dumps(self.labels, sort_keys=True).encode()).hexdigest()[:8]
        return f"{readable}-{own}"

    @cached_property  # its mesh file may change later
    def case_digest(self) -> str:
        """Hash of the case, meshes included."""
        return _digest(portable(self.case))

    @cached_property
    def digest(self) -> str:
        """Hash of everything that its result depends on: the case and the versions."""
        plugins = plugins_used(self.case)
        return _digest({"case": self.case_digest, "mpmkit": __version__, "plugins": plugins})


def _digest(known: Any) -> str:
    return hashlib.sha256(json.dumps(known, sort_keys=True).encode()).hexdigest()


def dimensions(study: Study) -> dict[str, list[Any]]:
    """Labels along each dimension of a study."""
    if study.members:
        return {MEMBER: list(study.members)}
    return {name: list(choices) for name, choices in study.vary.items()}


def members_of(study: Study) -> list[Member]:
    """All members, the last dimension running fastest.

    Raises:
        CaseError: the case of a member is not valid; the sentence names the member.
    """
    base = read_case(study.case) if isinstance(study.case, str) else dict(study.case)
    axes = dimensions(study)
    count = 1
    for labels in axes.values():
        count *= len(labels)
    if count > MOST:
        raise CaseError(f"the study has {count} members; it may have {MOST:,} at most")
    # All members keep the name of the case: their runs are stored under their labels.
    return [
        _member(study, base, dict(zip(axes, labels, strict=True)))
        for labels in itertools.product(*axes.values())
    ]


def _member(study: Study, base: dict[str, Any], labels: dict[str, Any]) -> Member:
    own: Changes = {}
    for dimension, label in labels.items():
        own |= _changes(study, dimension, label)
    common = {path: value for path, value in study.common.items() if path not in own}
    changes = _outermost_first(common) | _outermost_first(own)
    title = ", ".join(f"{dimension} = {shown(label)}" for dimension, label in labels.items())
    try:
        data, changes = _with_parameters(base, changes)
        data, remarks = laws_made_over(data, changes)
        for path, value in changes.items():
            assign(data, path, value)
        case = parse_case(data, source="its case")
    except (CaseError, ValueError) as error:
        raise CaseError(f"study '{study.name}', member {title}: {error}") from None
    return Member(labels, resolved(case), case, [*remarks, *case.grid.extensions])


def _outermost_first(changes: Changes) -> Changes:
    """Changes sorted so that none replaces another: a place comes before its parts."""
    return dict(sorted(changes.items(), key=lambda change: change[0].count(".")))


def _with_parameters(base: dict[str, Any], changes: Changes) -> tuple[dict[str, Any], Changes]:
    """The case with its parameters as numbers, and the other changes: a new law is fitted to numbers."""
    data = copy.deepcopy(base)
    refuse_unused(data, "its case")
    own = {path: value for path, value in changes.items() if path.partition(".")[0] == BLOCK}
    for path, value in own.items():
        assign(data, path, value)
    return expand(data, "its case"), {path: value for path, value in changes.items() if path not in own}


def laws_made_over(base: dict[str, Any], changes: Changes) -> tuple[dict[str, Any], list[str]]:
    """The case with each material converted if a change names another law.

    Parameters that are changed together with the law are fixed. The others are fitted to the flow curve of
    the old law with these changes.
    """
    remarks: list[str] = []
    base = copy.deepcopy(base)
    for path, name in changes.items():
        place = path.removesuffix(".law")
        material = _at(base, place)
        if path.endswith(".material.law") and isinstance(material, dict) and isinstance(name, str):
            given = {
                key.rpartition(".")[2]: value
                for key, value in changes.items()
                if key.rpartition(".")[0] == place and key != path
            }
            made, said = with_law(material | given, name, installed())
            material.clear()
            material.update(made)
            remarks += said
    return base, remarks


def _at(data: Any, path: str) -> Any:
    """The value at a path; None if there is none."""
    for key in path.split("."):
        if isinstance(data, dict):
            data = data.get(key)
        elif isinstance(data, list) and key.isdigit() and int(key) < len(data):
            data = data[int(key)]
        else:
            return None
    return data


def _changes(study: Study, dimension: str, label: Any) -> Changes:
    if study.members:
        return study.members[label]
    choices = study.vary[dimension]
    return choices[label] if isinstance(choices, dict) else {dimension: label}
