"""The limits of an explicit time step by name, and the step that is used."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from ..case.scheme import Scheme
from ..contracts import UpdateOrder, VelocityUpdate
from ..errors import PluginFault
from ..registry.audit import require_number
from .particles import Group

VISCOUS_NUMBER = 0.375
"""Largest mu dt / (rho dx²): Bloch analysis of the explicit viscous term on hats, in any dimension."""

PART_OF_PERIOD = 0.1
"""Longest step as a part of the period of a force: with the default fraction of a half, 20 steps a period."""

FROM_REST = 0.05
"""Part of the scene's rate √e/h that a flow from rest can reach before the next check of the limits."""


@dataclass(frozen=True)
class Limits:
    """Critical steps, s, by name; infinite if there is no limit."""

    acoustic: float
    viscous: float
    advective: float
    forces: float = math.inf

    def as_dict(self) -> dict[str, float]:
        return {
            "acoustic": self.acoustic,
            "viscous": self.viscous,
            "advective": self.advective,
            "forces": self.forces,
        }


def limits(
    materials: Iterable[tuple[Group, float]],
    cell_size: float,
    largest_speed: float,
    rate: float,
    periods: Iterable[float] = (),
) -> Limits:
    """Critical steps of a scene.

    acoustic: dx / c, with the law's fastest wave in its present state (eq. 5 of Ferreira et al.);
    viscous: 0.375 rho dx² / mu, with the law's largest viscosity;
    advective: dx / |v|;
    forces: a tenth of the shortest period of a force.

    Args:
        materials: each with the speed of its fastest wave, m/s.
        cell_size: dx, m.
        largest_speed: largest particle speed, m/s.
        rate: √e/h of the scene, 1/s, see ``contracts.scale``.
        periods: shortest period of each force, s.
    """
    # The largest strain rate on the grid is the largest speed over one cell. A scene at rest will move, so
    # that a part of the rate of its possible fall is added.
    largest_rate = max(2 * largest_speed / cell_size, FROM_REST * rate)
    acoustic = viscous = math.inf
    for group, wave_speed in materials:
        acoustic = min(acoustic, _quotient(cell_size, wave_speed))
        given = group.law.largest_viscosity(largest_rate)
        viscosity = require_number(group.law, "largest_viscosity", given)
        if not viscosity >= 0:
            raise PluginFault(
                group.law, f"has a largest viscosity of {viscosity} Pa s; it must not be negative"
            )
        viscous = min(viscous, _quotient(VISCOUS_NUMBER * group.density * cell_size**2, viscosity))
    of_forces = PART_OF_PERIOD * min(periods, default=math.inf)
    return Limits(acoustic, viscous, _quotient(cell_size, largest_speed), of_forces)


def borne_by(scheme: Scheme) -> dict[str, float]:
    """Part of each limit, by name, at which the schemes are still stable.

    Raises:
        PluginFault: a plug-in returned a part that is not positive and finite.
    """
    order, velocity = scheme.order, scheme.velocity
    return {
        "acoustic": min(_fraction(order, "acoustic_fraction"), _fraction(velocity, "acoustic_fraction")),
        "viscous": _fraction(order, "viscous_fraction"),
        "advective": 1.0,
        "forces": 1.0,
    }


def _fraction(plugin: UpdateOrder | VelocityUpdate, name: str) -> float:
    fraction = require_number(plugin, name, getattr(plugin, name))
    if not 0 < fraction < math.inf:
        raise PluginFault(plugin, f"has {fraction:g} as {name}; it must be above 0, and finite")
    return fraction


def choose_step(scheme: Scheme, found: Limits, fraction: float | None = None) -> tuple[float, str]:
    """The step, s, and the name of the limit that sets it.

    It is ``time_step.fraction`` of the smallest limit that is not ignored, but never more than the stable
    part of the schemes. With an explicit ``fraction``, it is that part, also if it is not stable.
    """
    settings, borne = scheme.time_step, borne_by(scheme)
    steps = {
        name: limit * (min(settings.fraction, borne[name]) if fraction is None else fraction)
        for name, limit in found.as_dict().items()
    }
    kept = {name: step for name, step in steps.items() if name not in settings.ignore}
    name = min(kept, key=kept.__getitem__, default="none")
    return kept.get(name, math.inf), name


def warnings(scheme: Scheme, found: Limits, step: float) -> list[str]:
    """One sentence for every limit that is too small for the step because the case ignores it."""
    settings, borne = scheme.time_step, borne_by(scheme)
    return [
        f"the time step of {step:.3g} s exceeds the {name} limit of {limit:.3g} s {step / limit:.3g}-fold, "
        "because scheme.time_step.ignore contains it"
        if step > limit
        else f"the time step of {step:.3g} s is {step / limit:.3g} of the {name} limit of {limit:.3g} s, "
        f"and the schemes are stable up to {borne[name]:g} of it; scheme.time_step.ignore contains it"
        for name, limit in found.as_dict().items()
        if name in settings.ignore and step > borne[name] * limit
    ]


def _quotient(a: float, b: float) -> float:
    return a / b if b > 0 else math.inf
