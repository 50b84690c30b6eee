"""All results of a study in one dataset."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import xarray

from ..case.ending import conditions
from ..case.model import Case
from ..output.netcdf import read_dataset
from ..version import __version__
from .chart import ONE_PROBLEM
from .histories import ROWS, number_or_nan, scalars_at
from .labels import unit_of
from .members import Member, dimensions, shown
from .model import Study
from .problem import solve_one_problem
from .quantities import COSTS, FIGURES
from .store import Store


def collect(study: Study, members: list[Member], store: Store) -> xarray.Dataset:
    """One dataset of all members: a dimension for each varied quantity, and time.

    Histories are interpolated linearly to common times; after a member's end they are NaN. Results that a
    member does not have are NaN; the ``fate`` of a member that has not run is empty.
    """
    axes = dimensions(study)
    shape = tuple(len(labels) for labels in axes.values())
    time = np.linspace(0.0, max(_end(member, store) for member in members), ROWS)
    names = tuple(axes)
    fields: dict[str, tuple] = {
        name: (names, np.full(shape, np.nan), {"units": units, "long_name": text})
        for name, (units, text) in (FIGURES | COSTS).items()
    }
    fields["fate"] = (names, np.full(shape, "", dtype=object), {"long_name": "how the run ended"})
    fields["sentence"] = (
        names,
        np.full(shape, "", dtype=object),
        {"long_name": "remark or error message"},
    )
    for place, member in zip(np.ndindex(shape), members, strict=True):
        record = store.outcome(member)
        if record is None:
            continue
        fields["fate"][1][place] = record["fate"]
        fields["sentence"][1][place] = record["sentence"]
        for name in FIGURES:
            fields[name][1][place] = number_or_nan(record["summary"].get(name))
        for name in COSTS:
            fields[name][1][place] = number_or_nan(record["cost"].get(name))
        history = store.history(member)
        if history is not None:
            _add_history(fields, history, (*names, "time"), place, time)
    coordinates: dict[str, Any] = {
        name: (name, [shown(label) for label in labels], _described(name, members[0].case))
        for name, labels in axes.items()
    }
    dataset = xarray.Dataset(fields, coordinates | {"time": ("time", time, {"units": "s"})})
    dataset.attrs = {
        "title": study.name,
        "description": study.description,
        "study": json.dumps(study.model_dump(mode="json")),
        "mpmkit": __version__,
        ONE_PROBLEM: int(solve_one_problem(members)),
    }
    return dataset


def _end(member: Member, store: Store) -> float:
    """The end time, s, of a member: the time reached if conditions may end it, else that of its case."""
    record = store.outcome(member) if conditions(member.case.until) else None
    return member.case.end if record is None else record["summary"].get("simulated_time") or member.case.end


def _add_history(fields: dict, path, names: tuple, place: tuple, time: np.ndarray) -> None:
    for name, values, attributes in scalars_at(read_dataset(path), time):
        if name not in fields:
            shape = next(iter(fields.values()))[1].shape
            fields[name] = (names, np.full((*shape, len(time)), np.nan), attributes)
        fields[name][1][place] = values


def _described(dimension: str, case: Case) -> dict[str, str]:
    """Attributes of a dimension: the unit of the quantity that it varies, if it varies one."""
    unit = unit_of(case, dimension)
    return {} if unit is None else {"units": unit}
