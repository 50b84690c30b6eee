"""Equations of state: they must not change arguments, and their energy is the work of their pressure."""

from __future__ import annotations

import numpy as np

from ...contracts import EquationOfState
from ...errors import PluginFault
from .fences import READ, Fenced, require_unchanged, sample
from .returned import NOTHING, require_array, require_finite

RATIOS = np.array([0.97, 0.99, 1.0, 1.01, 1.03])
"""Volume ratios at which energy and work are compared: the volume of a fluid hardly changes."""
PARTS = 32
"""Number of intervals of the integral of the pressure (midpoint rule)."""
APART = 0.05
"""Largest relative difference between energy and integral; a kink in the pressure needs some of it."""


def rehearse_equation_of_state(
    author: EquationOfState,
    volume_ratio: np.ndarray,
    density: float,
    sound_speed: float,
    numbers: np.ndarray,
) -> None:
    """Evaluate pressure and energy on copies of a sample of the particles; ``numbers`` are their numbers.

    Raises:
        PluginFault: it wrote to its arguments, or its energy is not the work of its pressure.
    """
    which = sample(len(numbers))

    def called(what: str, ratio: np.ndarray) -> np.ndarray:
        given = {"volume_ratio": Fenced(ratio, READ)}
        returned = getattr(author, what)(given["volume_ratio"].rows, density, sound_speed)
        require_array(author, what, returned, ratio.shape)
        require_unchanged(author, given)
        return returned

    for what, article in (("pressure", "a"), ("energy", "an")):
        returned = called(what, volume_ratio[which])
        require_finite(author, f"{article} {what}", returned, numbers[which], [volume_ratio[which]])

    # W(J) = -∫ p dJ from 1 to J, by the midpoint rule.
    middles = (np.arange(PARTS) + 0.5) / PARTS
    places = 1 + (RATIOS - 1)[:, None] * middles
    with np.errstate(invalid="ignore"):
        work = -(RATIOS - 1) * called("pressure", places.ravel()).reshape(places.shape).mean(axis=1)
        energy = called("energy", RATIOS)
        wrong = ~(np.abs(energy - work) <= APART * np.abs(work) + NOTHING * density * sound_speed**2)
    if wrong.any():
        worst = int(np.argmax(wrong))
        raise PluginFault(
            author,
            f"gave an energy of {energy[worst]:.4g} J/m³ at a volume ratio of {RATIOS[worst]:g}, where its "
            f"pressure has done {work[worst]:.4g} J/m³ of work from 1 on: the energy must be that work",
        )
