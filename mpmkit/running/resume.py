"""Continuing a run from its last checkpoint, if the case and the versions are the same."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numba
import numpy as np

from ..case import load_case
from ..case.ending import conditions
from ..case.model import Case
from ..errors import CaseError
from ..output import RunDirectory
from ..output.checkpoints import Checkpoints
from ..output.copies import Copies
from ..output.near_runs import why_no_run
from ..output.summary import ENDED, FINISHED
from ..version import __version__
from .case_files import named_files, portable
from .provenance import plugins_used
from .schedule import AT_THE_END


def identity(case: Case) -> dict[str, Any]:
    """Everything except the machine that the exact results depend on: the case and the versions."""
    return {
        "mpmkit": __version__,
        "numpy": np.__version__,
        "numba": numba.__version__,
        "case": json.loads(json.dumps(portable(case))),
        "plugins": {f"{entry['kind']} '{entry['name']}'": _source(entry) for entry in plugins_used(case)},
    }


def _source(plugin: dict[str, str]) -> str:
    return f"{plugin.get('distribution', '?')} {plugin.get('version', '?')}"


def differences(before: Any, now: Any, path: str = "") -> list[str]:
    """Differences of two JSON trees, each as ``path was A and is B``."""
    if isinstance(before, dict) and isinstance(now, dict):
        keys = [*before, *(key for key in now if key not in before)]
        pairs = [(f"{path}.{key}" if path else key, before.get(key), now.get(key)) for key in keys]
    elif isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        pairs = [(f"{path}.{i}", a, b) for i, (a, b) in enumerate(zip(before, now, strict=True))]
    else:
        same = before == now
        return [] if same else [f"{path} was {json.dumps(before)} and is {json.dumps(now)}"]
    return [sentence for name, a, b in pairs for sentence in differences(a, b, name)]


def other_case(before: dict[str, Any], case: Case) -> list[str]:
    """Differences of a case from the result of ``portable``; files are named by their paths."""
    paths = {file.where: file.path for file in named_files(case)}
    found = differences(before, json.loads(json.dumps(portable(case))))
    for number, sentence in enumerate(found):
        where = sentence.partition(" was ")[0]
        if where in paths:
            found[number] = f"{where} is '{paths[where]}', which holds something else"
    return found


def case_of(directory: Path) -> Case:
    """The case that a run directory holds.

    Raises:
        CaseError: there is none, or a mesh in it was changed.
    """
    file = RunDirectory(directory).case
    if not file.is_file():
        path = RunDirectory(directory).path
        why = "it has no case.json" if path.is_dir() else why_no_run(path)
        raise CaseError(f"'{directory}' is not the directory of a run: {why}")
    Copies(RunDirectory(directory).meshes).check()
    return load_case(file)


def for_longer(case: Case, until: float | None, directory: Path) -> Case:
    """The case of a run with a later end; None leaves it as it is.

    A time replaces conditions: the run then continues to this time, and the conditions are ignored.

    Raises:
        CaseError: the end is earlier, or not a number.
    """
    if until is None:
        return case
    ended = case.end if not conditions(case.until) else _simulated_time(RunDirectory(directory))
    if not ended <= until < math.inf:
        raise CaseError(
            f"until is {until:g} s; the run in '{directory}' ends at {ended:g} s, "
            "and can only go on to a later time"
        )
    return load_case(RunDirectory(directory).case, [f"until={until!r}"])


def last_checkpoint(
    directory: Path, before: Case, case: Case
) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """The state in the last valid checkpoint of a run, and the identity of the continued run.

    Args:
        directory: of the run.
        before: its case.
        case: the same case, whose end may be later.

    Raises:
        CaseError: there is none, or the case or the versions differ; the sentence names the difference. A
        later ``until`` does not count as a difference.
    """
    files = RunDirectory(directory)
    checkpoints = Checkpoints(files.checkpoints)
    if _has_finished(files, before, case):
        ended = _simulated_time(files) if conditions(case.until) else case.end
        raise CaseError(
            f"the run in '{directory}' has finished: there is nothing to go on with; "
            f"--until T with a T above {ended:g} s makes it longer"
        )
    state, words = checkpoints.newest()
    saved, now = words["identity"], identity(case)
    found = differences(saved | {"case": None}, now | {"case": None})
    conditional = isinstance(saved["case"]["until"], dict)
    earlier = float(state["simulation/time"]) > case.end if conditional else saved["case"]["until"] > case.end
    ended = saved["case"] if earlier else saved["case"] | {"until": now["case"]["until"]}
    found += [f"case.{sentence}" for sentence in other_case(ended, case)]
    if found:
        more = f", and {len(found) - 1} more" if len(found) > 1 else ""
        raise CaseError(
            f"the run in '{directory}' cannot go on, because it would be a different run: {found[0]}{more}"
        )
    return state, now


def _has_finished(files: RunDirectory, before: Case, case: Case) -> bool:
    summary = _summary(files)
    if summary.get("stopped_because") == FINISHED:
        return _simulated_time(files) > case.end * AT_THE_END
    return summary.get("stopped_because") in ENDED and before.until == case.until


def _simulated_time(files: RunDirectory) -> float:
    """The time, s, that a run has reached; 0 if it is not recorded."""
    time = _summary(files).get("simulated_time")
    return float(time) if isinstance(time, int | float) else 0.0


def _summary(files: RunDirectory) -> dict[str, Any]:
    try:
        summary = json.loads(files.summary.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return summary if isinstance(summary, dict) else {}
