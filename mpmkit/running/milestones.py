"""Events of a run and their times: the spread reaches 500 mm, the material comes to rest.

Both are checked in the steps and do not depend on the rows of the history, so that a run with fewer rows
finds the same numbers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..kernels.sums import kinetics
from ..output.summary import T500_DIAMETER
from ..solver.simulation import CONTROL_INTERVAL, Simulation

LOOKS = CONTROL_INTERVAL
"""Steps between two checks. Near the diameter of T500 every step is checked; a check in every step of the
whole run would take 3 % of its time."""
AHEAD = 4.0
"""Every step is checked if, at its present rate, the spread reaches 500 mm within this many checks."""
SLOW = 1e-2
"""RMS speed at rest, as a part of the largest RMS speed so far: a 10,000th of the kinetic energy."""
STILL = 2e-3
"""Change of a length at rest, within h / (largest RMS speed): of the spread diameter as a part of h, a 1000th
for each of its two edges; of the centre of mass as a part of the present height."""
SMOOTHING = 0.02
"""Time over which the rate of the spread is averaged, in units of h / (largest RMS speed)."""


@dataclass
class _Seen:
    """The results of the checks so far, as numbers for a checkpoint."""

    time: float = math.nan
    """of the last step at which the spread was measured, s"""
    spread: float = math.nan
    """the spread diameter then, m"""
    close: float = 0.0
    """1 if every step must be checked"""
    t500: float = math.nan
    t500_step: float = math.nan
    look_time: float = math.nan
    """time of the last check, s"""
    look_spread: float = math.nan
    fastest: float = 0.0
    """largest RMS speed so far, m/s"""
    rate: float = 0.0
    """rate of the spread diameter, m/s, averaged"""
    quiet_since: float = math.nan
    """time since which the material has been slow and kept its spread, s"""
    band_since: float = math.nan
    """time since which the lengths have been between the next two values, s"""
    band_low: np.ndarray = field(default_factory=lambda: np.zeros(0))
    band_high: np.ndarray = field(default_factory=lambda: np.zeros(0))


class Milestones:
    """Watches a simulation; ``watch`` is to be called before the first step and after each one.

    **T500** is the time at which the spread diameter first rises to 500 mm, linear between two steps. A body
    that is so wide at the start has none.

    **At rest** means that the material does not move or spread any more. U is the largest RMS speed of the
    particles so far, h the height of the bodies at the start, and d the height of the material now. The RMS
    speed must be at most ``SLOW`` U; in a time of h / U the spread diameter must change by at most ``STILL``
    h and the centre of mass by at most ``STILL`` d; and all this for at least h / U. Material is not at rest
    as long as a force changes. These scales come from the run itself, so that water and a stiff paste are
    judged in the same way. Small elastic oscillations of material at rest do not count as motion.

    The centre of mass tells what a spread cannot: material that fills a channel from end to end, and still
    levels. If its depths at the ends change by ∓a, linear in between, a layer of depth d and length L has its
    centre moved by a L/(6 d). So wherever L > 6 d, no depth changes by more than ``STILL`` d.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._seen = _Seen()

    def watch(self) -> None:
        """Check the present step, if a check is due."""
        due = self._simulation.steps % LOOKS == 0
        if due or self._seen.close:
            self._watch_spread()
        if due:
            self._look()

    def finish(self) -> None:
        """Check the last step."""
        if self._simulation.steps % LOOKS:
            self._watch_spread()
            self._look()

    def t500(self, trusted: bool = True) -> float | None:
        """T500, s; None if the spread never reached 500 mm.

        If a guard stopped the run (not ``trusted``), it counts only up to the last step that passed the
        checks of the guards.
        """
        last_passed = (self._simulation.steps - 1) // CONTROL_INTERVAL * CONTROL_INTERVAL
        if math.isnan(self._seen.t500) or not (trusted or self._seen.t500_step <= last_passed):
            return None
        return self._seen.t500

    @property
    def at_rest_since(self) -> float | None:
        """Time since which the material has been at rest, s; None while it moves."""
        seen = self._seen
        lasted = seen.look_time - seen.quiet_since
        return seen.quiet_since if lasted * seen.fastest >= self._simulation.case.height else None

    @property
    def spreading(self) -> float | None:
        """Present growth rate of the spread diameter, m/s; None if there is no spread."""
        return None if math.isnan(self._seen.look_spread) else self._seen.rate

    def state(self) -> dict[str, np.ndarray]:
        """The results so far, for a checkpoint."""
        return {name: np.array(value) for name, value in vars(self._seen).items()}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore the results so far."""
        found: dict[str, Any] = {name: v.copy() if v.ndim else float(v) for name, v in state.items()}
        self._seen = _Seen(**found)

    def _watch_spread(self) -> None:
        simulation, seen = self._simulation, self._seen
        time, spread = simulation.time, simulation.measures.spread(simulation.particles)
        if math.isnan(seen.t500) and seen.spread < T500_DIAMETER <= spread:
            part = (T500_DIAMETER - seen.spread) / (spread - seen.spread)
            seen.t500 = seen.time + part * (time - seen.time)
            seen.t500_step = simulation.steps
            seen.close = 0.0
        seen.time, seen.spread = time, spread

    def _look(self) -> None:
        simulation, seen = self._simulation, self._seen
        p = simulation.particles
        mass, doubled, _ = kinetics(p.mass, p.velocity)
        speed = math.sqrt(doubled / mass) if mass else 0.0
        seen.fastest = max(seen.fastest, speed)
        passed, grown = seen.time - seen.look_time, seen.spread - seen.look_spread
        if passed > 0 and math.isfinite(grown):
            new = -math.expm1(-passed * seen.fastest / (SMOOTHING * simulation.case.height))
            seen.rate += new * (grown / passed - seen.rate)
            below = seen.spread < T500_DIAMETER <= seen.spread + AHEAD * grown
            seen.close = float(below and math.isnan(seen.t500))
        seen.look_time, seen.look_spread = seen.time, seen.spread
        keeps = self._keeps_its_lengths()
        if speed > SLOW * seen.fastest or not keeps or not simulation.settled:
            seen.quiet_since = math.nan
        elif math.isnan(seen.quiet_since):
            seen.quiet_since = seen.time

    def _keeps_its_lengths(self) -> bool:
        """Whether the lengths are still in their band, or have left it slowly; then a new band begins."""
        seen, simulation = self._seen, self._simulation
        height, p = simulation.case.height, simulation.particles
        if not len(p):
            return False
        lengths = np.nan_to_num([seen.spread, *centre_of_mass(simulation)])  # no spread along a periodic axis
        if not len(seen.band_low):
            seen.band_since, seen.band_low, seen.band_high = seen.time, lengths, lengths
        seen.band_low, seen.band_high = (
            np.minimum(seen.band_low, lengths),
            np.maximum(seen.band_high, lengths),
        )
        allowed = np.full(len(lengths), STILL * simulation.measures.height(p))
        allowed[0] = STILL * height
        if not (seen.band_high - seen.band_low > allowed).any():
            return True
        slowly = (seen.time - seen.band_since) * seen.fastest >= height
        seen.band_since, seen.band_low, seen.band_high = seen.time, lengths, lengths
        return slowly


def centre_of_mass(simulation: Simulation) -> np.ndarray:
    """The centre of mass along the axes that are neither periodic nor radial, m."""
    p, along = simulation.particles, simulation.grid.periodic.copy()
    along[0] |= simulation.case.space_.radial  # the centre is on the axis
    return ((p.mass[:, None] * p.position).sum(axis=0) / p.mass.sum())[~along]
