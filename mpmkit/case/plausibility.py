"""Values that are probably not in SI units: lengths in millimetres, a density in g/cm³, a stress in kPa.

Nothing is refused. Dimensionless numbers are checked first. Magnitudes are checked only with the earth's
gravity, because test scenes with unit density and length have no gravity or another one.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..registry.audit import forces
from .material import Material
from .model import STANDARD_GRAVITY, Case

EARTH = 0.1
"""Relative difference from 9.81 m/s² up to which gravity is the earth's."""
STRONGEST = 1000.0
"""Gravity, m/s²: that of a geotechnical centrifuge; in mm/s² the earth's is 9810."""
IN_CENTIMETRES, CLOSE = 100 * STANDARD_GRAVITY, 2e-3
"""The earth's gravity in cm/s², and the relative difference up to which a value is probably in cm/s²."""
SIZES = (1e-3, 50.0)
"""Usual height of a scene, m, in tests and castings."""
DENSITIES = (100.0, 25_000.0)
"""kg/m³, from foam to tungsten."""
VISCOSITIES = (1e-5, 1e6)
"""Pa s, from thinner than any liquid to bitumen."""
YIELD_STRESSES = (5e-5, 2.0)
"""τ0/(ρ g h): below this range the yield stress has no effect, above it the material does not flow."""
MACH_NUMBERS = (1 / 500, 0.5)
"""√(2 g h), or the speed at the start, over the sound speed."""


def implausible(case: Case) -> Iterator[str]:
    """A sentence for each value that is probably not in SI units: the value, and the usual range."""
    strength = float(np.linalg.norm(case.gravity_at_start))
    if strength > STRONGEST:
        yield f"gravity is {strength:.4g} m/s²; on earth it is 9.81 m/s²: is it in mm/s²?"
    elif abs(strength / IN_CENTIMETRES - 1) < CLOSE:
        yield f"gravity is {strength:.4g} m/s²; on earth it is 9.81 m/s²: is it in cm/s²?"
    yield from _forces(case)
    if abs(strength / STANDARD_GRAVITY - 1) < EARTH:
        yield from _on_earth(case, strength)
    fastest = (2 * case.largest_energy) ** 0.5
    for where, material in case.materials.items():
        yield from _sound(where, material, fastest)


def _forces(case: Case) -> Iterator[str]:
    """Strong forces also set the sound speeds ``factor`` and ``mach``, and parameters that a law chooses."""
    lower, upper = case.domain_bounds
    for name, force in case.varying_forces.items():
        strength = float(np.linalg.norm(forces.largest(force, lower, upper, 0.0, case.end)))
        if strength > STRONGEST:
            yield (
                f"forces.{name} accelerates by up to {strength:.4g} m/s²; usual is up to {STRONGEST:g} m/s²: "
                "is a stop too short, or a length in mm?"
            )


def _on_earth(case: Case, strength: float) -> Iterator[str]:
    height = case.height
    if not SIZES[0] <= height <= SIZES[1]:
        yield (
            f"the {'scene is' if case.sources else 'bodies are'} {height:.4g} m high; usual is {SIZES[0]:g} "
            f"to {SIZES[1]:g} m: are the lengths in metres?"
        )
    for where, material in case.materials.items():
        if not DENSITIES[0] <= material.density <= DENSITIES[1]:
            yield (
                f"{where}.density is {material.density:.4g} kg/m³; usual is {DENSITIES[0]:g} to "
                f"{DENSITIES[1]:g} kg/m³: is it in kg/m³?"
            )
        viscosity = _viscosity(material)
        if viscosity is not None and not VISCOSITIES[0] <= viscosity[1] <= VISCOSITIES[1]:
            yield (
                f"{where}.{viscosity[0]} is {viscosity[1]:.4g} Pa s; usual is {VISCOSITIES[0]:g} to "
                f"{VISCOSITIES[1]:g} Pa s: is it in Pa s?"
            )
        weight = material.density * strength * height
        stress = getattr(material, "yield_stress", None)
        if isinstance(stress, float) and stress > 0 and weight > 0:
            ratio = stress / weight
            if not YIELD_STRESSES[0] <= ratio <= YIELD_STRESSES[1]:
                effect = "is not felt" if ratio < YIELD_STRESSES[0] else "keeps the material from flowing"
                yield (
                    f"{where}.yield_stress is {stress:.4g} Pa, {ratio:.2g} of ρ g h, the pressure at the "
                    f"foot of the scene; it {effect}: is it in Pa, and are density and lengths right?"
                )


def _viscosity(material: Any) -> tuple[str, float] | None:
    """Name and value of the viscosity of a material at 1/s; None if it has none."""
    for name in ("viscosity", "plastic_viscosity", "consistency"):
        value = getattr(material, name, None)
        if isinstance(value, float) and value > 0:
            return name, value
    return None


def _sound(where: str, material: Material, fastest: float) -> Iterator[str]:
    """Check of a sound speed in m/s against the speed that the scene can reach."""
    speed = material.sound_speed
    if not isinstance(speed, float) or fastest == 0 or MACH_NUMBERS[0] <= fastest / speed <= MACH_NUMBERS[1]:
        return
    effect = "many steps for nothing" if speed > fastest else "the material is compressed as it flows"
    yield (
        f"{where}.sound_speed is {speed:.4g} m/s, {speed / fastest:.3g} times the {fastest:.3g} m/s that the "
        f"scene can reach; usual is 10 to 50 times: {effect}"
    )
