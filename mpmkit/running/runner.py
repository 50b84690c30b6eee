"""A whole run: a case to its end, in memory or in a run directory, from the start or from a checkpoint."""

from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..case.model import Case
from ..case.plugins import plugins_of
from ..errors import CaseError, GuardStop, OutputError, reason
from ..output import RunDirectory, open_log, write_json
from ..output.copies import Copies
from ..output.log import RECORD
from ..registry.blame import blaming_plugins
from ..solver.memory import require_memory
from ..solver.simulation import Simulation
from ..solver.state import restore
from .case_files import from_copies, named_files, portable
from .execution import Listener, Progress, execute
from .provenance import attributes, log_lines
from .recorder import Recorder
from .resume import case_of, identity, last_checkpoint, other_case
from .saver import Saver
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
        the fields named in ``output.particle_history``. Its attributes hold the numbers of the summary, such
        as ``t500``, s, and ``final_spread``, m; what never happened is not a number there.

    Raises:
        CaseError: the case cannot be run as it stands.
        GuardStop: the run diverged, or a plug-in raised an exception; everything up to then is in the run
            directory.
        OutputError: the run directory cannot be written, or another run is writing it.
    """
    require_memory(case)
    files = [] if out is None else named_files(case)
    with blaming_plugins(plugins_of(case)):
        simulation = Simulation(case)
    threads = use_threads(threads, len(simulation.particles))
    watch = Stopwatch()
    if out is None:
        recorder = Recorder(simulation, attributes(case, threads), None)
        execute(recorder, watch, threads, listen, None)
        return recorder.history.dataset()
    # What is read is read before anything is overwritten: it may lie in that very directory.
    contents, data, itself = {file.name: file.content() for file in files}, portable(case), identity(case)
    directory = RunDirectory(Path(out), overwrite, keep=contents)
    with directory.claimed(), open_log(directory.log):
        try:
            Copies(directory.meshes).write(contents)
            write_json(directory.case, data)
            # The originals, which may even have been cleared away, are not needed any more.
            simulation.case = from_copies(case, files, directory.meshes)
            recorder = Recorder(simulation, _attributes(case, threads, data), directory)
        except OutputError as error:
            LOGGER.error("%s", error)
            raise
        _execute(recorder, threads, listen, watch, Saver(recorder, watch, checkpoint_every, itself))
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
    if case is not None and (apart := other_case(portable(found), case)):
        raise CaseError(f"the case is not that of the run in '{path}': {apart[0]}")
    require_memory(found)
    with RunDirectory(path).claimed(resume=True):
        arrays, words = last_checkpoint(path, found)
        with open_log(RunDirectory(path).log):
            with blaming_plugins(plugins_of(found)):
                simulation = Simulation(found)
            restore(simulation, arrays)
            threads = use_threads(threads, len(simulation.particles))
            said = _attributes(found, threads, portable(found))
            recorder = Recorder(simulation, said, RunDirectory(path), words["frames"])
            recorder.restore(arrays, words)
            watch = Stopwatch(words["wall_time"])
            saver = Saver(recorder, watch, checkpoint_every, words["identity"])
            _execute(recorder, threads, listen, watch, saver)
    return recorder.history.dataset()


def _attributes(case: Case, threads: int, data: dict[str, Any]) -> dict[str, str]:
    """Those of a history in a run directory, with the case as it stands there."""
    return attributes(case, threads) | {"case": json.dumps(data)}


def _execute(
    recorder: Recorder, threads: int, listen: Listener | None, watch: Stopwatch, saver: Saver
) -> None:
    """Run to the end in a directory, and draw the pictures of it even if a guard stopped it."""
    for line in log_lines(recorder.simulation.case, threads):
        RECORD.info("%s", line)
    try:
        execute(recorder, watch, threads, listen, saver)
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
        LOGGER.info("drawing the report")  # it takes a few seconds
        from ..report import write_report

        for picture in write_report(directory.path):
            LOGGER.info("picture: %s", picture)
    except Exception as error:
        LOGGER.warning("the report was not drawn: %s", reason(error), exc_info=True)
