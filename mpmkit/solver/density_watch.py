"""Monitors the density of the interior of the material, and reports if it becomes wrong."""

from __future__ import annotations

from .density import Density, density
from .redistribution import redistributes
from .stateful import State, plain_state, restore_plain
from .view import SceneView

INTERVAL = 200
"""Steps between two checks; a check takes about as long as a step."""
SPEAKS = 0.25
"""Least part of the volume in the interior for a check. In a sheet of two cells, the interior is smaller:
only a few nodes with noise."""
NOTED = 0.05
"""Mean departure over the interior that gives a warning. In the measurements (docs/theory.md), correct flows
stay below 0.047; a film that loses speed reaches 0.05 while its speed is still right to 1 %."""
BROKEN = 0.1
"""Mean departure that stops a run. The film mentioned above has then lost 8 % of its speed."""


class DensityWatch:
    """Checks the density every few steps, and remembers the worst.

    Attributes:
        most: largest departure so far, see ``Density``.
        since: time of the first departure that gives a warning, s; NaN before.
    """

    def __init__(self) -> None:
        self.most = 0.0
        self.since = float("nan")
        self._next_look = 0

    def state(self) -> State:
        """The state: all numbers of this object."""
        return plain_state(self)

    def restore(self, state: State) -> None:
        """Restore the state."""
        restore_plain(self, state)

    def look(self, scene: SceneView) -> Density | None:
        """The density, if a check is due and the departure is so large that the run must stop; else None."""
        if scene.steps < self._next_look:
            return None
        self._next_look = scene.steps + INTERVAL
        found = density(scene.particles, scene.grid, scene.case.space_.radial)
        if not (found.part >= SPEAKS and found.departure > self.most):
            return None
        self.most = found.departure
        if self.noted and not self.since >= 0:
            self.since = scene.time
        return found if self.most > BROKEN else None

    @property
    def noted(self) -> bool:
        """Whether the departure of the density was large enough for a warning."""
        return self.most > NOTED


def warning(scene: SceneView, watch: DensityWatch) -> str:
    """The warning about the largest departure so far."""
    return (
        f"inside the material the density is wrong by up to {100 * watch.most:.2g} % on average, since "
        f"t = {watch.since:.4g} s (history: density_mean, density_worst): positions and volumes "
        f"of the particles contradict each other, so flow and height become wrong; {cure(scene)}"
    )


def cure(scene: SceneView) -> str:
    """The setting that keeps the particles evenly spaced, in words."""
    fluid = any(group.law.uses_equation_of_state for group in scene.particles.groups)
    if fluid and not redistributes(scene.case.scheme.redistribution):
        return "scheme.redistribution 'even' keeps them consistent"
    return "smaller cells or more particles_per_cell may keep them consistent"
