"""A whole run: a case to its end, in memory or in a run directory, from the start or from a checkpoint."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING

from .blame import blaming_plugins
from .case.model import Case
from .errors import CaseError, GuardStop, OutputError, reason
from .execution import Listener, Progress, execute
from .memory import require_memory
from .output import RunDirectory, open_log, write_json
from .provenance import attributes, resolved
from .recorder import Recorder
from .resume import case_of, differences, last_checkpoint
from .saver import Saver
from .solver.simulation import Simulation
from .solver.state import restore
from .stopwatch import Stopwatch
from .threads import use_threads

if TYPE_CHECKING:
    import xarray

__all__ = ["Listener", "Progress", "resume", "run"]

LOGGER = logging.getLogger("mpmkit")


def run(
    case: Case,
    out: str | Path | None = None,
    *,
    overwrite: bool = False,
    threads: int | None = None,
    listen: Listener | None = None,
    checkpoint_every: float | None = None,
) -> xarray.Dataset:
    """Run a case to its end.

    Args:
        case: a validated case.
        out: run directory to write; nothing is written without one.
        overwrite: whether an earlier run in ``out`` may be replaced.
        threads: threads to use; as many as pay off unless told.
        listen: told of the progress a few times a second.
        checkpoint_every: wall time, s, between two checkpoints in ``out``, from which ``resume`` goes on; one
            is written on Ctrl-C in any case.

    Returns:
        The history, with dimensions ``(time)`` and ``(time, component)``, and ``(time, particle, …)`` for
        the fields named in ``output.particle_history``.

    Raises:
        CaseError: the case cannot be run as it stands.
        GuardStop: the run diverged, or a plug-in raised an exception; everything up to then is in the run
            directory.
        OutputError: the run directory cannot be written, or another run is writing it.
    """
    require_memory(case)
    with blaming_plugins(case):
        simulation = Simulation(case)
    threads = use_threads(threads, len(simulation.particles))
    watch = Stopwatch()
    if out is None:
        recorder = Recorder(simulation, attributes(case, threads), None)
        execute(recorder, watch, threads, listen, None)
        return recorder.history.dataset()
    directory = RunDirectory(Path(out), overwrite)
    with directory.claimed(), open_log(directory.log):
        try:
            write_json(directory.case, resolved(case))
            recorder = Recorder(simulation, attributes(case, threads), directory)
        except OutputError as error:
            LOGGER.error("%s", error)
            raise
        _execute(recorder, watch, threads, listen, checkpoint_every)
    return recorder.history.dataset()


def resume(
    directory: str | Path,
    *,
    case: Case | None = None,
    threads: int | None = None,
    listen: Listener | None = None,
    checkpoint_every: float | None = None,
) -> xarray.Dataset:
    """Go on with a run from its last checkpoint; it ends with the bits that it would have had without a stop.

    Args:
        directory: of the run.
        case: what the caller takes the case to be; that of the directory unless told.
        threads, listen, checkpoint_every: as for ``run``.

    Returns:
        The history of the whole run.

    Raises:
        CaseError: there is no checkpoint, or it is of another case, or of other versions of what runs it.
        GuardStop, OutputError: as of ``run``.
    """
    path = Path(directory)
    found = case_of(path)
    if case is not None and (apart := differences(resolved(found), resolved(case))):
        raise CaseError(f"the case is not that of the run in '{path}': {apart[0]}")
    require_memory(found)
    with RunDirectory(path).claimed(resume=True):
        arrays, words = last_checkpoint(path, found)
        with open_log(RunDirectory(path).log):
            with blaming_plugins(found):
                simulation = Simulation(found)
            restore(simulation, arrays)
            threads = use_threads(threads, len(simulation.particles))
            said = attributes(found, threads)
            recorder = Recorder(simulation, said, RunDirectory(path), words["frames"])
            recorder.restore(arrays, words)
            _execute(recorder, Stopwatch(words["wall_time"]), threads, listen, checkpoint_every)
    return recorder.history.dataset()


def _execute(
    recorder: Recorder, watch: Stopwatch, threads: int, listen: Listener | None, every: float | None
) -> None:
    """Run to the end in a directory, and draw the pictures of it even if a guard stopped it."""
    try:
        execute(recorder, watch, threads, listen, Saver(recorder, watch, every))
    except GuardStop:
        _report(recorder)
        raise
    _report(recorder)


def _report(recorder: Recorder) -> None:
    """Draw the pictures. They can be drawn again from the directory: none is worth the outcome of a run."""
    case, directory = recorder.simulation.case, recorder.directory
    if not case.output.report or directory is None:
        return
    try:
        from .report import write_report

        write_report(directory.path)
    except Exception as error:
        LOGGER.warning("the report was not drawn: %s", reason(error), exc_info=True)
