"""The end of a run, good or bad: its last state, its history and its summary."""

from __future__ import annotations

import logging

from ..errors import reason
from ..output import summarise, write_json
from ..solver.simulation import Simulation
from .provenance import plugins_used
from .recorder import Recorder

LOGGER = logging.getLogger("mpmkit")
FRACTURED = 0.05
"""Part of the volume drawn apart that is worth a warning."""


def conclude(recorder: Recorder, ended: str, wall_time: float) -> None:
    """Write everything that is known at the end of a run.

    Raises:
        OutputError: where it cannot be written.
    """
    recorder.history.attributes["stopped_because"] = ended
    recorder.finish()
    _summarise(recorder, ended, wall_time)
    _warn_of_fracture(recorder.simulation)


def salvage(recorder: Recorder, ended: str, wall_time: float) -> None:
    """Write what can be written of a run that ended badly; nothing of it hides why it did.

    Part by part: a plug-in that fails may fail again when its energies are asked for, and a summary may fit
    on a disk that has no room for the history.
    """
    recorder.history.attributes["stopped_because"] = ended
    for part in (recorder.add_last_row, recorder.add_last_frame, recorder.write):
        try:
            part()
        except Exception as error:
            LOGGER.warning("at the end of the run: %s", reason(error))
    try:
        _summarise(recorder, ended, wall_time)
    except Exception as error:
        LOGGER.warning("at the end of the run: %s", reason(error))


def _summarise(recorder: Recorder, ended: str, wall_time: float) -> None:
    simulation, directory = recorder.simulation, recorder.directory
    LOGGER.info("%s after %d steps, t = %.6g s", ended, simulation.steps, simulation.time)
    if directory is None:
        return
    summary = summarise(
        recorder.history.dataset(),
        particles=len(simulation.particles),
        particle_steps=simulation.particle_steps,
        steps=simulation.steps,
        wall_time=wall_time,
        stopped_because=ended,
        plugins=plugins_used(simulation.case),
    )
    write_json(directory.summary, summary)


def _warn_of_fracture(simulation: Simulation) -> None:
    fractured = simulation.measures.fractured(simulation.particles)
    if fractured > FRACTURED and not simulation.case.scheme.splitting:
        LOGGER.warning(
            "at the end %.0f %% of the volume is in particles that are drawn apart further than a cell "
            "(fractured_fraction): set scheme.splitting to true",
            100 * fractured,
        )
