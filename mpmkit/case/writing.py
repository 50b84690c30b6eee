"""A case as a readable file: parts that fit on a line are written on one line."""

from __future__ import annotations

import json
from typing import Any

WIDTH = 110


def case_text(data: Any) -> str:
    """JSON of the content of a case file."""
    return _text(data, 0, 0) + "\n"


def _text(value: Any, indent: int, before: int) -> str:
    """JSON of a part, which begins after ``before`` characters of a line."""
    line = json.dumps(value, ensure_ascii=False, allow_nan=False)
    if not isinstance(value, dict | list) or not value or (indent > 0 and before + len(line) < WIDTH):
        return line
    inner, pad = indent + 2, " " * (indent + 2)
    if isinstance(value, dict):
        keys = {key: f"{json.dumps(key, ensure_ascii=False)}: " for key in value}
        parts = [pad + keys[k] + _text(v, inner, inner + len(keys[k])) for k, v in value.items()]
        ends = "{}"
    else:
        parts, ends = [pad + _text(part, inner, inner) for part in value], "[]"
    return ends[0] + "\n" + ",\n".join(parts) + "\n" + " " * indent + ends[1]
