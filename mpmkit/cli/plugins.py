"""``mpmkit plugins``."""

from __future__ import annotations

from dataclasses import asdict

import click

from . import options
from .printing import echo_json

COLUMNS = ("kind", "name", "distribution", "citation")


@click.command("plugins")
@options.as_json
def command(as_json: bool) -> None:
    """List the registered plug-ins, and those that could not be loaded or were left out."""
    from ..registry import installed

    registry = installed()
    found = [
        {
            "kind": kind,
            "name": name,
            "distribution": entry.distribution,
            "version": entry.version,
            "entry_point": entry.entry_point,
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
        click.echo("  ".join(cells).rstrip())
    for problem in registry.problems:
        click.echo(str(problem), err=True)
