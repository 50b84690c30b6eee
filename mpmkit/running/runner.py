"""A whole run of a case, in memory or in a run directory, from the start or from a checkpoint."""

from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..case.model import Case
from ..case.plugins import plugins_of
from ..errors import CaseError, GuardStop, Interrupted, OutputError, Undrawn, reason
from ..kernels.environment import require_threads
from ..output import RunDirectory, open_log, write_json
from ..output.copies import Copies
from ..output.log import RECORD
from ..registry.blame import blaming_plugins
from ..solver.memory import require_memory
from ..solver.simulation import Simulation
from ..solver.stateful import State, restore
from .case_files import NamedFile, from_copies, named_files, portable
from .execution import Listener, Progress, execute
from .provenance import attributes, log_lines
from .recorder import Recorder
from .resume import case_of, for_longer, identity, last_checkpoint, other_case
from .saver import Saver, run_components
from .stopwatch import Stopwatch
from .threads import using_threads

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
    draw: bool = True,
) -> xarray.Dataset:
    """Run a case to its end.

    Args:
        case: a validated case.
        out: run directory to write; nothing is written without one.
        overwrite: whether an earlier run in ``out`` may be replaced.
        threads: threads to use; default: as many as are useful.
        listen: called with the progress a few times a second.
        checkpoint_every: wall time, s, between two checkpoints in ``out``, for ``resume``. A checkpoint is
        always written on Ctrl-C and before the last step.
        draw: whether the report is drawn at the end, if ``output.report`` asks for it; ``mpmkit report``
            can draw it later.

    Returns:
        The history, with dimensions ``(time)`` and ``(time, component)``, and ``(time, particle, …)`` for
        the fields named in ``output.particle_history``. Its attributes hold the numbers of the summary, such
        as ``t500``, s, and ``final_spread``, m; NaN for events that did not occur.

    Raises:
        CaseError: the case cannot be run as it stands.
        GuardStop: the run diverged, or a plug-in raised an exception; the results up to then are in the run
            directory.
        OutputError: the run directory cannot be written, or another run is writing it.
        MpmkitError: this process was forked from a process that had run a case.
    """
    require_threads()
    require_memory(case)
    files = [] if out is None else named_files(case)
    with blaming_plugins(plugins_of(case)):
        simulation = Simulation(case)
    with using_threads(threads, len(simulation.particles)) as used:
        if out is None:
            recorder = Recorder(simulation, attributes(case, used), None)
            execute(recorder, Stopwatch(), used, listen, None)
        else:
            directory = RunDirectory(Path(out), overwrite, keep={file.name for file in files})
            recorder = _run_in(directory, case, files, simulation, used, listen, checkpoint_every, draw)
    return recorder.history.dataset()


def _run_in(
    directory: RunDirectory,
    case: Case,
    files: list[NamedFile],
    simulation: Simulation,
    threads: int,
    listen: Listener | None,
    checkpoint_every: float | None,
    draw: bool,
) -> Recorder:
    # Read all files before anything is overwritten: they may be in the same directory.
    contents, data, itself = {file.name: file.content() for file in files}, portable(case), identity(case)
    with directory.claimed(), open_log(directory.log):
        try:
            Copies(directory.meshes).write(contents)
            write_json(directory.case, data)
            # The originals are not needed any more; they may even have been deleted.
            simulation.case = from_copies(case, files, directory.meshes)
            recorder = Recorder(simulation, _attributes(case, threads, data), directory)
        except OutputError as error:
            LOGGER.error("%s", error)
            raise
        watch = Stopwatch()
        _execute(recorder, threads, listen, watch, Saver(recorder, watch, checkpoint_every, itself), draw)
    return recorder


def resume(
    directory: str | Path,
    *,
    case: Case | None = None,
    until: float | None = None,
    threads: int | None = None,
    listen: Listener | None = None,
    checkpoint_every: float | None = None,
) -> xarray.Dataset:
    """Continue a run from its last checkpoint; the results are bit by bit those of a run without a stop.

    Args:
        directory: of the run.
        case: the case that the run must have; default: not checked.
        until: a later end, s, also of a run that has finished; default: that of the case. Rows and frames
            keep the intervals that they had.
        threads, listen, checkpoint_every: as for ``run``.

    Returns:
        The history of the whole run.

    Raises:
        CaseError: there is no checkpoint, it belongs to another case or to other versions, or ``until`` is
        too early.
        GuardStop, OutputError: as of ``run``.
    """
    require_threads()
    path = Path(directory)
    before = case_of(path)
    found = for_longer(before, until, path)
    if case is not None:
        same_end = case if until is None else case.model_copy(update={"until": before.until})
        if apart := other_case(portable(before), same_end):
            raise CaseError(f"the case is not that of the run in '{path}': {apart[0]}")
    require_memory(found)
    files = RunDirectory(path)
    with files.claimed(resume=True):
        state, identity_ = last_checkpoint(path, before, found)
        with open_log(files.log):
            with blaming_plugins(plugins_of(found)):
                simulation = Simulation(found)
            with using_threads(threads, len(simulation.particles)) as used:
                if found.until != before.until:
                    write_json(files.case, portable(found))
                said = _attributes(found, used, portable(found))
                recorder, watch = Recorder(simulation, said, files, goes_on=True), Stopwatch()
                _restore(recorder, watch, state, path)
                saver = Saver(recorder, watch, checkpoint_every, identity_)
                _execute(recorder, used, listen, watch, saver, draw=True)
    return recorder.history.dataset()


def _restore(recorder: Recorder, watch: Stopwatch, state: State, path: Path) -> None:
    try:
        restore(run_components(recorder, watch), state)
    except (KeyError, ValueError) as error:
        raise CaseError(
            f"the run in '{path}' cannot go on: its checkpoint does not fit this version of mpmkit "
            f"({reason(error)})"
        ) from None


def _attributes(case: Case, threads: int, data: dict[str, Any]) -> dict[str, str]:
    """The attributes of a history in a run directory, with the case as it is written there."""
    return attributes(case, threads) | {"case": json.dumps(data)}


def _execute(
    recorder: Recorder,
    threads: int,
    listen: Listener | None,
    watch: Stopwatch,
    saver: Saver,
    draw: bool,
) -> None:
    """Run to the end in a directory, and draw the report, even if a guard stopped the run.

    An interrupted run gets its page without the pictures: they take longer, and it may be continued.

    Raises:
        Undrawn: the run has finished, but the drawing of its pictures was interrupted.
    """
    for line in log_lines(recorder.simulation.case, threads):
        RECORD.info("%s", line)
    try:
        hurry = execute(recorder, watch, threads, listen, saver)
    except GuardStop:
        try:
            _report(recorder, draw)
        except Undrawn as undrawn:
            LOGGER.warning("%s", undrawn)
        raise
    except Interrupted:
        _page(recorder, draw)
        raise
    _report(recorder, draw, hurry)


def _report(recorder: Recorder, draw: bool, hurry: bool = False) -> None:
    """Draw the pictures. They can be drawn again later: a failure here must not make the run fail."""
    case, directory = recorder.simulation.case, recorder.directory
    if not draw or not case.output.report or directory is None:
        return
    try:
        if hurry:
            raise KeyboardInterrupt
        LOGGER.info("drawing the report")  # it takes a few seconds
        from ..report import write_report

        for path in write_report(directory.path):
            LOGGER.info("%s: %s", "page" if path.suffix == ".html" else "picture", path)
    except KeyboardInterrupt:
        raise Undrawn(
            f"the run has ended and its results are in '{directory.path}', but it was stopped before "
            f"all pictures were drawn; draw them with: mpmkit report {directory.path}"
        ) from None
    except Exception as error:
        LOGGER.warning("the report was not drawn: %s", reason(error), exc_info=True)


def _page(recorder: Recorder, draw: bool) -> None:
    """Write the page of an interrupted run; a second interrupt, or a failure, leaves it out."""
    case, directory = recorder.simulation.case, recorder.directory
    if not draw or not case.output.report or directory is None:
        return
    try:
        from ..report.page import write_page

        LOGGER.info("page: %s", write_page(directory.path))
    except KeyboardInterrupt:
        LOGGER.warning("the page was not written; write it with: mpmkit report %s", directory.path)
    except Exception as error:
        LOGGER.warning("the page was not written: %s", reason(error), exc_info=True)
