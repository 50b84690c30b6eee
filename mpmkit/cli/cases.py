"""``mpmkit cases``."""

from __future__ import annotations

import re
import textwrap

from . import options
from .command import with_examples
from .duration import duration
from .printing import echo, echo_json

DAY = 86400.0
"""s"""
LONGEST = 100
"""Most characters of the description of a case."""


@with_examples("cases", "mpmkit cases", "mpmkit cases --json > cases.json")
@options.as_json
def command(as_json: bool) -> None:
    """List the shipped cases, and how long each takes on this machine, to within a factor of two."""
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
    for laboratory, title in ((True, "tests of the laboratory"), (False, "other cases")):
        echo(f"{title:<{width}}  {'time':>8}  {'fine':>8}")
        for row in rows:
            if row["laboratory"] == laboratory:
                times = (row["expected_seconds"], row["expected_seconds_fine"])
                columns = "  ".join(f"{_time(time):>8}" for time in times)
                echo(f"{row['name']:<{width}}  {columns}  {_first_sentence(row['description'])}")
        echo("")
    echo(
        "time and fine are the expected minutes:seconds on this machine, of the case and of its fine variant"
    )
    echo(
        "mpmkit init NAME writes one to a file of your own, with --fine its fine variant; "
        "mpmkit run FILE runs it"
    )


def _time(seconds: float | None) -> str:
    if seconds is None:
        return "–"
    return duration(max(1.0, seconds)) if seconds < DAY else f"{seconds / DAY:.1f} days"


def _first_sentence(text: str) -> str:
    first = re.split(r"(?<!\bal)\. ", text, maxsplit=1)[0]  # "et al. " does not end a sentence
    return textwrap.shorten(first.rstrip("."), LONGEST, placeholder=" …")
