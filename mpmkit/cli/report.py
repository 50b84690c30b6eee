"""``mpmkit report``."""

from __future__ import annotations

from pathlib import Path

import click

from .command import with_examples
from .paths import PATH
from .printing import echo


@with_examples(
    "report", "mpmkit run cases/slump_fast.json --until 0.2 --out runs/short", "mpmkit report runs/short"
)
@click.argument("directory", type=PATH)
def command(directory: str) -> None:
    """Draw the page and the pictures of the run in DIRECTORY again, in its folder report/."""
    from ..errors import CaseError, MpmkitError, reason
    from ..report import write_report

    try:
        written = write_report(Path(directory))
    except MpmkitError:
        raise
    except Exception as error:  # a file of the run is damaged
        raise CaseError(f"the report of '{directory}' cannot be made: {reason(error)}") from None
    for path in written:
        echo(str(path))
