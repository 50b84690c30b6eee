"""The error to expect of a model: that of the member of the shipped study which is most like it.

The study is of one slump (docs/accuracy_vs_cost.md): an expectation for other flows, not a promise.
"""

from __future__ import annotations

import csv
from functools import cache
from importlib.resources import files
from typing import Any

from ..case.model import Case
from ..contracts.elastoviscoplastic import ElastoviscoplasticLaw
from ..contracts.generalised_newtonian import GeneralisedNewtonianLaw


def expected_error(case: Case) -> float | None:
    """Largest departure of the spread from the reference, relative; None for what the study does not tell.

    Cells count by how many the scene is high, finer ones than the study's as its finest. In 3-D, where the
    study has its coarsest cells alone, finer cells have the error of the body of revolution, which agrees
    with it to a tenth of a per cent (docs/performance.md).
    """
    cells = case.height / case.grid.cell_size * (1 + 1e-6)
    dim = 2 if case.space_.radial else case.space_.dim
    if case.space == "plane-strain":
        return None
    if dim == 3 and cells >= 30:
        dim = 2
    known = [int(row["cells"]) for row in _rows() if int(row["dim"]) == dim and int(row["cells"]) <= cells]
    if not known:
        return None
    wanted = {"dim": str(dim), "cells": str(max(known)), **_schemes(case), **_materials(case)}
    for row in _rows():
        if all(row[key] == value for key, value in wanted.items()):
            return float(row["error"]) if row["error"] else None
    return None


def _schemes(case: Case) -> dict[str, Any]:
    return {kind: getattr(case.scheme, kind).name for kind in ("shape", "order", "volumetric")}


def _materials(case: Case) -> dict[str, Any]:
    """Of the worst of all materials: a regularised law, the slowest sound."""
    laws = [body.material.constitutive_law for body in case.bodies]
    if not all(isinstance(law, ElastoviscoplasticLaw | GeneralisedNewtonianLaw) for law in laws):
        return {"law": None}
    exact = all(isinstance(law, ElastoviscoplasticLaw) for law in laws)
    return {"law": "exact" if exact else "relaxed", "sound": _sound(case)}


def _sound(case: Case) -> str | None:
    speeds = [body.material.sound_speed for body in case.bodies]
    if any(getattr(speed, "mach", None) is not None for speed in speeds):
        return "mach 0.1" if all(getattr(speed, "mach", 0.0) <= 0.1 for speed in speeds) else None
    free_fall = (2 * case.largest_energy) ** 0.5
    factor = (
        min(case.sound_speed(body.material) or 0.0 for body in case.bodies) / free_fall if free_fall else 0.0
    )
    if factor < 9.5:
        return None
    return "factor 10" if factor < 15 else "factor 20"


@cache
def _rows() -> list[dict[str, str]]:
    with (files(__package__) / "slump_errors.csv").open(encoding="utf-8") as lines:
        return list(csv.DictReader(lines))
