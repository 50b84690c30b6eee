"""The case, the software and the machine of a run: the global attributes of a history."""

from __future__ import annotations

import json
import platform
import shlex
import sys
from pathlib import Path

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
    """Global attributes of a history; structured values are JSON."""
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


def log_lines(case: Case, threads: int) -> list[str]:
    """The first lines of a log: the command, the versions, the plug-ins and the machine."""
    said = attributes(case, threads)
    versions = [f"{name} {version}" for name, version in json.loads(said["versions"]).items()]
    plugins = [
        f"{p['kind']} {p['name']} ({p.get('distribution', 'not installed')} {p.get('version', '')})"
        for p in json.loads(said["plugins"])
    ]
    machine = [f"{name} {value}" for name, value in json.loads(said["machine"]).items()]
    program, *arguments = sys.argv or ["python"]
    return [
        f"command: {shlex.join([Path(program).name, *arguments])}",
        f"versions: {', '.join(versions)}",
        f"plug-ins: {', '.join(plugins)}",
        f"machine: {', '.join(machine)}",
    ]
