"""Versions of mpmkit, of Python, and of what mpmkit uses."""

from __future__ import annotations

import platform
import re
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, requires, version

from ..version import __version__
from .finding import Finding

REQUIREMENT = re.compile(r"\s*([A-Za-z0-9._-]+)[^;]*(;.*)?$")
ABSENT = "not installed"


def versions() -> Finding:
    """Every package that mpmkit needs, and the installed packages of its extras."""
    found = Finding({"mpmkit": __version__, "Python": f"{platform.python_version()} ({sys.executable})"})
    for name, is_extra in _used():
        try:
            found.facts[name] = version(name)
        except PackageNotFoundError:
            if not is_extra:
                found.facts[name] = ABSENT
                found.problems.append(f"the package '{name}', which mpmkit needs, is not installed")
    return found


def _used() -> Iterator[tuple[str, bool]]:
    """Names of packages, and whether only an extra asks for them."""
    try:
        lines = requires("mpmkit") or []
    except PackageNotFoundError:  # a checkout that is not installed
        return
    for line in lines:
        match = REQUIREMENT.match(line)
        if match is not None and not match[1].startswith("mpmkit"):
            yield match[1].partition("[")[0], "extra ==" in (match[2] or "")
