"""``mpmkit schema``."""

from __future__ import annotations

import json

import click


@click.command("schema")
def command() -> None:
    """Print the JSON Schema of case files, with units and the parameters of every registered plug-in."""
    from ..case import case_schema
    from ..registry import installed

    click.echo(json.dumps(case_schema(installed()), indent=2, ensure_ascii=False))
