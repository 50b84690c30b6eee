"""Names of files, made from their content."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

DIGITS = 32
"""Hexadecimal digits of the SHA-256, 128 bits: two files never have the same name by accident."""


def name_by_content(content: bytes, suffix: str) -> str:
    """The first digits of the SHA-256 of a file, and its suffix."""
    return hashlib.sha256(content).hexdigest()[:DIGITS] + suffix


def is_name_by_content(name: str) -> bool:
    """Whether a name may be one of ``name_by_content``."""
    return re.fullmatch(rf"[0-9a-f]{{{DIGITS}}}", Path(name).stem) is not None
