"""Writes the checkpoints of a run, at intervals of wall time and on request."""

from __future__ import annotations

import logging
import time as clock
from typing import Any

from ..errors import OutputError, reason
from ..output.checkpoints import Checkpoints
from ..solver.stateful import Stateful, state_of
from .recorder import Recorder
from .stopwatch import Stopwatch

LOGGER = logging.getLogger("mpmkit")


def run_components(recorder: Recorder, watch: Stopwatch) -> dict[str, Stateful]:
    """All components of a run with a state, in the order in which they are restored."""
    return {"simulation": recorder.simulation, "recorder": recorder, "watch": watch}


class Saver:
    """The checkpoints of one run.

    Args:
        recorder: of the run; it has a directory.
        watch: its clock, which continues after a resume.
        every: wall time, s, between two checkpoints; None: only on request.
        identity: of the case, as in ``resume``.
    """

    def __init__(
        self, recorder: Recorder, watch: Stopwatch, every: float | None, identity: dict[str, Any]
    ) -> None:
        assert recorder.directory is not None
        self._recorder = recorder
        self._watch = watch
        self._every = every
        self._checkpoints = Checkpoints(recorder.directory.checkpoints)
        self._identity = identity
        self._last = clock.monotonic()

    def save_if_due(self) -> None:
        """Write a checkpoint if the last one is old enough; if that fails, the run continues."""
        if self._every is not None and clock.monotonic() - self._last >= self._every:
            self.save_if_possible()
            self._last = clock.monotonic()

    def save_if_possible(self) -> bool:
        """Write a checkpoint, or warn that it failed; the run continues in any case."""
        try:
            self.save()
        except (OutputError, MemoryError) as error:
            kept = "; the one before it stays" if self._checkpoints.paths() else ""
            LOGGER.warning(
                "no checkpoint at t = %.6g s: %s%s", self._recorder.simulation.time, reason(error), kept
            )
            return False
        return True

    def save(self) -> None:
        """Write a checkpoint of the present state.

        Raises:
            OutputError: where it cannot be written.
        """
        state = state_of(run_components(self._recorder, self._watch))
        self._checkpoints.write(self._recorder.simulation.steps, state, {"identity": self._identity})

    def keep_last(self) -> None:
        """Remove all checkpoints except the last, from which a finished run can be made longer."""
        self._checkpoints.keep_last()
