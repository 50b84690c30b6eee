"""``mpmkit cases``."""

from __future__ import annotations

import re
import shutil
import sys
import textwrap

from . import options
from .command import with_examples
from .duration import duration
from .printing import echo, echo_json

DAY = 86400.0
"""s"""
NO_WRAPPING = 10_000
"""Width of an output that is not a terminal: one line for each case, for other programs."""


@with_examples("cases", "mpmkit cases", "mpmkit cases --json > cases.json")
@options.as_json
def command(as_json: bool) -> None:
    """List the shipped cases, with the time that each takes on this machine, within a factor of two."""
    from ..case.load import read_json
    from ..case.shipped import LABORATORY, shipped
    from ..plan.shipped_times import shipped_seconds

    seconds = shipped_seconds()
    rows = [
        {
            "name": name,
            "laboratory": path.parent.name == LABORATORY,
            "description": read_json(path).get("description", ""),
            "expected_seconds": seconds.get((name, "coarse")),
            "expected_seconds_fine": seconds.get((name, "fine")),
            "file": str(path),
        }
        for name, path in shipped().items()
    ]
    if as_json:
        echo_json(rows)
        return
    width = max(len(row["name"]) for row in rows)
    wide = shutil.get_terminal_size().columns if _is_terminal() else NO_WRAPPING
    for laboratory, title in ((True, "tests of the laboratory"), (False, "other cases")):
        echo(f"{title:<{width}}  {'time':>8}  {'fine':>8}")
        for row in rows:
            if row["laboratory"] == laboratory:
                times = (row["expected_seconds"], row["expected_seconds_fine"])
                columns = "  ".join(f"{_time(time):>8}" for time in times)
                before = f"{row['name']:<{width}}  {columns}  "
                echo(_beside(before, _first_sentence(row["description"]), wide))
        echo("")
    echo(
        "time: expected time on this machine, in minutes:seconds; fine: that of the fine variant\n"
        "mpmkit init NAME writes a case to a file of your own, with --fine its fine variant\n"
        "mpmkit run FILE runs it"
    )


def _is_terminal() -> bool:
    return sys.stdout.isatty()


def _time(seconds: float | None) -> str:
    if seconds is None:
        return "–"
    return duration(max(1.0, seconds)) if seconds < DAY else f"{seconds / DAY:.1f} days"


def _first_sentence(text: str) -> str:
    return re.split(r"(?<!\bal)\. ", text, maxsplit=1)[0].rstrip(".")  # "et al. " does not end a sentence


def _beside(before: str, text: str, wide: int) -> str:
    """A text to the right of ``before``, in as many lines of ``wide`` characters as it needs. Names such as
    EN 12350-12 are not broken at their hyphens."""
    return textwrap.fill(
        text, wide, initial_indent=before, subsequent_indent=" " * len(before), break_on_hyphens=False
    )
