"""Reading study files, with the same checks as for case files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..case.load import count_from, name_from, read_json, validated
from .model import Study


def load_study(path: str | Path) -> Study:
    """Read and validate a study file; relative paths start from the folder of this file.

    Raises:
        CaseError: the study cannot be read or is not valid.
    """
    data = read_json(path, "study")
    if isinstance(data, dict):
        data.setdefault("name", name_from(path))
        if isinstance(data.get("case"), str):
            data["case"] = str(Path(path).parent / data["case"])
        elif isinstance(data.get("case"), dict):
            count_from(Path(path).parent, data["case"])
    return parse_study(data, source=str(path))


def parse_study(data: Any, source: str = "study") -> Study:
    """Validate a study given as the content of a JSON file; see ``load_study``."""
    return validated(Study, data, source, "study")
