"""What every volumetric treatment must be: an average that keeps energy, of a field that it only reads."""

from __future__ import annotations

import numpy as np

from ..contracts import VolumetricTreatment
from ..contracts.version1 import operations_for
from ..solver.simulation import Simulation
from .scenes import block, shake, simulate
from .violation import require, require_all, require_close, require_same

OIL = {"law": "newtonian", "density": 1000.0, "viscosity": 1.0, "sound_speed": 10.0}


def flowing(space: str, treatment: VolumetricTreatment) -> Simulation:
    """A block of oil that deforms, in the middle of a step."""
    lower, upper, domain = block(space)
    simulation = simulate(space, {"volumetric": treatment}, [(lower, upper, OIL, None)], domain)
    shake(simulation)
    simulation.choose_time_step()
    for _ in range(3):
        simulation.advance()
    simulation.operations.begin()
    return simulation


def treated(simulation: Simulation, treatment: VolumetricTreatment, field: np.ndarray) -> np.ndarray:
    """A f: an array of numbers with an entry for each particle; f itself is read alone."""
    given = field.copy()
    found = treatment.average(operations_for(treatment, simulation.operations), given)
    require_same(given, field, lambda p: "the field that average is given, which it must not change,")
    is_array = isinstance(found, np.ndarray) and found.dtype == float and found.shape == field.shape
    described = (
        f"an array of shape {found.shape} and type {found.dtype}"
        if isinstance(found, np.ndarray)
        else f"a {type(found).__name__}"
    )
    require(is_array, f"average returned {described}; it must return an array of {len(field)} floats")
    require_all(np.isfinite(found), lambda p: f"the average at a particle is {found[p]}")
    return found


def constant_field(space: str, treatment: VolumetricTreatment) -> None:
    """A field that is the same everywhere stays as it is."""
    simulation = flowing(space, treatment)
    found = treated(simulation, treatment, np.full(len(simulation.particles), 3.5))
    require_close(found, 3.5, 1e-12, lambda p: "the average of a field that is 3.5 everywhere")


def power(space: str, treatment: VolumetricTreatment) -> None:
    """Σ V (A p) r = Σ V p (A r): the power of the pressure is what the compressive energy loses."""
    simulation = flowing(space, treatment)
    V = simulation.particles.volume
    p, r = np.random.default_rng(3).standard_normal((2, len(V)))
    mapped = float(V @ (treated(simulation, treatment, p) * r))
    driven = float(V @ (p * treated(simulation, treatment, r)))
    scale = float(V @ np.abs(p * r))
    require(
        abs(mapped - driven) <= 1e-10 * scale,
        f"the power of a pressure p at a rate r, Σ V (A p) r, is {mapped:.9g}, but Σ V p (A r) is "
        f"{driven:.9g}: the treatment feeds energy in, or takes it out",
    )


def relaxation_rate(space: str, treatment: VolumetricTreatment) -> None:
    """The rate at which J is drawn to its average is a finite number of at least 0 /s."""
    simulation = flowing(space, treatment)
    found = treatment.relaxation_rate(operations_for(treatment, simulation.operations))
    is_number = isinstance(found, int | float | np.floating) and not isinstance(found, bool)
    require(
        is_number and np.isfinite(found) and found >= 0,
        f"its relaxation rate is {found!r}; it must be a finite number, in 1/s, of at least 0",
    )
