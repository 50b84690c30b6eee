"""The time when the mould of a scene is lifted; a laboratory measures T500 from this time."""

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

    Such a wall is taken as the mould: nothing else moves in a slump test. Motion is detected by the largest
    speed that a surface reports, so that any surface can be the mould.

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

    None if the spread never reaches 500 mm, if no wall moves, or if the lift starts later.
    """
    if t500 is None or lifted is None or t500 < lifted:
        return None
    return t500 - lifted
