"""``mpmkit plugins``."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import click

from . import options
from .command import with_examples
from .printing import echo, echo_json

COLUMNS = ("kind", "name", "distribution", "citation")


@with_examples("plugins", "mpmkit plugins", "mpmkit plugins --json")
@options.as_json
def command(as_json: bool) -> None:
    """List the registered plug-ins, and those that could not be loaded or were left out."""
    from ..contracts.version1 import deprecation
    from ..registry import installed

    registry = installed()
    found: list[dict[str, Any]] = [
        {
            "kind": kind,
            "name": name,
            "distribution": entry.distribution,
            "version": entry.version,
            "entry_point": entry.entry_point,
            "api_version": entry.plugin.api_version,
            "citation": entry.plugin.citation,
        }
        for kind, entries in registry.plugins.items()
        for name, entry in sorted(entries.items())
    ]
    if as_json:
        problems = [asdict(problem) for problem in registry.problems]
        echo_json({"plugins": found, "problems": problems})
        return
    rows = [COLUMNS] + [
        (entry["kind"], entry["name"], f"{entry['distribution']} {entry['version']}", entry["citation"])
        for entry in found
    ]
    widths = [max(len(row[column]) for row in rows) for column in range(len(COLUMNS))]
    for row in rows:
        cells = (f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True))
        echo("  ".join(cells).rstrip())
    for entries in registry.plugins.values():
        for _, entry in sorted(entries.items()):
            old = deprecation(entry.plugin)
            if old is not None:
                click.echo(old, err=True)
    for problem in registry.problems:
        click.echo(str(problem), err=True)
