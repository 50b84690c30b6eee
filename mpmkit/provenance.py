"""What was run, with what, and where: the global attributes of a history."""

from __future__ import annotations

import json
import platform
from typing import Any

import numba
import numpy as np

from . import __version__
from .case.model import Case
from .contracts import Plugin
from .recorder import FRAMES, ROWS
from .registry import installed
from .solver.scene import particles_along_axes


def plugins_of(case: Case) -> list[tuple[str, Plugin]]:
    """Kind and plug-in, for every plug-in that the case uses."""
    scheme = case.scheme
    used = [(kind, getattr(scheme, kind)) for kind in ("shape", "order", "velocity", "volumetric")]
    for body in case.bodies:
        law = body.material.constitutive_law
        used.append(("law", law))
        if law.uses_equation_of_state:
            used.append(("equation_of_state", body.material.equation_of_state))
    return used


def plugins_used(case: Case) -> list[dict[str, str]]:
    """Every plug-in that the case uses, with the distribution and version that it came from."""
    found: list[dict[str, str]] = []
    for kind, plugin in plugins_of(case):
        entry = {"kind": kind, "name": plugin.name}
        origin = installed().plugins[kind].get(plugin.name)
        if origin is not None:
            entry |= {"distribution": origin.distribution, "version": origin.version}
        if entry not in found:
            found.append(entry)
    return found


def resolved(case: Case) -> dict[str, Any]:
    """The case with everything filled in that it leaves to a default."""
    data = case.model_dump(mode="json")
    data["gravity"] = case.gravity_vector.tolist()
    data["output"]["history_interval"] = case.output.history_interval or case.until / ROWS
    data["output"]["frame_interval"] = case.output.frame_interval or case.until / FRAMES
    for body, entry in zip(case.bodies, data["bodies"], strict=True):
        entry["particles_per_cell"] = list(particles_along_axes(body, case.space_.dim))
        if entry["shape"].get("base", ...) is None:
            entry["shape"]["base"] = [0.0] * case.space_.dim
        entry["velocity"] = entry["velocity"] or [0.0] * case.space_.dim
    return data


def attributes(case: Case, threads: int) -> dict[str, str]:
    """Global attributes of a history; what is structured is JSON."""
    machine = {
        "platform": platform.platform(),
        "processor": platform.processor() or platform.machine(),
        "python": platform.python_version(),
        "threads": threads,
    }
    return {
        "title": case.name,
        "case": json.dumps(resolved(case)),
        "versions": json.dumps({"mpmkit": __version__, "numpy": np.__version__, "numba": numba.__version__}),
        "plugins": json.dumps(plugins_used(case)),
        "machine": json.dumps(machine),
    }
