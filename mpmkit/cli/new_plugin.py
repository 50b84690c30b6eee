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
    help="Kind of the plug-in.",
)
@click.option("--out", type=PATH, metavar="DIR", help="The new directory; default: mpmkit-NAME.")
def command(name: str, kind: str, out: str | None) -> None:
    """Write a package for a new plug-in NAME, with an example and tests that pass; replace its equations."""
    from ..registry.scaffold import new_plugin

    directory = new_plugin(name, kind, None if out is None else Path(out))
    echo(f"wrote {directory}; next: cd '{directory}' && pip install -e '.[test]' && pytest")
