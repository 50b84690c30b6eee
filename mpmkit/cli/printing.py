"""Printing on a terminal or into a file whose encoding lacks some of our characters."""

from __future__ import annotations

import json
import sys
from typing import Any

import click


def replace_unknown_characters() -> None:
    """Print a question mark for what the encoding of an output lacks: no result is lost for a dash."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)  # a stream put in their place may lack it
        if reconfigure is not None:
            reconfigure(errors="replace")


def echo_json(data: Any) -> None:
    """Print JSON: its characters as they are in UTF-8, and escaped in every other encoding."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    readable = encoding.lower().replace("-", "").replace("_", "") == "utf8"
    click.echo(json.dumps(data, indent=2, ensure_ascii=not readable))
