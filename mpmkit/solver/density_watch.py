"""Watches over the density of the interior of the material: what the program cannot hold, it says."""

from __future__ import annotations

from .density import Density, density
from .redistribution import redistributes
from .stateful import State, plain_state, restore_plain
from .view import SceneView

INTERVAL = 200
"""Steps between two looks: each takes about as long as a step."""
SPEAKS = 0.25
"""Part of the volume that the interior must hold to speak for the rest. In a sheet of two cells less is
inside, and what is left are a few nodes and their noise."""
NOTED = 0.05
"""Departure, mean over the interior, that is worth a warning. Of what was measured (docs/theory.md), all that
is right stays below 0.047; a film that loses its speed comes to 0.05 while that is still right to 1 %."""
BROKEN = 0.1
"""Departure that stops a run. That film has lost 8 % of its speed by then."""


class DensityWatch:
    """Looks at the density every so often, and remembers the worst.

    Attributes:
        most: largest departure so far, see ``Density``.
        since: time at which it was first worth a warning, s; not a number before.
    """

    def __init__(self) -> None:
        self.most = 0.0
        self.since = float("nan")
        self._next_look = 0

    def state(self) -> State:
        """All its numbers."""
        return plain_state(self)

    def restore(self, state: State) -> None:
        """Take its numbers back."""
        restore_plain(self, state)

    def look(self, scene: SceneView) -> Density | None:
        """The density, where a look is due and it departs so far that the run must stop; else None."""
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
        """Whether the density has departed so far that it is worth a warning."""
        return self.most > NOTED


def warning(scene: SceneView, watch: DensityWatch) -> str:
    """The sentence of what has been noted so far."""
    return (
        f"inside the material the density is wrong by up to {100 * watch.most:.2g} % on average, since "
        f"t = {watch.since:.4g} s (history: density_mean, density_worst): positions and volumes "
        f"of the particles contradict each other, so flow and height become wrong; {cure(scene)}"
    )


def cure(scene: SceneView) -> str:
    """What keeps the particles of a scene even, in words."""
    fluid = any(group.law.uses_equation_of_state for group in scene.particles.groups)
    if fluid and not redistributes(scene.case.scheme.redistribution):
        return "scheme.redistribution 'even' keeps them consistent"
    return "smaller cells or more particles_per_cell may keep them consistent"
