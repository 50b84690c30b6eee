"""``python -m mpmkit.watch DIR [--resumed]``: serve the page of a run until the standard input ends.

``mpmkit run --watch`` starts it. It prints the address of the page, and nothing else.
"""

from __future__ import annotations

import os
import sys
import threading
from contextlib import suppress
from pathlib import Path

from .server import Server


def main() -> None:
    """Serve until the parent process closes the pipe; the system closes it if the parent dies."""
    with suppress(OSError, AttributeError):
        os.nice(2)  # below the run; a lower priority gives no answers on a busy machine
    server = Server(Path(sys.argv[1]), resumed="--resumed" in sys.argv[2:])
    print(server.address, flush=True)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    threading.Thread(target=server.pages.prepare, daemon=True).start()
    sys.stdin.read()
    server.end()
    os._exit(0)  # do not wait for an open request


main()
