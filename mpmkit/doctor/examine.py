"""All sections of the examination. If one fails, the others still run."""

from __future__ import annotations

from collections.abc import Callable

from ..errors import reason
from .caches import caches
from .disk import disk
from .finding import Finding
from .machine import machine
from .memory import memory
from .plugins import plugins
from .threads import threads
from .versions import versions

SECTIONS: dict[str, Callable[[], Finding]] = {
    "versions": versions,
    "machine": machine,
    "threads": threads,
    "caches": caches,
    "memory": memory,
    "disk": disk,
    "plug-ins": plugins,
}


def examine() -> dict[str, Finding]:
    """Findings by the name of their section; a section that fails has a problem that says why."""
    found = {}
    for name, section in SECTIONS.items():
        try:
            found[name] = section()
        except Exception as error:
            found[name] = Finding(problems=[f"the section '{name}' could not be examined: {reason(error)}"])
    return found
