"""The variables of a history: their names, units, descriptions and components."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Variable:
    """A column of the history: a number, or with ``component`` a vector along the axes of the space.

    With ``of_walls`` it has such an entry for each wall; with ``about`` it has a component for each of these
    axes; with ``dimension`` it has an entry for each of the ``labels``.
    """

    name: str
    units: str
    long_name: str
    component: bool = False
    of_walls: bool = False
    about: tuple[str, ...] = ()
    dimension: str = ""
    labels: tuple[str, ...] = ()


@dataclass(frozen=True)
class ParticleVariable:
    """A particle field of the history; ``trailing`` are its dimensions after ``(time, particle)``."""

    units: str
    long_name: str
    trailing: tuple[str, ...] = ()
    shape: tuple[int, ...] = ()
    """lengths of the trailing dimensions, if the space does not define them"""


PARTICLE_VARIABLES: dict[str, ParticleVariable] = {
    "position": ParticleVariable("m", "position of the particle", ("component",)),
    "velocity": ParticleVariable("m/s", "velocity of the particle", ("component",)),
    "stress": ParticleVariable("Pa", "Cauchy stress, positive in tension", ("tensor_component",)),
    "pressure": ParticleVariable("Pa", "pressure, positive in compression"),
    "volume_ratio": ParticleVariable("1", "current over initial volume"),
    "shear_rate": ParticleVariable("1/s", "shear rate √(2 D':D')"),
    "shear_stress": ParticleVariable("Pa", "shear stress √(s:s/2) of the stress deviator"),
    "yielded": ParticleVariable("1", "1 where the material has yielded, 0 where it has not"),
    "age": ParticleVariable("s", "time since the particle came in, or since the start"),
}
"""Fields for ``output.particle_history``, in addition to the state variables of the laws of the case."""

OUT_OF_PLANE = {("x", "z"): "y", ("r", "z"): "t"}
"""Name of axis 2 of a tensor where the grid has two axes; t is the hoop direction θ."""


def tensor_components(axes: Sequence[str]) -> list[str]:
    """Names of the six components of a symmetric tensor, in the order 00, 11, 22, 12, 02, 01 of its axes.

    In 3-D that is xx, yy, zz, yz, xz, xy. In two dimensions axis 1 is the vertical and axis 2 is out of the
    plane, and the names say so: rr, zz, tt, tz, rt, rz.
    """
    first, second, *rest = axes
    third = rest[0] if rest else OUT_OF_PLANE[first, second]
    mixed = ((second, third), (first, third), (first, second))
    return [2 * axis for axis in (first, second, third)] + ["".join(sorted(pair)) for pair in mixed]
