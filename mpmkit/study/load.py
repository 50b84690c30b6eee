"""Reading study files, with the same checks as for case files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ..case.load import count_from, name_from, read_json
from ..case.messages import explain
from ..errors import CaseError
from ..registry import installed
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
    if not isinstance(data, dict):
        raise CaseError(f"{source}: a study must be a JSON object")
    data = {key: value for key, value in data.items() if key != "$schema"}
    try:
        return Study.model_validate_json(json.dumps(data, allow_nan=False))
    except ValidationError as error:
        raise CaseError(f"{source}: {explain(error, data, Study, installed(), 'study')}") from None
    except (TypeError, ValueError, RecursionError) as error:
        raise CaseError(f"{source}: {error}") from None
