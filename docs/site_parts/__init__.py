"""Parts of the pages that are made when the site is built, each from its one source.

A page names a part in a comment, ``<!-- made: case-reference -->``; the part stands there on the site.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from . import api, case_reference, command_reference, docstrings, gallery

MARK = re.compile(r"^<!-- made: ([\w-]+)(?: (\S+))? -->$", re.MULTILINE)
PARTS: dict[str, Callable[..., str]] = {
    "api": api.page,
    "case-reference": case_reference.page,
    "command-reference": command_reference.page,
    "gallery": gallery.page,
}


def filled(text: str) -> str:
    """The text of a page with its parts in it."""
    return MARK.sub(lambda mark: PARTS[mark[1]](*filter(None, mark.groups()[1:])), text)


def setup(app: Any) -> dict[str, Any]:
    """Tell Sphinx when the parts are made."""

    def fill(_app: Any, _page: str, source: list[str]) -> None:
        source[0] = filled(source[0])

    app.connect("source-read", fill)
    app.connect("autodoc-process-docstring", docstrings.readable)
    return {"parallel_read_safe": True, "version": "1"}
