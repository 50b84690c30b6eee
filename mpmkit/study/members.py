"""The members of a study: one case each, and its place along the dimensions that are varied."""

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
from ..case.resolved import resolved
from ..errors import CaseError
from ..registry import installed
from ..rheology.refit import with_law
from ..running.case_files import portable
from ..running.provenance import plugins_used
from ..version import __version__
from .model import Changes, Study, shown

MOST = 10_000
"""Members of a study, far more than anybody waits for."""
MEMBER = "member"
"""The one dimension of a list of members."""


@dataclass(frozen=True)
class Member:
    """One variation."""

    labels: dict[str, Any]
    """where it stands, by dimension: a value, or the name of a set of values"""
    data: dict[str, Any]
    """its case, as the content of a case file"""
    case: Case
    remarks: list[str] = field(default_factory=list)
    """what was done to the case that nobody asked for in so many words"""

    @property
    def title(self) -> str:
        """What it is called in figures and messages."""
        return ", ".join(shown(label) for label in self.labels.values())

    @property
    def slug(self) -> str:
        """Name of its directory: readable, and its own."""
        readable = re.sub(r"[^A-Za-z0-9.-]+", "-", self.title).strip("-.")[:60]
        own = hashlib.sha256(json.dumps(self.labels, sort_keys=True).encode()).hexdigest()[:8]
        return f"{readable}-{own}"

    @cached_property  # a mesh that it names may change meanwhile
    def case_digest(self) -> str:
        """Of the case, meshes included."""
        return _digest(portable(self.case))

    @cached_property
    def digest(self) -> str:
        """Of everything that its result depends on: the case, and what runs it."""
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
    # A name for the path of a member, not for its own: every member's run is kept under its labels.
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
        data, remarks = laws_made_over(base, changes)
        for path, value in changes.items():
            assign(data, path, value)
        case = parse_case(data, source="its case")
    except (CaseError, ValueError) as error:
        raise CaseError(f"study '{study.name}', member {title}: {error}") from None
    return Member(labels, resolved(case), case, [*remarks, *case.grid.extensions])


def _outermost_first(changes: Changes) -> Changes:
    """Changes in an order in which none undoes another: a part of a place comes after the place."""
    return dict(sorted(changes.items(), key=lambda change: change[0].count(".")))


def laws_made_over(base: dict[str, Any], changes: Changes) -> tuple[dict[str, Any], list[str]]:
    """The case with each material made over where a change names another law.

    Parameters that are changed along with the law count as given: the rest is fitted around them, and to the
    curve that the old law has with them.
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
    """What is at a path; None if nothing is."""
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
