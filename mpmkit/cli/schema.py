"""``mpmkit schema``."""

from __future__ import annotations

from .command import with_examples
from .printing import echo_json


@with_examples("schema", "mpmkit schema > case.schema.json")
def command() -> None:
    """Print the JSON Schema of case files, with units and the parameters of every registered plug-in."""
    from ..case import case_schema
    from ..registry import installed

    echo_json(case_schema(installed()))
