"""The page of a run at work: that of its report, with a script that follows the run."""

from __future__ import annotations

import json
import threading
import time as clock
from html import escape
from importlib.resources import files

from ..errors import reason
from .so_far import NOTHING, SoFar

END = "</body>"
PREPARING = "The run is being prepared. The first run of a kind compiles its kernels, about half a minute."
PAUSE = 150
"""Least pause between two pages, as a multiple of the processor time that one took: with what it costs to
ask for news, they take no more than a hundredth of a core from the run."""


class Pages:
    """Pages of one run; one is made when the run has written more, and somebody asks for it."""

    def __init__(self, so_far: SoFar) -> None:
        self._so_far = so_far
        self._lock = threading.Lock()
        self._made: tuple[str, str] | None = None
        self.ended = False
        """whether the run has ended: its last page does not wait"""
        self._warm = False
        """whether a page has been made before"""
        self._not_before = 0.0
        """when the next page may be made, by the monotonic clock"""

    def prepare(self) -> None:
        """Load what makes a page before somebody asks for one."""
        with self._lock:
            from ..report import page  # noqa: F401

    def version(self) -> str:
        """Of the page that ``latest`` would give."""
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
                if self._warm:  # the first page also loads what the others have there
                    self._not_before = clock.monotonic() + PAUSE * (clock.process_time() - spent)
                self._warm = self._made[0] != NOTHING
            return self._made

    def _make(self, version: str) -> tuple[str, str]:
        if version != NOTHING:
            from ..report.page import page_of

            try:
                return version, _following(page_of(self._so_far.run.path, live=True), version)
            except (
                Exception
            ) as error:  # a file that is being replaced, and whatever else: a later look may do
                return NOTHING, self._waiting(f"Its page cannot be made yet: {reason(error)}.")
        return NOTHING, self._waiting(PREPARING)

    def _waiting(self, sentence: str) -> str:
        page = _static("waiting.html").replace("TITLE", escape(self._so_far.run.path.resolve().name))
        return _following(page.replace("SENTENCE", escape(sentence)), NOTHING)


def _following(page: str, version: str) -> str:
    """A page with the script that follows the run, behind those of its own."""
    before, end, behind = page.rpartition(END)
    script = _static("follow.js").replace("VERSION", json.dumps(version))
    return f"{before}<script>\n{script}</script>\n{end}{behind}"


def _static(name: str) -> str:
    return (files(__package__) / "static" / name).read_text(encoding="utf-8")
