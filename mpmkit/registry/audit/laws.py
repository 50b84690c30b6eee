"""Laws: the stress and the state that they write, the energy that they return, and their initial state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ...contracts import ConstitutiveLaw, Kinematics
from ...contracts.law import LEAST_RATIO, MOST_RATIO
from ...errors import PluginFault
from .fences import READ, WRITTEN, Fenced, require_intact, require_unchanged, sample
from .returned import described, first_bad, require_array, require_finite, require_number


def rehearse_law(
    law: ConstitutiveLaw,
    kinematics: Kinematics,
    state: Mapping[str, np.ndarray],
    stress: np.ndarray,
    dt: float,
    numbers: np.ndarray,
) -> None:
    """Call a law on copies of a sample of its particles; ``numbers`` are their numbers.

    Raises:
        PluginFault: it wrote to an array that it must not change, or not as the contract says.
    """
    which = sample(len(numbers))
    arrays = {name: array for name, array in vars(kinematics).items() if isinstance(array, np.ndarray)}
    given = {name: Fenced(array[which], READ) for name, array in arrays.items()}
    kept = {name: Fenced(array[which], WRITTEN) for name, array in state.items()}
    written = Fenced(stress[which], WRITTEN)
    rows = {name: array.rows for name, array in kept.items()}
    fenced: dict[str, Any] = {name: array.rows for name, array in given.items()}
    rehearsed = replace(kinematics, **fenced)
    returned = law.update_stress(rehearsed, rows, dt, written.rows)
    if returned is not None:
        raise PluginFault(
            law, f"returned {described(returned)}; it must write into 'stress', and return nothing"
        )
    for name, array in kept.items():
        if rows.get(name) is not array.rows:
            raise PluginFault(
                law, f"replaced the array of its state '{name}'; it must write into the one there"
            )
    require_intact(law, {"stress": written, **_as_states(kept)})
    require_unchanged(law, given)
    require_stress(law, rehearsed, dt, written.rows, numbers[which])
    _rehearse_energy(law, rehearsed, rows, written.rows, given)


def _rehearse_energy(
    law: ConstitutiveLaw,
    kinematics: Kinematics,
    state: dict[str, np.ndarray],
    stress: np.ndarray,
    given: dict[str, Fenced],
) -> None:
    """The energy of a law must not change its arguments, stress and state included."""
    copies = {name: Fenced(array, READ) for name, array in state.items()}
    seen = Fenced(stress, READ)
    energy = law.strain_energy(kinematics, {name: array.rows for name, array in copies.items()}, seen.rows)
    if np.ndim(energy):
        require_array(law, "strain_energy", energy, (len(stress),))
    else:
        require_number(law, "strain_energy", energy)
    require_unchanged(law, {"stress": seen, **_as_states(copies), **given})


def _as_states(arrays: dict[str, Fenced]) -> dict[str, Fenced]:
    return {f"state '{name}'": array for name, array in arrays.items()}


def require_stress(
    law: ConstitutiveLaw, kinematics: Kinematics, dt: float, stress: np.ndarray, numbers: np.ndarray
) -> None:
    """Raise PluginFault if a law gave a stress that is not finite although the run does not diverge.

    A run diverges if a step strains a particle by 1 or more, or if a volume ratio is far out of range.
    """
    if first_bad(stress) < 0:
        return
    ratio = kinematics.volume_ratio
    sound = ratio.min() >= LEAST_RATIO and ratio.max() <= MOST_RATIO
    if sound and np.abs(kinematics.velocity_gradient).max() * dt < 1:
        require_finite(law, "a stress", stress, numbers, (kinematics.pressure,))
