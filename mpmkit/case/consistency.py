"""Rules of a case that span several fields.

Each violation gives one sentence with the field, the value, and the allowed values.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from ..errors import PluginFault
from ..output.columns import COLUMNS
from ..output.variables import PARTICLE_VARIABLES
from ..registry.audit import require_number
from ..registry.blame import blaming_plugins
from .allowed import one_of, shown
from .diagnostics import diagnostic_columns
from .draining import drain_columns
from .ending import Until
from .forces import check_forces, check_symmetry_of_forces, force_columns
from .initial_fields import check_initial_fields
from .material import Material
from .measurement_rules import check_measurements
from .measurements import MEANS, means
from .model import Case
from .shapes import check_shape
from .sound_speed import SoundSpeedFactor, SoundSpeedMach
from .sources import check_inflows, check_mouths, source_columns
from .state_variables import TAKEN, former_names, state_variables
from .synonyms import nearest
from .walls import NAME, check_walls
from .whole_cells import WHOLE, cells_along, extend_domain

MOST_CELLS = 2**30
"""Most cells along an axis: the first node of a particle is a 32-bit integer."""
MOST_SPEED = 1e12
"""m/s; faster than any real wave, and slow enough for a positive time step."""
MOST_OUTPUTS = 100_000
"""Most rows of a history, or frames, of a run."""


def check(case: Case) -> None:
    """Raise ValueError with one sentence for the first violated rule.

    Pydantic treats every ValueError as an input error: exceptions of plug-ins must not reach it as
    ValueError.
    """
    _check_vector("gravity", case.gravity, case)
    check_forces(case)
    _check_domain(case)
    _check_faces(case)
    if not case.bodies and not case.sources:
        given = "[]" if "bodies" in case.model_fields_set else "missing"
        raise ValueError(
            f"bodies is {given}; it must be a list of one or more objects, unless the case has sources"
        )
    for name, inflow in case.sources.items():
        _check_particles_per_cell(f"sources.{name}.particles_per_cell", inflow.particles_per_cell, case)
    check_mouths(case)
    check_symmetry_of_forces(case)
    for number, body in enumerate(case.bodies):
        where = f"bodies.{number}"
        for field, vector in _velocity_vectors(body):
            _check_vector(f"{where}.velocity{field}", vector, case)
        check_initial_fields(where, body, case)
        _check_particles_per_cell(f"{where}.particles_per_cell", body.particles_per_cell, case)
        _check_sound_speed(f"{where}.material.sound_speed", body.material, case)
        check_shape(f"{where}.shape", body.shape, case.space_)
        _check_inside(where, body, case)
        _check_wave_speed(f"{where}.material", body.material, case)
    for name, inflow in case.sources.items():
        _check_sound_speed(f"sources.{name}.material.sound_speed", inflow.material, case)
        _check_wave_speed(f"sources.{name}.material", inflow.material, case)
    check_inflows(case)
    _check_sinks(case)
    _check_measured(case)
    check_measurements(case)
    _check_until(case)
    check_walls(case)
    _check_time_step(case)
    for field in ("history_interval", "frame_interval"):
        _check_interval(f"output.{field}", getattr(case.output, field), case.end)
    _check_particle_history(case)


def _check_sinks(case: Case) -> None:
    faces = {name: case.grid.faces.get(name, "open") for name in case.space_.faces}
    for name, sink in case.sinks.items():
        if not NAME.fullmatch(name):
            raise ValueError(f"sinks has the name {shown(name)}; it must be of letters, digits, '_' and '-'")
        with blaming_plugins([("sink", sink)]):
            problem = sink.problem(case.space_, faces)
        if problem is not None:
            raise ValueError(f"sinks.{name}: {problem}")


def _check_measured(case: Case) -> None:
    """Check that diagnostics fit the scene, and that names of fields are unique."""
    for what in ("diagnostics", "fields"):
        for name in getattr(case.output, what):
            if not NAME.fullmatch(name):
                raise ValueError(
                    f"output.{what} has the name {shown(name)}; it must be of letters, digits, '_' and '-'"
                )
    walls = [*case.walls, *case.space_.faces]
    for name, diagnostic in case.output.diagnostics.items():
        with blaming_plugins([("diagnostic", diagnostic)]):
            problem = diagnostic.problem(case.space_, walls)
        if problem is not None:
            raise ValueError(f"output.diagnostics.{name}: {problem}")
    for name in case.output.fields:
        if name in TAKEN or name in former_names(case):
            raise ValueError(
                f"output.fields has the name '{name}', which another particle field has; choose another name"
            )


def _check_until(case: Case) -> None:
    columns = [
        *COLUMNS,
        *source_columns(case),
        *force_columns(case),
        *drain_columns(case),
        *diagnostic_columns(case),
    ]
    scalars = [column.name for column in columns if not column.component and not column.dimension]
    scalars += case.measurements
    passing = means(case.measurements)
    for name in case.until.variables if isinstance(case.until, Until) else ():
        if name in passing:
            raise ValueError(
                f"until has the key '{name}', a measurement with a mean over the time between two rows of "
                f"the history ({', '.join(MEANS)}); it cannot end a run between them"
            )
        if name not in scalars:
            near = nearest(name, ["at_most", "rest", *scalars])
            hint = (
                f"did you mean '{near}'?" if near else f"it may have at_most, rest, and {', '.join(scalars)}"
            )
            raise ValueError(
                f"until has the key '{name}', which is not a scalar variable of the history; {hint}"
            )


def _check_particle_history(case: Case) -> None:
    allowed = [*PARTICLE_VARIABLES, *state_variables(case), *case.output.fields]
    for number, name in enumerate(case.output.particle_history):
        if name not in allowed and name not in former_names(case):
            raise ValueError(
                f"output.particle_history.{number} is {shown(name)}; it must be {one_of(allowed)}"
                f"{_meant(name, allowed)}"
            )


def _check_vector(field: str, value: list[float] | None, case: Case) -> None:
    axes = case.space_.axes
    if value is not None and len(value) != len(axes):
        raise ValueError(
            f"{field} is {shown(value)}; in the space '{case.space}' it needs {len(axes)} numbers, "
            f"along {', '.join(axes)}"
        )


def _velocity_vectors(body) -> list[tuple[str, list[float]]]:
    velocity = body.velocity
    if velocity is None:
        return []
    if isinstance(velocity, list):
        return [("", velocity)]
    return [(".amplitude", velocity.amplitude), (".wave_vector", velocity.wave_vector)]


def _check_domain(case: Case) -> None:
    axes, domain, cell = case.space_.axes, case.grid.domain, case.grid.cell_size
    for axis in domain:
        if axis not in axes:
            raise ValueError(
                f"grid.domain has an axis '{axis}'; the space '{case.space}' has the axes {', '.join(axes)}"
                f"{_meant(axis, axes)}"
            )
    for axis in axes:
        if axis not in domain:
            raise ValueError(
                f"grid.domain lacks the axis '{axis}'; it needs {', '.join(axes)}, each as [lower, upper]"
            )
        lower, upper = domain[axis]
        if not lower < upper:
            raise ValueError(
                f"grid.domain.{axis} is [{lower:g}, {upper:g}]; the lower end must be below the upper one"
            )
        if (cells := cells_along(case, axis)) > MOST_CELLS:
            raise ValueError(
                f"grid.domain.{axis} has {cells:.3g} cells of {cell:g} m; at most {MOST_CELLS:,} are possible"
            )
    if case.space_.radial and domain["r"][0] != 0:
        raise ValueError(
            f"grid.domain.r begins at {domain['r'][0]:g}; it must begin at the axis of symmetry, r = 0"
        )
    extend_domain(case)


def _check_faces(case: Case) -> None:
    names = case.space_.faces
    faces = case.grid.faces
    for name in faces:
        if name not in names:
            raise ValueError(
                f"grid.faces has '{name}'; the faces of the space '{case.space}' are {', '.join(names)}"
                f"{_meant(name, names)}"
            )
    if case.space_.radial:
        for name in ("r_min", "r_max"):
            if faces.get(name) == "periodic":
                raise ValueError(f'grid.faces.{name} is "periodic"; the radial axis has no period')
        if faces.get("r_min", "symmetry") != "symmetry":
            raise ValueError(
                f"grid.faces.r_min is {shown(faces['r_min'])}; at the axis of symmetry it must be "
                '"symmetry" or left out'
            )
    for axis in case.space_.axes:
        pair = [faces.get(f"{axis}_{side}") for side in ("min", "max")]
        if "periodic" in pair and pair[0] != pair[1]:
            raise ValueError(
                f"grid.faces: {axis}_min and {axis}_max must both be 'periodic' if one of them is"
            )


def _meant(word: str, allowed: Iterable[str]) -> str:
    near = nearest(word, allowed)
    return "" if near is None else f"; did you mean '{near}'?"


def _check_particles_per_cell(field: str, value: int | list[int] | None, case: Case) -> None:
    dim = case.space_.dim
    if isinstance(value, list):
        _check_vector(field, value, case)  # type: ignore[arg-type]
    elif value is not None and round(value ** (1 / dim)) ** dim != value:
        allowed = ", ".join(str(k**dim) for k in range(1, 5))
        raise ValueError(
            f"{field} is {value}; one number must be a {'square' if dim == 2 else 'cube'} ({allowed}, …), "
            f"or give the number along each axis, such as {[2] * dim}"
        )


def _check_sound_speed(field: str, material: Material, case: Case) -> None:
    if not material.constitutive_law.uses_equation_of_state:
        if material.sound_speed is not None:
            raise ValueError(
                f"{field} is given, but the law '{material.law}' computes its own pressure; leave it out"
            )
    elif material.sound_speed is None:
        raise ValueError(
            f"{field} is missing; the law '{material.law}' needs it, in m/s or as "
            '{"factor": 10} for 10 √(2 g h), or {"mach": 0.1}'
        )
    elif isinstance(material.sound_speed, SoundSpeedMach) and case.largest_energy == 0:
        raise ValueError(
            f"{field} is a Mach number, but gravity is {case.gravity} and nothing moves; "
            "give the speed itself, in m/s"
        )
    elif isinstance(material.sound_speed, SoundSpeedFactor) and case.energy_of_fall == 0:
        raise ValueError(
            f"{field} is a factor of √(2 g h), but gravity is {case.gravity}; give the speed itself, in m/s"
        )
    speed = case.sound_speed(material)
    if speed is not None and not math.isfinite(material.density * speed * speed):
        given = f"{material.sound_speed:g}" if isinstance(material.sound_speed, float) else f"{speed:g} m/s"
        raise ValueError(f"{field} is {given}, and density times its square is too large to be computed")


def _check_wave_speed(field: str, material: Material, case: Case) -> None:
    """Check the wave speeds: finite parameters can still give an infinite wave speed and a step of zero."""
    law, sound_speed = material.constitutive_law, case.sound_speed(material)
    with blaming_plugins([("law", law)]):
        try:
            law = law.in_scene(material.density, sound_speed, case.scale)
            given = law.wave_speed(material.density, sound_speed)
        except OverflowError:
            given = math.inf
        speed = require_number(law, "wave_speed", given)
        if math.isnan(speed) or speed < 0:
            raise PluginFault(law, f"has a wave speed of {speed} m/s; it must be positive")
    if not 0 < speed < MOST_SPEED:
        raise ValueError(
            f"{field} makes waves of {speed:.3g} m/s; its moduli and its density must give less than "
            f"{MOST_SPEED:g} m/s"
        )


def _check_time_step(case: Case) -> None:
    """Check that the step has a limit: the waves of the materials, or else their viscosity."""
    ignored = case.scheme.time_step.ignore
    laws = [material.constitutive_law for material in case.materials.values()]
    with blaming_plugins([("law", law) for law in laws]):
        viscous = any(
            require_number(law, "largest_viscosity", law.largest_viscosity(1.0)) > 0 for law in laws
        )
    if "acoustic" in ignored and ("viscous" in ignored or not viscous):
        raise ValueError(
            f"scheme.time_step.ignore is {shown(ignored)}, but then nothing limits the time step of a "
            "scene at rest; it must not contain 'acoustic'"
        )


def _check_interval(field: str, interval: float | None, until: float) -> None:
    if interval is not None and until / interval > MOST_OUTPUTS:
        raise ValueError(
            f"{field} is {interval:g} s; it must be at least {until / MOST_OUTPUTS:g} s, "
            f"a {MOST_OUTPUTS:,}th of until"
        )


def _check_inside(where: str, body, case: Case) -> None:
    lower, upper = body.shape.bounds(case.space_)
    tolerance = WHOLE * case.grid.cell_size
    for a, axis in enumerate(case.space_.axes):
        low, high = case.grid.domain[axis]
        for side, beyond, end in (
            ("min", lower[a] < low - tolerance, lower[a]),
            ("max", upper[a] > high + tolerance, upper[a]),
        ):
            cut = case.grid.faces.get(f"{axis}_{side}") == "symmetry"
            if beyond and not cut:
                raise ValueError(
                    f"{where}.shape reaches {axis} = {end:.9g} m, outside the grid, whose domain "
                    f"along {axis} is [{low:.9g}, {high:.9g}] m; only a face with 'symmetry' may cut a body"
                )
        if np.isclose(lower[a], upper[a], rtol=0, atol=0):
            raise ValueError(f"{where}.shape has no extent along {axis}")
