"""How the scripts of the docs are called: each has a help, and refuses to write anything without its data."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parents[2]


def parser() -> argparse.ArgumentParser:
    """A parser whose help is the docstring of the script that was called."""
    return argparse.ArgumentParser(
        description=sys.modules["__main__"].__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )


def require(paths: Iterable[Path]) -> None:
    """End with status 2, before anything is written, if a file that a script reads is missing."""
    missing = [path for path in paths if not path.exists()]
    if missing:
        more = f", and {len(missing) - 1} more files" if len(missing) > 1 else ""
        print(
            f"{missing[0]} is missing{more}: nothing was written; --help says what makes it", file=sys.stderr
        )
        raise SystemExit(2)
