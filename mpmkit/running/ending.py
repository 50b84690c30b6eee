"""The early end of a run: the scene is at rest, or a variable of the history has reached its bound."""

from __future__ import annotations

import numpy as np

from ..case.ending import Until
from ..output.summary import AT_REST, CONDITION
from ..solver.simulation import Simulation
from ..solver.stateful import State, plain_state, restore_plain
from .measuring import momentary
from .milestones import LOOKS, Milestones, centre_of_mass

KEPT = 2e-4
"""Change of a length at rest, as a part of the height of the bodies at the start: 0.06 mm of 300 mm."""
PART = 0.25
"""Last part of the run so far in which lengths must not have changed."""


class Ending:
    """Checks every ``milestones.LOOKS`` steps whether the run must end; ``watch`` is called after each step.

    **At rest** a run ends where the material is at rest as ``Milestones`` says, and where, for the last
    quarter of the run so far, the spread diameter, the height and the centre of mass have each stayed
    within a band of ``KEPT`` h, with h the height of the bodies at the start. The band separates creep from
    rest: material that creeps at a constant rate leaves it, unless it needs four times the run so far to
    creep by 4 ``KEPT`` h. Small elastic oscillations stay in it, although their speed is not zero. The run
    does not end while a wall at rest will still move, a wall that holds the material will still vanish, or a
    force still changes.

    Attributes:
        ended: ``at-rest``, ``condition``, or an empty text as long as the run continues.
        why: the condition that was met, in words; else empty.
    """

    def __init__(self, simulation: Simulation, milestones: Milestones) -> None:
        self._simulation = simulation
        self._milestones = milestones
        until = simulation.case.until
        self._until = until if isinstance(until, Until) else None
        self.ended = self.why = ""
        self._since = simulation.time
        self._low = self._high = np.zeros(0)

    def state(self) -> State:
        """The band, and whether the run has ended."""
        return plain_state(self)

    def restore(self, state: State) -> None:
        """Restore them; a run that is made longer has not ended."""
        restore_plain(self, state)
        if self._until is None and not self._simulation.drains.emptied:
            self.ended = self.why = ""

    def watch(self) -> None:
        """Check the present step, if a check is due."""
        simulation = self._simulation
        if simulation.drains.emptied:
            self.ended, self.why = CONDITION, simulation.drains.emptied
        if self._until is None or self.ended or simulation.steps % LOOKS or not simulation.steps:
            return
        if self._until.rest and self._at_rest():
            self.ended = AT_REST
        values = momentary(simulation) if self._until.variables and not self.ended else {}
        for name, bounds in self._until.variables.items():
            if not self.ended and bounds.hold(float(values[name])):
                self.ended, self.why = CONDITION, f"{name} is {float(values[name]):.6g}, {bounds.words}"

    def _at_rest(self) -> bool:
        simulation, lengths = self._simulation, self._lengths()
        if not len(self._low):
            self._low = self._high = lengths
        self._low, self._high = np.minimum(self._low, lengths), np.maximum(self._high, lengths)
        moved = not (self._high - self._low <= KEPT * simulation.case.height).all()
        waits = self._a_wall_has_yet_to_move() or self._more_comes_in()
        if moved or waits or not simulation.settled:
            self._since, self._low, self._high = simulation.time, lengths, lengths
        kept = simulation.time - self._since >= PART * simulation.time
        return kept and self._milestones.at_rest_since is not None

    def _lengths(self) -> np.ndarray:
        """Spread diameter, height, and the centre of mass, m."""
        p, measures = self._simulation.particles, self._simulation.measures
        if not len(p):
            return np.zeros(0)
        lengths = [measures.spread(p), measures.height(p), *centre_of_mass(self._simulation)]
        return np.nan_to_num(lengths)  # no spread along a periodic axis

    def _more_comes_in(self) -> bool:
        return self._simulation.operations.sources.goes_on(self._simulation.time)

    def _a_wall_has_yet_to_move(self) -> bool:
        time, end = self._simulation.time, self._simulation.case.end
        return any(
            (wall.surface.fastest(time, time) == 0 and wall.surface.fastest(time, end) > 0)
            or (wall.touches > 0 and wall.surface.present(time) and not wall.surface.present(end))
            for wall in self._simulation.operations.walls.walls
        )
