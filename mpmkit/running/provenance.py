"""What was run, with what, and where: the global attributes of a history."""

from __future__ import annotations

import json
import platform

import numba
import numpy as np

from ..case.model import Case
from ..case.plugins import plugins_of
from ..case.resolved import resolved
from ..registry import installed
from ..version import __version__


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
