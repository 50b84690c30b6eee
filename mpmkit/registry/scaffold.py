"""Writes the distribution of a new plug-in from ``templates/``."""

from __future__ import annotations

import importlib.util
import keyword
import os
import re
import shutil
import tempfile
from importlib.resources import files
from pathlib import Path
from string import Template

from ..errors import CaseError
from ..output.atomic import cannot_write
from ..version import __version__
from . import installed

KINDS = {
    "law": "constitutive law",
    "shape": "shape function",
    "order": "update order",
    "velocity": "velocity update",
    "volumetric": "volumetric treatment",
    "redistribution": "redistribution",
    "refinement": "refinement",
    "equation_of_state": "equation of state",
    "body_shape": "body shape",
    "surface": "surface",
    "contact": "contact",
    "body_force": "body force",
    "initial_field": "initial field",
    "sink": "sink",
    "source": "source",
    "diagnostic": "diagnostic",
    "particle_field": "particle field",
}
"""Kinds of plug-ins that have a template, and their names in words."""
PREFIX = "mpmkit-"
NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
LONGEST_NAME = 50


def new_plugin(name: str, kind: str, directory: Path | None = None) -> Path:
    """Write a distribution that registers a plug-in, with tests that pass, and return its directory.

    Args:
        name: name of the plug-in in case files; a leading ``mpmkit-`` is removed, because the distribution's
            name adds it.
        kind: one of ``KINDS``.
        directory: the new directory; default: ``mpmkit-NAME``.

    Raises:
        CaseError: the name is not allowed, or is in use, or the directory exists.
        OutputError: the files cannot be written; then none is left behind.
    """
    plugin = name.removeprefix(PREFIX)
    words = _words(name, plugin)
    _refuse_taken(kind, plugin, words["module"])
    directory = Path(PREFIX + plugin) if directory is None else directory
    if os.path.lexists(directory):
        raise CaseError(f"'{directory}' exists already; name another directory with --out")
    words |= {"kind_in_words": KINDS[kind], "mpmkit_version": ".".join(__version__.split(".")[:2])}
    _write(directory, {path: _filled(template, words) for path, template in _plan(kind, words).items()})
    return directory


def _words(name: str, plugin: str) -> dict[str, str]:
    """Values of the placeholders of the templates, from the name of the plug-in."""
    class_name = "".join(part.capitalize() for part in plugin.split("-"))
    if not NAME.fullmatch(plugin) or len(plugin) > LONGEST_NAME or keyword.iskeyword(class_name):
        raise CaseError(
            f"'{name}' cannot be the name of a plug-in; it must be at most {LONGEST_NAME} lower-case "
            "letters, digits and single hyphens, begin with a letter, and make a class name of Python"
        )
    identifier = plugin.replace("-", "_")
    return {
        "name": plugin,
        "distribution": PREFIX + plugin,
        "identifier": identifier,
        "module": f"mpmkit_{identifier}",
        "class_name": class_name,
    }


def _refuse_taken(kind: str, plugin: str, module: str) -> None:
    taken = installed().plugins[kind].get(plugin)
    if taken is not None:
        raise CaseError(
            f"there is a {KINDS[kind]} '{plugin}' already, of {taken.distribution}; choose another name"
        )
    if plugin in installed().unusable(kind):
        reasons = "; ".join(installed().why_not(kind, plugin))
        raise CaseError(f"there is a {KINDS[kind]} '{plugin}' already: {reasons}; choose another name")
    if importlib.util.find_spec(module) is not None:
        raise CaseError(
            f"there is a module {module} already in this environment; choose another name than '{plugin}'"
        )


def _plan(kind: str, words: dict[str, str]) -> dict[str, str]:
    """Files of the distribution, each with its template."""
    return {
        "pyproject.toml": "pyproject.toml",
        "README.md": "README.md",
        "case.json": f"{kind}/case.json",
        f"src/{words['module']}.py": f"{kind}/module.py",
        f"tests/test_{words['identifier']}.py": f"{kind}/test.py",
    }


def _filled(template: str, words: dict[str, str]) -> str:
    source = files(__package__).joinpath("templates", *f"{template}.template".split("/"))
    return Template(source.read_text(encoding="utf-8")).substitute(words)


def _write(directory: Path, contents: dict[str, str]) -> None:
    """Write all files or none: they are written to a temporary directory, which is then renamed."""
    partial = None
    try:
        directory.parent.mkdir(parents=True, exist_ok=True)
        partial = Path(tempfile.mkdtemp(prefix=f".{directory.name}.", dir=directory.parent))
        partial.chmod(0o755)
        for path, text in contents.items():
            (partial / path).parent.mkdir(exist_ok=True)
            (partial / path).write_text(text, encoding="utf-8")
        partial.rename(directory)
    except OSError as error:
        if partial is not None:
            shutil.rmtree(partial, ignore_errors=True)
        raise cannot_write(directory, error) from error
