"""The end of a run, good or bad: its last state, its history and its summary."""

from __future__ import annotations

import logging
from typing import Any

from ..case.ending import conditions, latest
from ..errors import reason
from ..output import summarise, write_json
from ..output.log import RECORD
from ..output.summary import FINISHED, lifted_later, numbers, state_at_end, trusted_to_the_end
from ..solver import density_watch
from ..solver.simulation import Simulation
from .lift import from_lift, lift_start
from .provenance import plugins_used
from .recorder import Recorder

LOGGER = logging.getLogger("mpmkit")
FRACTURED = 0.05
"""Part of the volume in stretched particles that gives a warning."""
CREATED = 0.02
"""Created energy of solids, relative to the available energy, above which a warning is given."""


def conclude(recorder: Recorder, ended: str, wall_time: float) -> None:
    """Write the final results of a run.

    Raises:
        OutputError: where it cannot be written.
    """
    recorder.add_last_row()
    recorder.add_last_frame()
    recorder.add_last_moment()
    summary = _summary(recorder, ended, wall_time)
    recorder.write()
    _write_summary(recorder, summary)
    _warn_of_fracture(recorder.simulation)
    _warn_of_energy(recorder.simulation)
    _warn_of_density(recorder.simulation)


def salvage(recorder: Recorder, ended: str, wall_time: float) -> None:
    """Write the available results of a failed run; errors here do not hide the cause of the failure.

    Each part is written separately: a failed plug-in may fail again when its energies are computed, and a
    summary may fit on a disk that is too full for the history.
    """
    summary: dict[str, Any] = {}
    for part in (
        recorder.add_last_row,
        recorder.add_last_frame,
        recorder.add_last_moment,
        lambda: summary.update(_summary(recorder, ended, wall_time)),
        recorder.write,
        lambda: _write_summary(recorder, summary),
    ):
        try:
            part()
        except Exception as error:
            LOGGER.warning("at the end of the run: %s", reason(error))


def _summary(recorder: Recorder, ended: str, wall_time: float) -> dict[str, Any]:
    """The summary of a run; its numbers become attributes of the history."""
    simulation, milestones, attributes = recorder.simulation, recorder.milestones, recorder.history.attributes
    attributes["stopped_because"] = ended
    trusted = trusted_to_the_end(ended)
    if trusted:
        milestones.finish()
    t500 = milestones.t500(trusted)
    summary = summarise(
        recorder.history.dataset(),
        t500=t500,
        t500_from_lift=from_lift(t500, lift_start(simulation.case)),
        at_rest_since=milestones.at_rest_since,
        spread_rate=milestones.spreading,
        particles=len(simulation.particles),
        particle_steps=simulation.particle_steps,
        steps=simulation.steps,
        wall_time=wall_time,
        stopped_because=ended,
        ended_by=recorder.ending.why or None,
        plugins=plugins_used(simulation.case),
        measured={name: measurement.unit for name, measurement in simulation.case.measurements.items()},
    )
    attributes |= numbers(summary)
    said = [sentence for sentence in (summary["ended_by"], state_at_end(summary)) if sentence is not None]
    LOGGER.info(
        "%s after %d steps, t = %.6g s%s",
        ended, simulation.steps, simulation.time, "".join(f"; {sentence}" for sentence in said),
    )  # fmt: skip
    until = simulation.case.until
    if ended == FINISHED and conditions(until):
        LOGGER.warning(
            "the run has reached until.at_most, %g s, before %s",
            latest(until), " or ".join(conditions(until)),
        )  # fmt: skip
    found = [
        f"{name} = {summary[name]:.6g} {unit}".removesuffix(" 1")
        for name, unit in summary["units"].items()
        if summary[name] is not None and (name != "t500_from_lift" or lifted_later(summary))
    ]
    RECORD.info("results: %s", ", ".join(found))
    return summary


def _write_summary(recorder: Recorder, summary: dict[str, Any]) -> None:
    if recorder.directory is not None and summary:
        write_json(recorder.directory.summary, summary)


def _warn_of_fracture(simulation: Simulation) -> None:
    fractured = simulation.measures.fractured(simulation.particles)
    if fractured > FRACTURED and not simulation.refiner.acts:
        LOGGER.warning(
            "at the end %.0f %% of the volume is in particles that are more than a cell apart "
            "(fractured_fraction): set scheme.refinement to 'split-and-merge'",
            100 * fractured,
        )


def _warn_of_energy(simulation: Simulation) -> None:
    balance = simulation.guards.balance
    if balance is not None and balance.solid and balance.most_excess > CREATED:
        LOGGER.warning(
            "up to %.3g %% of energy was created: the motion of the solid is not more accurate than that; "
            "a shorter step creates less, and order 'usl' dissipates energy instead",
            100 * balance.most_excess,
        )


def _warn_of_density(simulation: Simulation) -> None:
    if simulation.guards.density.noted:
        LOGGER.warning("at the end: %s", density_watch.warning(simulation, simulation.guards.density))
