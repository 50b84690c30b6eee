"""``mpmkit plugins``."""

from __future__ import annotations

import json

import click

from . import options


@click.command("plugins")
@options.as_json
def command(as_json: bool) -> None:
    """List the registered plug-ins, and those that could not be loaded."""
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
    problems = [
        {"distribution": p.distribution, "entry_point": p.entry_point, "reason": p.reason}
        for p in registry.problems
    ]
    if as_json:
        click.echo(json.dumps({"plugins": found, "problems": problems}, indent=2, ensure_ascii=False))
        return

    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for title in ("kind", "name", "distribution", "source"):
        table.add_column(title)
    for entry in found:
        origin = f"{entry['distribution']} {entry['version']}"
        table.add_row(entry["kind"], entry["name"], origin, entry["citation"])
    Console().print(table)
    for problem in registry.problems:
        click.echo(str(problem), err=True)
