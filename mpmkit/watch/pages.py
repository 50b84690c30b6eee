"""The page that is shown while a run is at work."""

from __future__ import annotations

import json
from html import escape
from importlib.resources import files

from .so_far import SoFar


def page(so_far: SoFar) -> str:
    """A page that follows the run."""
    history = so_far.history()
    return (
        _static("live.html")
        .replace("TITLE", escape(history["name"]))
        .replace("/* SCRIPT */", _static("live.js"))
        .replace('"DATA"', json.dumps(history).replace("<", "\\u003c"))
    )


def _static(name: str) -> str:
    return (files(__package__) / "static" / name).read_text(encoding="utf-8")
