"""The expected error of a model: that of the same model in the shipped study.

The study varies one slump (docs/accuracy_vs_cost.md), in ``slump_study.json``. Its axes are space, cells,
shape, order, volumetric treatment, law and sound speed. If a case differs in anything else, no error is
known.
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
"""Kinds of plug-ins that are axes of the study."""
NOT_OF_THE_FLOW = ("name", "description", "output", "until")
"""Keys of a case for the run time and the output."""


def expected_error(case: Case) -> float | None:
    """Largest error of the spread in the first 1.5 s, relative to the largest value of the reference.

    None if the case differs from the study's base case in a key that is not an axis of the study, or if the
    study does not have its value on an axis. Cells are compared by the height of the scene in cells; finer
    cells than in the study count as its finest, which in 3-D are 20 mm with 8 particles per cell.
    """
    dim = case.space_.dim
    cells = case.height / case.grid.cell_size * (1 + 1e-6)
    known = [int(r["cells"]) for r in _rows() if int(r["dim"]) == dim and int(r["cells"]) <= cells]
    if case.sources:
        return None
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
    """Whether a case differs only in cells, domain and sound speed from a given member."""
    if None in place.values() or case.space not in _study()["models"]:
        return False
    member = copy.deepcopy(_study()["case"])
    changes = _study()["models"][case.space] | _study()["laws"][place["law"]]
    changes |= {f"scheme.{kind}": place[kind] for kind in SCHEMES}
    for path, value in changes.items():
        assign(member, path, value)
    try:
        twin = parse_case(member)
    except CaseError:  # a plug-in is not installed
        return False
    ends = [np.array([c.grid.domain[axis] for axis in c.space_.axes]) for c in (case, twin)]
    wide_enough = (ends[0][:, 0] == ends[1][:, 0]).all() and (ends[0][:-1, 1] >= ends[1][:-1, 1]).all()
    return bool(wide_enough) and _flow(case) == _flow(twin)


def _flow(case: Case) -> dict[str, Any]:
    """The content of the case that the flow depends on, except cells, domain and sound speed."""
    data = {key: value for key, value in resolved(case).items() if key not in NOT_OF_THE_FLOW}
    data["grid"] = {side: face for side, face in data["grid"]["faces"].items() if face != "open"}
    if case.space_.radial:
        data["grid"].pop("r_min", None)  # the axis of symmetry; naming it is optional
    for body in data["bodies"]:
        del body["material"]["sound_speed"]
    return data


def _law(case: Case) -> str | None:
    """The name of the law in the study, without its parameters."""
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
