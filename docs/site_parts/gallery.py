"""The gallery: a picture and a line for every case in ``cases/``."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

ROOT = Path(__file__).parents[2]


def pictures() -> dict[str, str]:
    """By name of a case, the path of its picture in ``docs/images``."""
    entries = json.loads((ROOT / "docs/gallery.json").read_text(encoding="utf-8"))
    return {name: entry.get("picture", f"gallery/{name}.png") for name, entry in entries.items()}


def page() -> str:
    """A section for each case, in the order of ``docs/gallery.json``."""
    entries = json.loads((ROOT / "docs/gallery.json").read_text(encoding="utf-8"))
    return "\n".join(_section(name, entries[name], picture) for name, picture in pictures().items())


def _section(name: str, entry: dict, picture: str) -> str:
    case = json.loads((ROOT / f"cases/{name}.json").read_text(encoding="utf-8"))
    laws = sorted({body["material"]["law"] for body in case["bodies"]})
    facts = f"{case['space']} · {', '.join(laws)} · cells of {1e3 * case['grid']['cell_size']:g} mm"
    made = ""
    if changes := entry.get("set"):
        options = " ".join(f"--set {shlex.quote(change)}" for change in changes)
        made = (
            f"\nThe picture is of a shorter or coarser run:\n\n    mpmkit run cases/{name}.json {options}\n"
        )
    return (
        f"## {name}\n\n{case['description']}.\n\n*{facts}*\n\n"
        f"    mpmkit run cases/{name}.json\n\n![{name}](images/{picture})\n{made}"
    )
