"""The error to expect of a model: that of the member of the shipped study which differs from it in nothing.

The study is of one slump (docs/accuracy_vs_cost.md), in ``slump_study.json``. Its axes are space, cells,
shape, order, volumetric treatment, law and sound speed; if anything else differs, it knows nothing of a case.
"""

from __future__ import annotations

import copy
import csv
import json
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from ..case import parse_case
from ..case.model import Case
from ..case.overrides import assign
from ..case.resolved import resolved
from ..errors import CaseError

SCHEMES = ("shape", "order", "volumetric")
"""Kinds of plug-in that are axes of the study."""
NOT_OF_THE_FLOW = ("name", "description", "output", "until")
"""Keys of a case that say how long it is watched, and what is written of it."""


def expected_error(case: Case) -> float | None:
    """Largest departure of the spread from the reference in the first 1.5 s, as part of its largest value.

    None if a key of the case differs from the study's base case that is no axis of the study, or if the study
    has no such value on an axis. Cells count by how many the scene is high, finer ones than the study's as
    its finest, which in 3-D are 20 mm with 8 particles a cell.
    """
    dim = case.space_.dim
    cells = case.height / case.grid.cell_size * (1 + 1e-6)
    known = [int(r["cells"]) for r in _rows() if int(r["dim"]) == dim and int(r["cells"]) <= cells]
    place = {kind: getattr(case.scheme, kind).name for kind in SCHEMES}
    place |= {"law": _law(case), "sound": _sound(case)}
    if not known or not _is_member(case, place):
        return None
    wanted = {"dim": str(dim), "cells": str(max(known)), **place}
    for row in _rows():
        if all(row[key] == value for key, value in wanted.items()):
            return float(row["error"]) if row["error"] else None
    return None


def _is_member(case: Case, place: dict[str, Any]) -> bool:
    """Whether a case differs in nothing but cells, domain and sound speed from the member at a place."""
    if None in place.values() or case.space not in _study()["models"]:
        return False
    member = copy.deepcopy(_study()["case"])
    changes = _study()["models"][case.space] | _study()["laws"][place["law"]]
    changes |= {f"scheme.{kind}": place[kind] for kind in SCHEMES}
    for path, value in changes.items():
        assign(member, path, value)
    try:
        twin = parse_case(member)
    except CaseError:  # of a plug-in that was left out
        return False
    ends = [np.array([c.grid.domain[axis] for axis in c.space_.axes]) for c in (case, twin)]
    wide_enough = (ends[0][:, 0] == ends[1][:, 0]).all() and (ends[0][:-1, 1] >= ends[1][:-1, 1]).all()
    return bool(wide_enough) and _flow(case) == _flow(twin)


def _flow(case: Case) -> dict[str, Any]:
    """All that the flow depends on, apart from cells, domain and sound speed."""
    data = {key: value for key, value in resolved(case).items() if key not in NOT_OF_THE_FLOW}
    data["grid"] = {side: face for side, face in data["grid"]["faces"].items() if face != "open"}
    if case.space_.radial:
        data["grid"].pop("r_min", None)  # the axis, whether it is named or not
    for body in data["bodies"]:
        del body["material"]["sound_speed"]
    return data


def _law(case: Case) -> str | None:
    """The law as the study calls it, without its parameters."""
    laws = {body.material.law for body in case.bodies}
    names = {changes["bodies.0.material.law"]: name for name, changes in _study()["laws"].items()}
    return names.get(laws.pop()) if len(laws) == 1 else None


def _sound(case: Case) -> str | None:
    speeds = [body.material.sound_speed for body in case.bodies]
    if any(getattr(speed, "mach", None) is not None for speed in speeds):
        return "mach 0.1" if all(0.05 < getattr(speed, "mach", 0.0) <= 0.1 for speed in speeds) else None
    free_fall = (2 * case.largest_energy) ** 0.5
    factor = (
        min(case.sound_speed(body.material) or 0.0 for body in case.bodies) / free_fall if free_fall else 0.0
    )
    if not 9.5 <= factor < 30:
        return None
    return "factor 10" if factor < 15 else "factor 20"


@cache
def _study() -> dict[str, Any]:
    return json.loads((files(__package__) / "slump_study.json").read_text(encoding="utf-8"))


@cache
def _rows() -> list[dict[str, str]]:
    with (files(__package__) / "slump_errors.csv").open(encoding="utf-8") as lines:
        return list(csv.DictReader(lines))
