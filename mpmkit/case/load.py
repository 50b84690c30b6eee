"""Reading case files: strict JSON, overrides from the command line, and one sentence for what is wrong."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ..errors import CaseError
from ..registry import Registry, installed
from .messages import explain
from .model import Case, case_model
from .overrides import apply_overrides


def load_case(path: str | Path, overrides: Iterable[str] = (), registry: Registry | None = None) -> Case:
    """Read and validate a case file.

    Args:
        path: the JSON file; its stem names the case if the case has no name of its own.
        overrides: ``"path.to.key=value"``, applied before validation.
        registry: plug-ins to choose from; those installed unless told.

    Raises:
        CaseError: the file cannot be read, is not JSON, or is not a valid case.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise CaseError(f"case file '{path}' cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise CaseError(f"case file '{path}' is not a UTF-8 text file") from None
    data = read_json(text, str(path))
    if isinstance(data, dict):
        data.setdefault("name", path.stem)
    return parse_case(data, overrides, registry, source=str(path))


def parse_case(
    data: Any, overrides: Iterable[str] = (), registry: Registry | None = None, source: str = "case"
) -> Case:
    """Validate a case given as the content of a JSON file; see ``load_case``."""
    registry = registry or installed()
    if not isinstance(data, dict):
        raise CaseError(f"{source}: a case is a JSON object, not {json.dumps(data)[:60]}")
    data = apply_overrides(data, overrides)
    model = case_model(registry)
    try:
        return model.model_validate_json(json.dumps(data, allow_nan=False))
    except ValidationError as error:
        raise CaseError(f"{source}: {explain(error, data, model, registry)}") from None
    except (ValueError, RecursionError) as error:
        raise CaseError(f"{source}: {error}") from None


def read_json(text: str, source: str) -> Any:
    """Parse JSON that has no duplicate keys and no NaN or infinity."""

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        seen: dict[str, Any] = {}
        for key, value in pairs:
            if key in seen:
                raise CaseError(f"{source}: the key '{key}' stands twice in one object; keep one")
            seen[key] = value
        return seen

    def constant(name: str) -> float:
        raise CaseError(f"{source}: {name} is not a number that a case can have; every number must be finite")

    def number(digits: str) -> float:
        value = float(digits)
        return value if abs(value) != float("inf") else constant(digits)

    try:
        return json.loads(text, object_pairs_hook=unique, parse_constant=constant, parse_float=number)
    except json.JSONDecodeError as error:
        raise CaseError(
            f"{source} is not valid JSON: {error.msg} at line {error.lineno}, column {error.colno}"
        ) from None
    except (RecursionError, ValueError) as error:
        raise CaseError(f"{source} is not a usable JSON file: {error}") from None
