"""A small server on the loopback interface: the page of a run, and its history so far as JSON."""

from __future__ import annotations

import json
import threading
import time as clock
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from .pages import Pages
from .so_far import SoFar

HOST = "127.0.0.1"
FOLLOWED = 6.0
"""A browser counts as watching if its last request is at most this many seconds old."""
FAREWELL = 4.0
"""Seconds that such a browser has to notice that the run has ended."""


class Server(ThreadingHTTPServer):
    """Serves the page of one run; other machines cannot reach it, and nothing can be written through it.

    Args:
        directory: of the run.
        resumed: whether the files in it belong to this run.
    """

    daemon_threads = True

    def __init__(self, directory: Path, resumed: bool) -> None:
        super().__init__((HOST, 0), _Handler)
        self.so_far = SoFar(directory, resumed)
        self.pages = Pages(self.so_far)
        self.ended = False
        self.asked = -FOLLOWED
        """time of the last request for the state of the run, by the monotonic clock"""
        self.told = threading.Event()
        """set when the run has ended"""

    @property
    def address(self) -> str:
        """Of the page."""
        return f"http://{HOST}:{self.server_address[1]}/"

    def end(self) -> None:
        """Tell a browser that is watching that the run has ended."""
        self.ended = self.pages.ended = True
        if clock.monotonic() - self.asked < FOLLOWED:
            self.told.wait(FAREWELL)

    def state(self) -> dict[str, Any]:
        """The state of the run, which a page requests every 1.5 seconds."""
        self.asked = clock.monotonic()
        return {
            "version": self.pages.version(),
            "ended": self.ended,
            "directory": str(self.so_far.run.path),
            "time": self.so_far.time(),
            "until": self.so_far.history()["until"],
        }


class _Handler(BaseHTTPRequestHandler):
    server: Server

    def do_GET(self) -> None:
        if not self._is_for_us():
            self.send_error(403, "This server answers requests to its own address only")
            return
        path = self.path.partition("?")[0]
        if path in ("/", "/page.html"):
            version, text = self.server.pages.latest()
            self._send("text/html", text, version)
        elif path == "/history.json":
            self._send("application/json", json.dumps(self.server.so_far.history()))
        elif path == "/state.json":
            state = self.server.state()
            self._send("application/json", json.dumps(state))
        elif path == "/farewell":  # a page has loaded the last state
            self._send("text/plain", "")
            if self.server.ended:
                self.server.told.set()
        else:
            self.send_error(404)

    def _is_for_us(self) -> bool:
        """Whether the request names this server's address; this blocks other web pages (DNS rebinding)."""
        port = self.server.server_address[1]
        return self.headers.get("Host") in (f"{HOST}:{port}", f"localhost:{port}")

    def _send(self, kind: str, text: str, version: str | None = None) -> None:
        content = text.encode("utf-8")
        self.send_response(200)
        self.send_header("Content-Type", f"{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Cache-Control", "no-store")
        if version is not None:
            self.send_header("X-Version", version)
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_: Any) -> None:
        """Print nothing: the terminal belongs to the run."""
