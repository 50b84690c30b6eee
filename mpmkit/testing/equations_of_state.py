"""What every equation of state must be: a pressure that falls with the volume, and its energy."""

from __future__ import annotations

import numpy as np

from ..contracts import EquationOfState
from ..contracts.law import LEAST_RATIO, MOST_RATIO
from .specimens import DENSITY, SOUND_SPEED
from .violation import require, require_all, require_close, require_same

BULK = DENSITY * SOUND_SPEED**2
"""ρ c², Pa, that errors are measured against."""


def ratios(n: int = 300) -> np.ndarray:
    """Volume ratios J that a run may come to, most of them near 1."""
    near = 1 + np.concatenate([-np.geomspace(1e-9, 0.1, n // 3), np.geomspace(1e-9, 0.1, n // 3)])
    return np.sort(np.concatenate([near, [1.0], np.geomspace(LEAST_RATIO, MOST_RATIO, n // 3)]))


def returned(state: EquationOfState, method: str, J: np.ndarray) -> np.ndarray:
    """What a method gives: an array of numbers with an entry for each J, which it must not change."""
    given = J.copy()
    found = getattr(state, method)(given, DENSITY, SOUND_SPEED)
    require_same(given, J, lambda p: f"volume_ratio, which {method} must not change,")
    is_array = isinstance(found, np.ndarray) and found.dtype == float
    require(
        is_array and found.shape == J.shape,
        f"{method} returned {_described(found)}; it must return an array of {len(J)} floats, one for each J",
    )
    require_all(np.isfinite(found), lambda p: f"{method} at J = {J[p]:.9g} is {found[p]}")
    return found


def _described(value: object) -> str:
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} and type {value.dtype}"
    return f"a {type(value).__name__}"


def arrays(state: EquationOfState) -> None:
    """Pressure and energy are arrays of finite numbers, and the volume ratio is read alone."""
    for method in ("pressure", "energy"):
        returned(state, method, ratios())


def natural_state(state: EquationOfState) -> None:
    """No pressure and no energy at the initial volume."""
    for method, unit in (("pressure", "Pa"), ("energy", "J/m³")):
        require_close(
            returned(state, method, np.ones(1)), 0.0, 1e-12 * BULK, lambda p, m=method: f"{m} at J = 1", unit
        )


def resists_compression(state: EquationOfState) -> None:
    """The pressure falls as the volume grows."""
    J = np.geomspace(LEAST_RATIO, MOST_RATIO, 300)
    p = returned(state, "pressure", J)
    require_all(
        np.diff(p) < 0,
        lambda i: (
            f"the pressure rises from {p[i]:.6g} Pa at J = {J[i]:.6g} to {p[i + 1]:.6g} Pa at "
            f"J = {J[i + 1]:.6g}"
        ),
    )


def sound_speed(state: EquationOfState) -> None:
    """-dp/dJ = ρ c² at J = 1: small waves run at the sound speed of the case, which limits the step."""
    h = 1e-5
    below, above = returned(state, "pressure", np.array([1 - h, 1 + h]))
    require_close(np.array([(below - above) / (2 * h)]), BULK, 1e-6 * BULK, lambda p: "-dp/dJ at J = 1", "Pa")


def energy_gives_the_pressure(state: EquationOfState) -> None:
    """p = -de/dJ, by central differences; and no energy is below that at the initial volume."""
    J, h = ratios(), 1e-6
    p = returned(state, "pressure", J)
    slope = (returned(state, "energy", J - h) - returned(state, "energy", J + h)) / (2 * h)
    require_close(
        p,
        slope,
        1e-6 * np.maximum(np.abs(p), BULK),
        lambda i: f"the pressure at J = {J[i]:.6g}, against -de/dJ,",
        "Pa",
    )
    e = returned(state, "energy", J)
    require_all(
        e >= -1e-13 * BULK, lambda i: f"the energy at J = {J[i]:.9g} is {e[i]:.6g} J/m³, below that at J = 1"
    )


def batch_order(state: EquationOfState) -> None:
    """Particles do not know each other: in another order, or alone, each gets the same to the bit."""
    J = np.random.default_rng(1).uniform(0.5, 2.0, 300)
    order = np.random.default_rng(2).permutation(300)
    for method in ("pressure", "energy"):
        whole = returned(state, method, J)
        for index, how in ((order, "in another order"), (np.array([299]), "alone")):
            require_same(
                returned(state, method, J[index]),
                whole[index],
                lambda p, m=method, h=how: f"the {m} of a particle that is handed over {h}",
            )
