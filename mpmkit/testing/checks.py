"""The checks of each kind of plug-in, by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

from ..contracts import (
    BodyForce,
    BodyShape,
    ConstitutiveLaw,
    Contact,
    Diagnostic,
    EquationOfState,
    InitialField,
    Operations,
    ParticleField,
    Plugin,
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
from ..errors import GuardStop, PluginFault
from ..spaces import Space
from . import (
    body_forces,
    body_shapes,
    contacts,
    elastic,
    equations_of_state,
    flight,
    initial_fields,
    law_promises,
    laws,
    measured,
    radial,
    redistribution,
    refinement,
    shapes,
    sinks,
    sources,
    surfaces,
    volumetric,
)
from .descriptor import descriptor, registered
from .law_subject import Curve, LawSubject
from .scenes import SPACES
from .specimens import DENSITY, SOUND_SPEED
from .violation import Violation

ON_LAWS = (
    laws.resists_shear,
    laws.dissipation,
    laws.objectivity,
    laws.turning,
    laws.rest,
    laws.extreme_rates,
    laws.batch_order,
    laws.swelling,
    law_promises.declared_state,
    law_promises.leaves_the_kinematics_alone,
    law_promises.wave_speed,
    law_promises.largest_viscosity,
    law_promises.remarks,
)
ON_HYPERELASTIC_LAWS = (
    elastic.energy_gives_the_stress,
    elastic.turned_bodies_hold_no_stress,
    elastic.frame_indifference,
)
ON_SHAPES = (
    shapes.partition_of_unity,
    shapes.linear_reproduction,
    shapes.gradients,
    shapes.nodes_within_reach,
    shapes.continuity,
    shapes.place_in_the_lattice,
    shapes.mirror,
    shapes.batch_order,
    radial.radial_partition_of_unity,
    radial.radial_expansion,
    radial.far_from_the_axis,
)
ON_ORDERS = (flight.uniform_motion, flight.free_fall, flight.momentum, flight.energy)
ON_VELOCITIES = (flight.uniform_motion, flight.free_fall, flight.momentum, flight.no_energy_from_nowhere)
ON_TREATMENTS = (volumetric.constant_field, volumetric.power, volumetric.relaxation_rate)
ON_REDISTRIBUTIONS = (
    redistribution.even_particles,
    redistribution.rest,
    redistribution.mass_and_momentum,
    redistribution.disorder_decays,
    redistribution.repeatable,
)
ON_REFINEMENTS = (
    refinement.as_they_begin,
    refinement.keeps_what_there_is,
    refinement.ends,
    refinement.repeatable,
)
ON_EQUATIONS_OF_STATE = (
    equations_of_state.arrays,
    equations_of_state.natural_state,
    equations_of_state.resists_compression,
    equations_of_state.sound_speed,
    equations_of_state.energy_gives_the_pressure,
    equations_of_state.batch_order,
)
ON_SURFACES = (
    surfaces.arrays,
    surfaces.lipschitz,
    surfaces.normals,
    surfaces.fastest,
    surfaces.moves_as_it_says,
    surfaces.batch_order,
)
ON_CONTACTS = (
    contacts.declares,
    contacts.arrays,
    contacts.extremes,
    contacts.energy,
    contacts.pushes_only,
    contacts.objectivity,
    contacts.galilei,
    contacts.batch_order,
)
ON_BODY_FORCES = (
    body_forces.arrays,
    body_forces.batch_order,
    body_forces.declares,
    body_forces.mean,
    body_forces.largest,
    body_forces.settles,
)
ON_INITIAL_FIELDS = (initial_fields.arrays, initial_fields.batch_order)
ON_BODY_SHAPES = (
    body_shapes.distances,
    body_shapes.never_too_far,
    body_shapes.leads_to_the_surface,
    body_shapes.contains,
    body_shapes.volume,
)
ON_SINKS = (sinks.takes_something, sinks.batch_order)
ON_SOURCES = (sources.pushes, sources.fastest, sources.remembers_nothing)
ON_DIAGNOSTICS = (
    measured.declares,
    measured.numbers,
    measured.remembers_nothing,
    measured.particle_order,
)
ON_PARTICLE_FIELDS = (measured.arrays, measured.each_for_itself)


@dataclass(frozen=True)
class Check:
    """One property of one plug-in; calling it raises a ``Violation``, one sentence, unless it is there."""

    name: str
    kind: str
    plugin: Plugin
    run: Callable[[], None]

    def __call__(self) -> None:
        __tracebackhide__ = True  # pytest shows the sentence and not our code
        try:
            self.run()
        except (Violation, GuardStop, PluginFault) as fault:
            raise Violation(f"{self.kind.replace('_', ' ')} '{self.plugin.name}': {fault}") from None


def law_checks(
    law: ConstitutiveLaw,
    *,
    flow_curve: Curve | None = None,
    strain: float = 2.0,
    rel: float | None = None,
    density: float = DENSITY,
    sound_speed: float = SOUND_SPEED,
) -> list[Check]:
    """What every law must do; see ``law_tests`` for the arguments."""
    subject = LawSubject(law, flow_curve, strain, rel, density, sound_speed)
    chosen: tuple[Callable[[LawSubject], None], ...] = ON_LAWS
    if subject.curve is not None:
        chosen = (laws.flow_curve, *chosen)
    if subject.hyperelastic:
        chosen += ON_HYPERELASTIC_LAWS
    return _of("law", law, _in_place_first(law_promises.writes_in_place, chosen, subject))


def shape_checks(shape: ShapeFunction) -> list[Check]:
    """What every shape function must be."""
    chosen = (*ON_SHAPES, shapes.barely_touched_nodes) if shape.smooth else ON_SHAPES
    return _of("shape", shape, _in_place_first(shapes.writes_in_place, chosen, shape))


def order_checks(order: UpdateOrder) -> list[Check]:
    """What every update order must do, in each space, with the default shape function and undamped FLIP."""
    scheme = {"order": order, "velocity": _Undamped()}
    return _of("order", order, _in_each_space(ON_ORDERS, scheme))


def velocity_checks(velocity: VelocityUpdate) -> list[Check]:
    """What every velocity update must do, in each space, with the default shape function and order."""
    scheme = {"velocity": velocity}
    fraction = ("acoustic_fraction", partial(flight.fraction, SPACES[0], scheme))
    return _of("velocity", velocity, [fraction, *_in_each_space(ON_VELOCITIES, scheme)])


def volumetric_checks(treatment: VolumetricTreatment) -> list[Check]:
    """What every volumetric treatment must be, in each space, with the default schemes."""
    return _of("volumetric", treatment, _in_each_space(ON_TREATMENTS, treatment))


def redistribution_checks(author: Redistribution) -> list[Check]:
    """What every redistribution must do, in each space, with the default schemes."""
    due = ("is_due", partial(redistribution.is_due, author))
    return _of("redistribution", author, [due, *_in_each_space(ON_REDISTRIBUTIONS, author)])


def refinement_checks(author: Refinement) -> list[Check]:
    """What every refinement must do, in each space, with the default schemes."""
    return _of("refinement", author, _in_each_space(ON_REFINEMENTS, author))


def equation_of_state_checks(state: EquationOfState) -> list[Check]:
    """What every equation of state must be."""
    return _of(
        "equation_of_state",
        state,
        [(check.__name__, partial(check, state)) for check in ON_EQUATIONS_OF_STATE],
    )


def surface_checks(surface: Surface, *, size: float = 1.0) -> list[Check]:
    """What every surface must be, in each space that can hold it; see ``surface_tests``."""
    homes = surfaces.at_home(surface)
    return _in_spaces("surface", surface, surfaces.problem, ON_SURFACES, homes, size)


def contact_checks(contact: Contact) -> list[Check]:
    """What every contact must do."""
    return _of("contact", contact, [(check.__name__, partial(check, contact)) for check in ON_CONTACTS])


def body_force_checks(force: BodyForce, *, size: float = 1.0) -> list[Check]:
    """What every body force must do, in each space that can have it; see ``body_force_tests``."""
    homes = body_forces.at_home(force)
    return _in_spaces("body_force", force, body_forces.home, ON_BODY_FORCES, homes, size)


def body_shape_checks(shape: BodyShape) -> list[Check]:
    """What every body shape must be, in each space that can hold it; see ``body_shape_tests``."""
    return _in_spaces("body_shape", shape, body_shapes.home, ON_BODY_SHAPES, body_shapes.at_home(shape))


def initial_field_checks(field: InitialField, *, size: float = 1.0) -> list[Check]:
    """What every initial field must do, in each space and for each field that it can give."""
    checks = [(check.__name__, partial(check, field, size)) for check in ON_INITIAL_FIELDS]
    return _of("initial_field", field, [("home", partial(initial_fields.home, field)), *checks])


def sink_checks(sink: Sink, *, size: float = 1.0) -> list[Check]:
    """What every sink must do, in each space that can have it; see ``sink_tests``."""
    return _in_spaces("sink", sink, sinks.home, ON_SINKS, sinks.at_home(sink), size)


def source_checks(source: Source, *, size: float = 1.0) -> list[Check]:
    """What every source must do, and its mouth in each space that can have it; see ``source_tests``."""
    homes = sources.at_home(source, size)
    return _of(
        "source",
        source,
        [
            ("home", partial(sources.home, source, size)),
            *((f"mouth {space.name}", partial(sources.mouth, source, space, size)) for space in homes),
            *((check.__name__, partial(check, source)) for check in ON_SOURCES),
        ],
    )


def diagnostic_checks(diagnostic: Diagnostic) -> list[Check]:
    """What every diagnostic must do, in each space in which it can be measured."""
    homes = measured.at_home(diagnostic)
    return _in_spaces("diagnostic", diagnostic, measured.home, ON_DIAGNOSTICS, homes)


def particle_field_checks(field: ParticleField) -> list[Check]:
    """What every particle field must do, in each space."""
    return _of("particle_field", field, _in_each_space(ON_PARTICLE_FIELDS, field))


def _in_each_space(
    checks: Iterable[Callable[[str, Any], None]], subject: Any
) -> list[tuple[str, Callable[[], Any]]]:
    return [
        (f"{check.__name__} {space}", partial(check, space, subject)) for check in checks for space in SPACES
    ]


def _in_spaces(
    kind: str,
    plugin: Plugin,
    home: Callable[[Any], None],
    checks: Iterable[Callable[..., None]],
    spaces: Iterable[Space],
    *size: float,
) -> list[Check]:
    """The check that some space can have the plug-in, then the other checks in each of these spaces."""
    in_spaces = [
        (f"{check.__name__} {space.name}", partial(check, plugin, space, *size))
        for check in checks
        for space in spaces
    ]
    return _of(kind, plugin, [(home.__name__, partial(home, plugin)), *in_spaces])


def _in_place_first(
    in_place: Callable[[Any], None], checks: Iterable[Callable[[Any], None]], subject: Any
) -> list[tuple[str, Callable[[], Any]]]:
    """Each check after the one that sees whether anything is written: its sentence names the cause."""

    def run(check: Callable[[Any], None]) -> None:
        __tracebackhide__ = True
        in_place(subject)
        check(subject)

    return [
        ("writes_in_place", partial(in_place, subject)),
        *((check.__name__, partial(run, check)) for check in checks),
    ]


def _of(kind: str, plugin: Plugin, runs: Iterable[tuple[str, Callable[[], None]]]) -> list[Check]:
    said: list[tuple[str, Callable[[], Any]]] = [
        ("descriptor", partial(descriptor, kind, plugin)),
        ("registered", partial(registered, kind, plugin)),
    ]
    return [Check(name.replace("_", " "), kind, plugin, run) for name, run in [*said, *runs]]


class _Undamped(VelocityUpdate):
    """v ← v + Δṽ: keeps the energy that an order feeds in or takes out, for all to see."""

    name = "undamped"
    citation = "Brackbill & Ruppel, J. Comput. Phys. 65 (1986) 314-343"
    api_version = 2

    def map_to_particles(self, ops: Operations, dt: float) -> None:
        ops.move_particles(dt, flip=1.0)
