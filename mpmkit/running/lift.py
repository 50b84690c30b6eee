"""When the mould of a scene is lifted: T500 counts from there in a laboratory."""

from __future__ import annotations

from ..case.model import Case
from ..case.plugins import plugins_of
from ..registry import audit
from ..registry.blame import blaming_plugins

HALVINGS = 60
DIGITS = 12
"""So that the time does not depend on how long the run is."""


def lift_start(case: Case) -> float | None:
    """Time, s, at which a wall of a case begins to move, the first of those that do; None if none moves.

    Such a wall is taken for the mould: of a slump test nothing else moves. It is told by the fastest that a
    surface says it is, so that any surface can be the mould.

    Raises:
        PluginStop: a surface is at fault.
    """
    with blaming_plugins(plugins_of(case)):
        surfaces = [audit.placed(wall.surface, case.space_) for wall in case.walls.values()]

        def has_moved(time: float) -> bool:
            return any(surface.fastest(0.0, time) > 0 for surface in surfaces)

        if not has_moved(case.end):
            return None
        before, after = 0.0, 0.0 if has_moved(0.0) else case.end
        for _ in range(HALVINGS):
            middle = (before + after) / 2
            before, after = (before, middle) if has_moved(middle) else (middle, after)
        return float(f"{after:.{DIGITS}g}")


def from_lift(t500: float | None, lifted: float | None) -> float | None:
    """T500 as EN 12350-8 counts it, s: from the start of the lift.

    None where the spread never rises to 500 mm, where no wall moves, and where the lift starts later.
    """
    if t500 is None or lifted is None or t500 < lifted:
        return None
    return t500 - lifted
