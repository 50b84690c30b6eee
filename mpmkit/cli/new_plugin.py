"""``mpmkit new-plugin``."""

from __future__ import annotations

from pathlib import Path

import click

from .command import with_examples
from .paths import PATH
from .printing import echo

KINDS = [
    "law",
    "shape",
    "order",
    "velocity",
    "volumetric",
    "redistribution",
    "refinement",
    "equation_of_state",
    "body_shape",
    "surface",
    "contact",
    "body_force",
    "initial_field",
    "sink",
    "source",
    "diagnostic",
    "particle_field",
]


@with_examples("new-plugin", "mpmkit new-plugin honey --kind law")
@click.argument("name")
@click.option(
    "--kind",
    type=click.Choice(KINDS),
    required=True,
    help="What the plug-in is.",
)
@click.option("--out", type=PATH, metavar="DIR", help="Directory to make; default: mpmkit-NAME.")
def command(name: str, kind: str, out: str | None) -> None:
    """Write a distribution for a new plug-in NAME, with tests that pass; replace its equations by yours."""
    from ..registry.scaffold import new_plugin

    directory = new_plugin(name, kind, None if out is None else Path(out))
    echo(f"wrote {directory}; next: cd '{directory}' && pip install -e '.[test]' && pytest")
