"""The files in which the tests kept what they measured."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

Sheet = dict[str, Any]


def load(folder: Path) -> list[Sheet]:
    """All sheets, in the order in which the tests are written."""
    found = [json.loads(path.read_text(encoding="utf-8")) for path in folder.glob("*.json")]
    return sorted(found, key=_place)


def _place(sheet: Sheet) -> tuple:
    return sheet["section"], sheet["test"].split("::")[0], sheet["line"], sheet["began"]


def clear(folder: Path) -> None:
    """Forget an earlier run."""
    for pattern in ("*.json", "*.partial"):
        for path in folder.glob(pattern):
            path.unlink()
