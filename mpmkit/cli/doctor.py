"""``mpmkit doctor``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import options
from .command import with_examples
from .printing import echo, echo_json

if TYPE_CHECKING:
    from ..doctor import Finding


@with_examples("doctor", "mpmkit doctor", "mpmkit doctor --json")
@options.as_json
def command(as_json: bool) -> None:
    """Describe this installation and this machine, for a bug report.

    The output has versions, processor, threads, caches of compiled code, memory, disk and plug-ins, and a
    sentence for each problem. The exit status is 0 also if there are problems.
    """
    from ..doctor import examine

    found = examine()
    if as_json:
        facts = {name: finding.facts for name, finding in found.items()}
        echo_json(facts | {"problems": _problems(found)})
    else:
        echo("\n".join(_lines(found)))


def _problems(found: dict[str, Finding]) -> list[str]:
    return [problem for finding in found.values() for problem in finding.problems]


def _lines(found: dict[str, Finding]) -> list[str]:
    lines = []
    for name, finding in found.items():
        width = max(map(len, finding.facts), default=0)
        lines += [name, *(f"  {key:{width}}  {value}" for key, value in finding.facts.items())]
    problems = _problems(found)
    return [*lines, "problems", *(f"  {problem}" for problem in problems or ["none found"])]
