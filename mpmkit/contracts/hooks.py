"""The hooks by which a distribution registers its plug-ins.

An entry point of the group ``mpmkit`` names a module; the module has one function for each kind that it
provides, marked ``@hookimpl``, which returns the descriptor classes.
"""

from __future__ import annotations

from collections.abc import Iterable

import pluggy

from .base import Plugin
from .body_force import BodyForce
from .body_shape import BodyShape
from .contact import Contact
from .diagnostic import Diagnostic, ParticleField
from .equation_of_state import EquationOfState
from .initial_field import InitialField
from .law import ConstitutiveLaw
from .order import UpdateOrder
from .redistribution import Redistribution
from .refinement import Refinement
from .shape import ShapeFunction
from .sink import Sink
from .source import Source
from .surface import Surface
from .velocity import VelocityUpdate
from .volumetric import VolumetricTreatment

PROJECT = "mpmkit"
hookspec = pluggy.HookspecMarker(PROJECT)
hookimpl = pluggy.HookimplMarker(PROJECT)


@hookspec
def mpmkit_shape_functions() -> Iterable[type[ShapeFunction]]:  # type: ignore[empty-body]
    """Shape functions of this module."""


@hookspec
def mpmkit_update_orders() -> Iterable[type[UpdateOrder]]:  # type: ignore[empty-body]
    """Update orders of this module."""


@hookspec
def mpmkit_velocity_updates() -> Iterable[type[VelocityUpdate]]:  # type: ignore[empty-body]
    """Velocity updates of this module."""


@hookspec
def mpmkit_laws() -> Iterable[type[ConstitutiveLaw]]:  # type: ignore[empty-body]
    """Constitutive laws of this module."""


@hookspec
def mpmkit_volumetric_treatments() -> Iterable[type[VolumetricTreatment]]:  # type: ignore[empty-body]
    """Volumetric treatments of this module."""


@hookspec
def mpmkit_equations_of_state() -> Iterable[type[EquationOfState]]:  # type: ignore[empty-body]
    """Equations of state of this module."""


@hookspec
def mpmkit_redistributions() -> Iterable[type[Redistribution]]:  # type: ignore[empty-body]
    """Redistributions of this module."""


@hookspec
def mpmkit_refinements() -> Iterable[type[Refinement]]:  # type: ignore[empty-body]
    """Refinements of this module."""


@hookspec
def mpmkit_body_shapes() -> Iterable[type[BodyShape]]:  # type: ignore[empty-body]
    """Body shapes of this module."""


@hookspec
def mpmkit_surfaces() -> Iterable[type[Surface]]:  # type: ignore[empty-body]
    """Surfaces of this module."""


@hookspec
def mpmkit_contacts() -> Iterable[type[Contact]]:  # type: ignore[empty-body]
    """Contacts of this module."""


@hookspec
def mpmkit_diagnostics() -> Iterable[type[Diagnostic]]:  # type: ignore[empty-body]
    """Diagnostics of this module."""


@hookspec
def mpmkit_particle_fields() -> Iterable[type[ParticleField]]:  # type: ignore[empty-body]
    """Particle fields of this module."""


@hookspec
def mpmkit_body_forces() -> Iterable[type[BodyForce]]:  # type: ignore[empty-body]
    """Body forces of this module."""


@hookspec
def mpmkit_initial_fields() -> Iterable[type[InitialField]]:  # type: ignore[empty-body]
    """Initial fields of this module."""


@hookspec
def mpmkit_sinks() -> Iterable[type[Sink]]:  # type: ignore[empty-body]
    """Sinks of this module."""


@hookspec
def mpmkit_sources() -> Iterable[type[Source]]:  # type: ignore[empty-body]
    """Sources of this module."""


KINDS: dict[str, tuple[str, type[Plugin]]] = {
    "shape": ("mpmkit_shape_functions", ShapeFunction),
    "order": ("mpmkit_update_orders", UpdateOrder),
    "velocity": ("mpmkit_velocity_updates", VelocityUpdate),
    "law": ("mpmkit_laws", ConstitutiveLaw),
    "volumetric": ("mpmkit_volumetric_treatments", VolumetricTreatment),
    "redistribution": ("mpmkit_redistributions", Redistribution),
    "refinement": ("mpmkit_refinements", Refinement),
    "equation_of_state": ("mpmkit_equations_of_state", EquationOfState),
    "body_shape": ("mpmkit_body_shapes", BodyShape),
    "surface": ("mpmkit_surfaces", Surface),
    "contact": ("mpmkit_contacts", Contact),
    "body_force": ("mpmkit_body_forces", BodyForce),
    "initial_field": ("mpmkit_initial_fields", InitialField),
    "sink": ("mpmkit_sinks", Sink),
    "source": ("mpmkit_sources", Source),
    "diagnostic": ("mpmkit_diagnostics", Diagnostic),
    "particle_field": ("mpmkit_particle_fields", ParticleField),
}
"""Kind of plug-in: its hook and its contract."""
