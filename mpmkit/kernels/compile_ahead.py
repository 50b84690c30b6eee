"""A process that compiles ahead of a run: ``python -m mpmkit.kernels.compile_ahead FOLDER``; see ``ahead``.

It ends when its standard input closes. The process that started it keeps this open.
"""

from __future__ import annotations

import json
import os
import sys
import threading
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from .ahead import NEEDS, claim, claim_of
from .code_cache import KeptCode
from .needs import Need


def compile_all(needs: Iterable[Need], claims: Path) -> None:
    """Compile what is needed into the cache, except what is there or claimed by another process.

    A function that cannot be compiled is skipped: the run will meet the same error and report it.
    """
    for need in needs:
        with suppress(Exception):
            function, signature = need.function(), need.signature()
            kept = function._cache  # type: ignore[attr-defined]
            assert isinstance(kept, KeptCode)
            code = kept.path(signature, function.targetctx)
            if code.exists() or not claim(claims, code):
                continue
            try:
                function.compile(signature)
            finally:
                claim_of(claims, code).unlink(missing_ok=True)


def main() -> None:
    threading.Thread(target=_end_with_input, daemon=True).start()
    claims = Path(sys.argv[1])
    listed = json.loads((claims / NEEDS).read_text(encoding="utf-8"))
    compile_all([Need(**need) for need in listed], claims)


def _end_with_input() -> None:
    sys.stdin.read()
    os._exit(0)


if __name__ == "__main__":
    main()
