"""Writes the checkpoints of a run, every so many seconds and when asked to."""

from __future__ import annotations

import time as clock
from typing import Any

from ..output.checkpoints import Checkpoints
from ..solver.state import state_of
from .recorder import Recorder
from .stopwatch import Stopwatch


class Saver:
    """The checkpoints of one run.

    Args:
        recorder: of the run; it has a directory.
        watch: its clock, which goes on where it was.
        every: wall time, s, between two checkpoints; None for none but those asked for.
        identity: of the case, as ``mpmkit.resume`` has it.
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
        """Write a checkpoint if the last one is long enough ago."""
        if self._every is not None and clock.monotonic() - self._last >= self._every:
            self.save()
            self._last = clock.monotonic()

    def save(self) -> None:
        """Write a checkpoint of the present state.

        Raises:
            OutputError: where it cannot be written.
        """
        simulation = self._recorder.simulation
        arrays, words = self._recorder.state()
        words |= {"identity": self._identity, "wall_time": self._watch.elapsed}
        self._checkpoints.write(simulation.steps, state_of(simulation) | arrays, words)

    def remove(self) -> None:
        """Remove the checkpoints of a run that has finished."""
        self._checkpoints.remove()
