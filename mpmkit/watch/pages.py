"""The page of a run in progress: the page of its report, with a script that follows the run."""

from __future__ import annotations

import json
import threading
import time as clock
from html import escape
from importlib.resources import files

from ..errors import reason
from .so_far import NOTHING, SoFar

END = "</body>"
PREPARING = "The run is being prepared. The first run of a kind compiles its kernels: about 20 seconds."
PAUSE = 150
"""Least pause between two pages, as a multiple of the processor time of one page. So pages and requests
together use at most a hundredth of a core."""


class Pages:
    """Pages of one run; a new page is made on request, if the run has written more."""

    def __init__(self, so_far: SoFar) -> None:
        self._so_far = so_far
        self._lock = threading.Lock()
        self._made: tuple[str, str] | None = None
        self.ended = False
        """whether the run has ended; the last page is made without a pause"""
        self._warm = False
        """whether a page has been made before"""
        self._not_before = 0.0
        """time of the monotonic clock from which the next page may be made"""

    def prepare(self) -> None:
        """Import the modules that make a page, before the first request."""
        with self._lock:
            from ..report import page  # noqa: F401

    def version(self) -> str:
        """Version of the page that ``latest`` would return."""
        made = self._made  # without the lock: an answer must not wait for a page that is being made
        if made is not None and clock.monotonic() < self._not_before and not self.ended:
            return made[0]
        return self._so_far.version()

    def latest(self) -> tuple[str, str]:
        """Version and text of the page of what has been written so far."""
        with self._lock:
            version, now = self._so_far.version(), clock.monotonic()
            if self._made is None or (self._made[0] != version and (now >= self._not_before or self.ended)):
                spent = clock.process_time()
                self._made = self._make(version)
                if self._warm:  # the first page also pays for imports
                    self._not_before = clock.monotonic() + PAUSE * (clock.process_time() - spent)
                self._warm = self._made[0] != NOTHING
            return self._made

    def _make(self, version: str) -> tuple[str, str]:
        if version != NOTHING:
            from ..report.page import page_of

            try:
                return version, _following(page_of(self._so_far.run.path, live=True), version)
            except Exception as error:  # e.g. a file is just being replaced: a later request may succeed
                return NOTHING, self._waiting(f"Its page cannot be made yet: {reason(error)}.")
        return NOTHING, self._waiting(PREPARING)

    def _waiting(self, sentence: str) -> str:
        page = _static("waiting.html").replace("TITLE", escape(self._so_far.run.path.resolve().name))
        return _following(page.replace("SENTENCE", escape(sentence)), NOTHING)


def _following(page: str, version: str) -> str:
    """A page with the script that follows the run, after the page's own scripts."""
    before, end, behind = page.rpartition(END)
    script = _static("follow.js").replace("VERSION", json.dumps(version))
    return f"{before}<script>\n{script}</script>\n{end}{behind}"


def _static(name: str) -> str:
    return (files(__package__) / "static" / name).read_text(encoding="utf-8")
