"""The checks as tests of pytest, which is imported only here."""

from __future__ import annotations

from collections.abc import Callable

from ..contracts import (
    BodyForce,
    BodyShape,
    ConstitutiveLaw,
    Contact,
    Diagnostic,
    EquationOfState,
    InitialField,
    ParticleField,
    Redistribution,
    Refinement,
    ShapeFunction,
    Sink,
    Source,
    Surface,
    UpdateOrder,
    VelocityUpdate,
    VolumetricTreatment,
)
from .checks import (
    Check,
    body_force_checks,
    body_shape_checks,
    contact_checks,
    diagnostic_checks,
    equation_of_state_checks,
    initial_field_checks,
    law_checks,
    order_checks,
    particle_field_checks,
    redistribution_checks,
    refinement_checks,
    shape_checks,
    sink_checks,
    source_checks,
    surface_checks,
    velocity_checks,
    volumetric_checks,
)
from .law_subject import Curve
from .specimens import DENSITY, SOUND_SPEED

Test = Callable[..., None]


def law_tests(
    law: ConstitutiveLaw,
    *,
    flow_curve: Curve | None = None,
    strain: float = 2.0,
    rel: float | None = None,
    density: float = DENSITY,
    sound_speed: float = SOUND_SPEED,
) -> Test:
    """A test function with a case for every check; give it a name that begins with ``test``.

    Simple shear on every plane and against the flow curve, dissipation, objectivity, no stress at rest,
    independence of the other particles, and whether declared state, wave speed and viscosity are right.

    Args:
        law: with parameters.
        flow_curve: shear stress, Pa, of steady shear at rates ``(n,)``, 1/s, written independently of the
        law.
            Default: that of a law which is defined by a flow curve; otherwise it is not checked.
        strain: shear strain after which the stress is steady.
        rel: allowed relative error of the stress; default: 1e-6, or 1e-3 for a law with memory, whose spring,
            turned by the shear, takes (tau/G)² of the stress.
        density: kg/m³.
        sound_speed: m/s, for a law that uses an equation of state.
    """
    return _tests(
        law_checks(
            law,
            flow_curve=flow_curve,
            strain=strain,
            rel=rel,
            density=density,
            sound_speed=sound_speed,
        )
    )


def shape_tests(shape: ShapeFunction) -> Test:
    """A test function, as that of ``law_tests``, for a shape function.

    Partition of unity, linear reproduction, gradients that are derivatives, continuity, the nodes that it may
    touch, mirror images, and the radial tables of axisymmetric scenes.
    """
    return _tests(shape_checks(shape))


def order_tests(order: UpdateOrder) -> Test:
    """A test function, as that of ``law_tests``, for an update order.

    Free flight, mass, momentum, and energy that is stored and given back but not made, in every space.
    """
    return _tests(order_checks(order))


def velocity_tests(velocity: VelocityUpdate) -> Test:
    """A test function, as that of ``law_tests``, for a velocity update.

    Free flight, mass, momentum, and no created energy, in every space.
    """
    return _tests(velocity_checks(velocity))


def volumetric_tests(treatment: VolumetricTreatment) -> Test:
    """A test function, as that of ``law_tests``, for a volumetric treatment.

    A constant field stays, the power of the pressure equals the loss of energy, the rate is a number.
    """
    return _tests(volumetric_checks(treatment))


def redistribution_tests(author: Redistribution) -> Test:
    """A test function, as that of ``law_tests``, for a redistribution.

    Even particles stay, nothing happens without shear, mass and momentum are kept, disorder does not grow.
    """
    return _tests(redistribution_checks(author))


def refinement_tests(author: Refinement) -> Test:
    """A test function, as that of ``law_tests``, for a refinement.

    Particles at the start are not changed, mass and momentum are conserved, their number has a bound.
    """
    return _tests(refinement_checks(author))


def equation_of_state_tests(state: EquationOfState) -> Test:
    """A test function, as that of ``law_tests``, for an equation of state.

    The pressure falls with the volume, at the sound speed of the case, and its energy is consistent.
    """
    return _tests(equation_of_state_checks(state))


def surface_tests(surface: Surface, *, size: float = 1.0) -> Test:
    """A test function, as that of ``law_tests``, for a surface, in each space that can hold it.

    The distance has a slope of at most 1, normals are its gradient, and the velocity is that of the motion.

    Args:
        surface: with parameters.
        size: m; the surface is checked within this distance of the origin along each axis.
    """
    return _tests(surface_checks(surface, size=size))


def contact_tests(contact: Contact) -> Test:
    """A test function, as that of ``law_tests``, for a contact.

    Nodes without material do not change, no energy is added, nothing is pulled, and the frame of reference
    makes no difference.
    """
    return _tests(contact_checks(contact))


def body_force_tests(force: BodyForce, *, size: float = 1.0) -> Test:
    """A test function, as that of ``law_tests``, for a body force, in each space that can have it.

    An acceleration for each place, and a mean, a bound and a time of rest that fit it.

    Args:
        force: with parameters; it must act within the first 5 s.
        size: m; places reach so far from the origin along each axis.
    """
    return _tests(body_force_checks(force, size=size))


def body_shape_tests(shape: BodyShape) -> Test:
    """A test function, as that of ``law_tests``, for a body shape, in each space that can hold it.

    A signed distance that is never too far and leads to the surface, in bounds that hold the shape, and the
    volume that it encloses.

    Args:
        shape: with parameters.
    """
    return _tests(body_shape_checks(shape))


def initial_field_tests(field: InitialField, *, size: float = 1.0) -> Test:
    """A test function, as that of ``law_tests``, for an initial field.

    Args:
        field: with parameters.
        size: m; places reach so far from the origin along each axis.
    """
    return _tests(initial_field_checks(field, size=size))


def sink_tests(sink: Sink, *, size: float = 1.0) -> Test:
    """A test function, as that of ``law_tests``, for a sink, in each space that can have it.

    True or False for each place, and each for itself.

    Args:
        sink: with parameters.
        size: m; the grid reaches so far from the origin along each axis, and places half as far again.
    """
    return _tests(sink_checks(sink, size=size))


def source_tests(source: Source, *, size: float = 1.0) -> Test:
    """A test function, as that of ``law_tests``, for a source, with its mouth in each space that can have it.

    The column of the source never moves back and is not faster than the speed that the source states. Its
    position depends on the time alone, and not on earlier calls.

    Args:
        source: with parameters.
        size: m; the grid reaches so far from the origin along each axis.
    """
    return _tests(source_checks(source, size=size))


def diagnostic_tests(diagnostic: Diagnostic) -> Test:
    """A test function, as that of ``law_tests``, for a diagnostic, in each space that can hold it.

    Columns that are declared, a number for each, the scene left alone, and the same for the same particles.
    The scene of the kit is a block of oil on the floor ``z_min``, from 0 to 0.25 m high, without other walls.
    """
    return _tests(diagnostic_checks(diagnostic))


def particle_field_tests(field: ParticleField) -> Test:
    """A test function, as that of ``law_tests``, for a particle field.

    An array of the declared shape, the scene left alone, and particles that do not know each other.
    """
    return _tests(particle_field_checks(field))


def _tests(checks: list[Check]) -> Test:
    import pytest

    @pytest.mark.parametrize("check", checks, ids=[check.name for check in checks])
    def test(check: Check) -> None:
        __tracebackhide__ = True
        check()

    return test
