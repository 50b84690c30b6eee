"""The command line. Each command is one small file; ``main`` sets the exit status."""

from __future__ import annotations

import sys
from collections.abc import Sequence

INTERRUPTED = 130


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of ``mpmkit`` and ``python -m mpmkit``; ends the process with the exit status.

    Args:
        arguments: default: those of the process.
    """
    try:
        from .commands import execute  # inside try: Ctrl-C may come while these are loaded
        from .printing import replace_unknown_characters

        replace_unknown_characters()
        status = execute(arguments)
    except KeyboardInterrupt as stop:
        print(f"mpmkit: {' '.join(str(stop).split()) or 'interrupted'}", file=sys.stderr)
        status = INTERRUPTED
    sys.exit(status)
