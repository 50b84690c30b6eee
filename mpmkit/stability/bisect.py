"""The largest stable fraction of the critical step, by bisection."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ..case.model import Case
from ..errors import MpmkitError, PluginStop
from ..solver.simulation import Simulation
from ..solver.time_step import borne_by
from .judge import Criteria
from .trial import Trace, trace

FINE = 0.05
"""Fraction of the fine solution; also the smallest fraction that is tried."""
LARGEST = 2.0
"""Largest fraction that is tried by default; no explicit scheme is expected to be useful beyond it."""
CLOSE = 1.06
"""Ratio of the bracket's ends at which the search ends."""


@dataclass(frozen=True)
class Critical:
    """The result for a scheme."""

    fraction: float
    """largest fraction found stable, of the smallest limit that the case does not ignore"""
    unstable: float
    """smallest fraction found unstable; infinite if there is none"""
    broken: str
    """the criterion that this fraction violated"""
    limit: str
    """the limit that the fractions refer to"""
    declared: float
    """largest stable fraction that the schemes declare"""


def critical_fraction(
    case: Case,
    criteria: Criteria | None = None,
    largest: float = LARGEST,
    keep: Callable[[float, Trace], None] = lambda fraction, trial: None,
) -> Critical:
    """Bisect the time step of a case between ``FINE`` and ``largest`` of its limit.

    Args:
        case: the case.
        criteria: of an unstable run.
        largest: largest fraction that is tried.
        keep: called with the fraction and the records of each trial.

    Raises:
        CaseError: the case cannot be run.
        PluginStop: a plug-in is at fault, and the run has not diverged.
    """
    criteria = criteria or Criteria()
    simulation = Simulation(case, fraction=FINE)
    limit = simulation.limited_by
    declared = borne_by(case.scheme)[limit]
    fine = trace(case, FINE)
    keep(FINE, fine)
    if fine.stopped_by is not None:
        return Critical(0.0, FINE, "guard", limit, declared)
    low, high, broken = FINE, math.inf, ""
    tried = largest
    while high / low > CLOSE:
        try:
            trial = trace(case, tried)
            keep(tried, trial)
            found = criteria.broken(case, trial, fine)
        except PluginStop:
            raise
        except MpmkitError:
            found = "guard"
        if found is None:
            low = tried
            if tried == largest:
                break
        else:
            high, broken = tried, found
        tried = math.sqrt(low * high) if math.isfinite(high) else largest
    return Critical(low, high, broken, limit, declared)
