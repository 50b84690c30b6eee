"""Reading case files: strict JSON, overrides from the command line, and one sentence for an error."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from ..errors import CaseError
from ..registry import Registry, installed
from ..registry.blame import blaming_plugins
from .allowed import shown
from .composed import case_model
from .json_mistakes import mistake
from .messages import explain
from .model import Case
from .near_files import near_file
from .overrides import apply_overrides
from .parameters import expand, refuse_unused
from .strict_json import NESTED, decode, require_finite

LARGEST = 100_000_000
"""Most characters of a file that are read: a device such as /dev/zero has no end."""
M = TypeVar("M", bound=BaseModel)


def load_case(path: str | Path, overrides: Iterable[str] = (), registry: Registry | None = None) -> Case:
    """Read and validate a case file.

    Args:
        path: the JSON file; its stem names the case if the case has no name of its own. A relative path of a
            mesh in it starts from the folder of the file.
        overrides: ``"path.to.key=value"``, applied before validation; a relative path of a mesh in one starts
            from the working directory, as on any command line.
        registry: plug-ins to choose from; default: those installed.

    Raises:
        CaseError: the file cannot be read, is not JSON, or is not a valid case.
        PluginStop: a plug-in that the case uses fails while it is validated.
    """
    registry = registry or installed()
    return parse_case(read_case(path, registry), overrides, registry, source=str(path))


def parse_case(
    data: Any, overrides: Iterable[str] = (), registry: Registry | None = None, source: str = "case"
) -> Case:
    """Validate a case given as the content of a JSON file; see ``load_case``.

    A relative path of a mesh starts from the working directory.
    """
    registry = registry or installed()
    if not isinstance(data, dict):
        raise CaseError(f"{source}: a case must be a JSON object, not {shown(data)}")
    model = case_model(registry)
    try:
        require_finite(data)  # for Python objects; numbers of a file are already checked
        refuse_unused(data, source)
        data = expand(apply_overrides(data, overrides), source)
        data.pop("$schema", None)  # for editors; it is not part of the scene
        text = json.dumps(data, allow_nan=False)
        with blaming_plugins(registry.all()):
            return model.model_validate_json(text)
    except ValidationError as error:
        raise CaseError(f"{source}: {explain(error, data, model, registry)}") from None
    except RecursionError:
        raise CaseError(f"{source}: {NESTED}") from None
    except (TypeError, ValueError) as error:  # of json.dumps, for Python objects that JSON cannot represent
        raise CaseError(f"{source}: {error}") from None


def validated(model: type[M], data: Any, source: str, what: str) -> M:
    """The content of a JSON file as a model other than a case, such as a study.

    Args:
        model: the class.
        data: the content.
        source: its name in messages.
        what: the kind of file in messages, such as "study".

    Raises:
        CaseError: it is not valid.
    """
    if not isinstance(data, dict):
        raise CaseError(f"{source}: a {what} must be a JSON object")
    data = {key: value for key, value in data.items() if key != "$schema"}
    try:
        require_finite(data)  # for Python objects; numbers of a file are already checked
        return model.model_validate_json(json.dumps(data, allow_nan=False))
    except ValidationError as error:
        raise CaseError(f"{source}: {explain(error, data, model, installed(), what)}") from None
    except RecursionError:
        raise CaseError(f"{source}: {NESTED}") from None
    except (TypeError, ValueError) as error:
        raise CaseError(f"{source}: {error}") from None


def read_case(path: str | Path, registry: Registry | None = None) -> dict[str, Any]:
    """The content of a case file before validation, with a name and absolute paths.

    Raises:
        CaseError: it cannot be read, see ``read_json``, or is not an object.
    """
    data = read_json(path)
    if not isinstance(data, dict):
        raise CaseError(f"{path}: a case must be a JSON object, not {shown(data)}")
    data.setdefault("name", name_from(path))
    count_from(Path(path).parent, data, registry)
    return data


def count_from(folder: Path, data: dict[str, Any], registry: Registry | None = None) -> None:
    """Make relative paths of files in a case absolute; other values are not changed."""
    shapes = (registry or installed()).of_kind("body_shape")
    bodies, walls = data.get("bodies"), data.get("walls")
    places = list(bodies) if isinstance(bodies, list) else []
    for wall in walls.values() if isinstance(walls, dict) else []:
        places.append(wall.get("surface") if isinstance(wall, dict) else None)
    for shape in (value for place in places if isinstance(place, dict) for value in place.values()):
        known = shapes.get(str(shape.get("kind"))) if isinstance(shape, dict) else None
        files: tuple[str, ...] = known.files if known else ()  # type: ignore[attr-defined]
        for field in files:
            if isinstance(shape.get(field), str):
                shape[field] = str(folder.absolute() / shape[field])


def read_json(path: str | Path, what: str = "case") -> Any:
    """The content of a JSON file, called ``what`` in the sentence about one that cannot be read.

    Raises:
        CaseError: it cannot be read, is too large, is not JSON, or has a key twice or a number that is not
            finite.
    """
    try:
        with Path(path).open(encoding="utf-8-sig") as file:  # some editors begin with a byte-order mark
            text = file.read(LARGEST + 1)
    except UnicodeDecodeError:
        raise CaseError(f"{path}: the {what} file is not a UTF-8 text file") from None
    except (OSError, ValueError) as error:  # ValueError: an impossible path
        reason = getattr(error, "strerror", None) or str(error)
        raise CaseError(
            f"{shown(str(path))}: the {what} file cannot be read: {reason}{_instead(path, error)}"
        ) from None
    if len(text) > LARGEST:
        raise CaseError(f"{path}: the {what} file has more than {LARGEST:,} characters; that is too large")
    if not text.strip():
        raise CaseError(f"{path}: the {what} file is empty; it must hold a JSON object")
    try:
        return decode(text)
    except json.JSONDecodeError as error:
        raise CaseError(f"{path}: the {what} file is not valid JSON: {mistake(text, error)}") from None
    except ValueError as error:
        raise CaseError(f"{path}: {error}") from None


def _instead(path: str | Path, error: Exception) -> str:
    """A hint what to read instead of a missing file or of a directory."""
    if isinstance(error, IsADirectoryError):
        inside = Path(path) / "case.json"
        return f"; the case of the run in it is '{inside}'" if inside.is_file() else ""
    near = near_file(path) if isinstance(error, FileNotFoundError) else None
    return "" if near is None else f"; did you mean '{near}'?"


def name_from(path: str | Path) -> str:
    """The stem of a file as the name of a case, which is more restricted than that of a file."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", Path(path).stem).strip("-._")[:100] or "case"
