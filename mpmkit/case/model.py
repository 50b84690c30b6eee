"""The case: a whole scene, as a pydantic model.

``composed`` adds the parts that depend on the registered plug-ins.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import product
from typing import Literal

import numpy as np
from pydantic import Field

from ..contracts import Beginning, BodyForce, Contact, Mouth, Sink, Surface, quantity
from ..contracts.scale import Scale
from ..registry.audit import forces
from ..registry.audit.initial_fields import initial_values, shape_of
from ..spaces import SPACES, Space
from .base import Model, name_of_directory
from .bodies import Body, Inflow
from .ending import AnyUntil, latest
from .grid import Grid
from .material import Material
from .measurements import Measurement
from .output import OutputSettings
from .scheme import Scheme
from .sound_speed import SoundSpeedFactor, SoundSpeedMach

STANDARD_GRAVITY = 9.81
SAMPLES = 9
"""Places along each axis at which an initial field is evaluated to find its largest speed."""


class Wall(Model):
    """A surface, which may move, and its contact with the material."""

    surface: Surface = Field(description="where the wall is, and how it moves")
    contact: Contact = Field(description="what the wall allows the material that touches it")


class Case(Model):
    """A whole scene."""

    name: str = name_of_directory("case", "name of its run directory")
    description: str = Field(default="", description="free text about the case")
    space: Literal["3d", "plane-strain", "axisymmetric"] = Field(
        description="axes of the scene: x, y, z in 3d; x, z in plane-strain; r, z in axisymmetric"
    )
    until: AnyUntil = quantity("s", "simulated time, or conditions that end the run before a time at_most")
    gravity: list[float] | None = quantity(
        "m/s^2",
        "acceleration along each axis; default: 9.81 down the last axis, or none if a force stands for it",
        default=None,
    )
    grid: Grid = Field(description="cells, domain and faces")
    bodies: list[Body] = Field(
        default=[], description="the bodies of material at the start; there may be none if there are sources"
    )
    walls: dict[str, Wall] = Field(
        default={},
        description="walls beside the faces of the grid, each with a name of letters, digits, '_' and '-'",
        json_schema_extra={"propertyNames": {"pattern": "^[A-Za-z0-9_-]+$"}},
    )
    sources: dict[str, Inflow] = Field(
        default={},
        description="where material comes into the scene, each by a name of letters, digits, '_' and '-'",
        json_schema_extra={"propertyNames": {"pattern": "^[A-Za-z0-9_-]+$"}},
    )
    forces: dict[str, BodyForce] = Field(
        default={},
        description="accelerations of all material beside gravity, each by a name of letters, digits, '_' "
        "and '-'",
        json_schema_extra={"propertyNames": {"pattern": "^[A-Za-z0-9_-]+$"}},
    )
    sinks: dict[str, Sink] = Field(
        default={},
        description="where material leaves the scene and is counted, each by a name of letters, digits, "
        "'_' and '-'",
        json_schema_extra={"propertyNames": {"pattern": "^[A-Za-z0-9_-]+$"}},
    )
    scheme: Scheme = Field(description="the numerical method")
    output: OutputSettings = Field(default=OutputSettings(), description="what is written, and when")
    measurements: dict[str, Measurement] = Field(
        default={},
        description="what the apparatus reports: variables of the history, last values in the summary",
        json_schema_extra={"propertyNames": {"pattern": "^[a-z][a-z0-9_]*$"}},
    )

    @property
    def space_(self) -> Space:
        """The space as an object that knows its axes."""
        return SPACES[self.space]

    @property
    def end(self) -> float:
        """Time, s, at which the run ends at the latest."""
        return latest(self.until)

    @cached_property
    def domain_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner of the domain, m; a symmetry plane keeps the part of a body inside."""
        ends = np.array([self.grid.domain[axis] for axis in self.space_.axes])
        return ends[:, 0], ends[:, 1]

    @cached_property
    def gravity_of_key(self) -> np.ndarray:
        """The key ``gravity`` or its default, m/s², ``(dim,)``: nothing if a force stands for gravity."""
        if self.gravity is not None:
            return np.array(self.gravity)
        vector = np.zeros(self.space_.dim)
        if not any(force.is_gravity for force in self.forces.values()):
            vector[-1] = -STANDARD_GRAVITY
        return vector

    @property
    def materials(self) -> dict[str, Material]:
        """The material of each body and source, by its place in the case file."""
        bodies = {f"bodies.{number}.material": body.material for number, body in enumerate(self.bodies)}
        return bodies | {f"sources.{name}.material": one.material for name, one in self.sources.items()}

    @property
    def filled(self) -> list[Body | Inflow]:
        """The bodies, then the sources, in the order of the numbers in ``Particles.body``."""
        return [*self.bodies, *self.sources.values()]

    @cached_property
    def mouths(self) -> dict[str, Mouth]:
        """The section of each source at the start."""
        return {name: one.source.mouth(self.space_, self.domain_bounds) for name, one in self.sources.items()}

    def mouth_area(self, name: str) -> float:
        """Area of the section of a source that is in the domain, m²; 1 m deep in plane strain."""
        mouth, (lower, upper) = self.mouths[name], self.domain_bounds
        centre, half = np.array(mouth.centre), np.array(mouth.half_width)
        low, high = np.maximum(centre - half, lower), np.minimum(centre + half, upper)
        across = [a for a in range(self.space_.dim) if a != mouth.axis]
        if self.space_.radial:
            return float(np.pi * (high[0] ** 2 - low[0] ** 2))
        part = float(np.prod((high - low)[across]))
        return part * np.pi / 4 if mouth.round else part

    def source_speed(self, name: str, t0: float, t1: float) -> float:
        """Upper bound of the speed at which a source brings material in between two times, m/s."""
        one, area = self.sources[name], self.mouth_area(name)
        begins, ends = one.source.spell(area, one.material.density)
        if t1 < begins or t0 >= ends:
            return 0.0
        return one.source.fastest(max(t0, begins), min(t1, ends), area, one.material.density)

    @cached_property
    def gravity_vector(self) -> np.ndarray:
        """Constant gravity, m/s², ``(dim,)``: that of the key and of constant forces."""
        vector = self.gravity_of_key
        for force in self.forces.values():
            if force.constant:
                vector = vector + self._somewhere(force)
        return vector

    @property
    def varying_forces(self) -> dict[str, BodyForce]:
        """The forces that are not constant, by name; constant ones are a part of ``gravity_vector``."""
        return {name: force for name, force in self.forces.items() if not force.constant}

    @cached_property
    def gravity_at_start(self) -> np.ndarray:
        """Gravity at t = 0, m/s², ``(dim,)``, with the uniform forces that stand for gravity."""
        vector = self.gravity_vector
        for force in self.varying_forces.values():
            if force.is_gravity and force.uniform:
                vector = vector + self._somewhere(force)
        return vector

    def _somewhere(self, force: BodyForce) -> np.ndarray:
        """A uniform acceleration at t = 0, m/s², ``(dim,)``."""
        origin = np.zeros((1, self.space_.dim))
        return forces.acceleration(force, origin, origin, 0.0)[0]

    @cached_property
    def largest_forces(self) -> np.ndarray:
        """Upper bound of the sum of the forces that are not constant along each axis, m/s², ``(dim,)``."""
        lower, upper = self.domain_bounds
        found = (forces.largest(force, lower, upper, 0.0, self.end) for force in self.varying_forces.values())
        return sum(found, np.zeros(self.space_.dim))

    @cached_property
    def height(self) -> float:
        """Extent h of all bodies together along gravity, m.

        With sources, also from their mouths to the end of the domain that gravity pulls to, and at least the
        width of a mouth.
        """
        bounds = [np.array(body.shape.bounds(self.space_)) for body in self.bodies]
        for mouth in self.mouths.values():
            centre, half = np.array(mouth.centre), np.array(mouth.half_width)
            lower, upper = self.domain_bounds
            bounds.append(np.array([centre - half, np.where(self._downwards > 0, upper, lower)]))
            bounds.append(np.array([centre + half, centre + half]))
        ends = np.array([np.sort(self._downwards * b, axis=0).sum(axis=1) for b in bounds])
        widths = [2 * max(mouth.half_width) for mouth in self.mouths.values()]
        return max(float(ends[:, 1].max() - ends[:, 0].min()), *widths, 0.0)

    @cached_property
    def _downwards(self) -> np.ndarray:
        """Unit vector of gravity without its components along periodic axes, which have no height; down the
        last axis if no component is left."""
        vector = np.where(self._periodic, 0.0, self.gravity_at_start)
        if not vector.any():
            vector[-1] = -1.0
        return vector / np.linalg.norm(vector)

    @property
    def _periodic(self) -> np.ndarray:
        """Which axes are periodic, ``(dim,)``."""
        return np.array([self.grid.faces.get(f"{axis}_min") == "periodic" for axis in self.space_.axes])

    @cached_property
    def scale(self) -> Scale:
        """The size of the scene, and its driving forces."""
        return Scale(self.largest_energy, self.height)

    @cached_property
    def largest_energy(self) -> float:
        """Largest initial energy of a particle, J/kg: kinetic, and potential above the lowest particle."""
        fastest = max(
            [0.0, *map(self.speed_at_start, self.bodies)]
            + [self.source_speed(name, 0.0, self.end) for name in self.sources]
        )
        return self.energy_of_fall + fastest**2 / 2

    def speed_at_start(self, body: Body) -> float:
        """Largest speed of a body at the start, m/s; of a field that of samples."""
        if "velocity" not in body.initial:
            return body.largest_speed
        return float(np.linalg.norm(self.at_start(body, "velocity", self._samples(body)), axis=1).max())

    def velocity_at_start(self, body: Body) -> np.ndarray:
        """Mean velocity of a body at the start, m/s, ``(dim,)``; of a field that of samples in the body, of a
        standing wave zero."""
        if "velocity" not in body.initial:
            uniform = body.velocity if isinstance(body.velocity, list) else [0.0] * self.space_.dim
            return np.array(uniform, dtype=float)
        places = self._samples(body)
        inside = places[body.shape.contains(places, self.space_)]
        return self.at_start(body, "velocity", inside if len(inside) else places).mean(axis=0)

    def _samples(self, body: Body) -> np.ndarray:
        """Places in the box around a body, m, ``(n, dim)``."""
        lower, upper = body.shape.bounds(self.space_)
        parts = np.array(list(product(np.linspace(0, 1, SAMPLES), repeat=len(lower))))
        return lower + parts * (upper - lower)

    def at_start(self, body: Body, field: str, position: np.ndarray) -> np.ndarray:
        """An initial field of a body at places, m, ``(n, dim)``: ``(n, *shape)``."""
        shape = shape_of(field, body.material.constitutive_law, self.space_)
        strength = float(np.linalg.norm(self.gravity_at_start))
        up = -self.gravity_at_start / strength if strength else np.zeros(self.space_.dim)
        low, high = body.shape.bounds(self.space_)
        top = float(np.maximum(low * up, high * up).sum())
        start = (self.space_, field, shape, position, body.material.density, self.gravity_at_start, top)
        return initial_values(body.initial[field], Beginning(*start))

    @cached_property
    def energy_of_fall(self) -> float:
        """Largest energy, J/kg, that gravity and forces can give over the extent of the bodies."""
        of_gravity = float(np.linalg.norm(self.gravity_vector)) * self.height
        if not self.varying_forces:
            return of_gravity
        extent = self.domain_bounds[1] - self.domain_bounds[0]
        if not self.sources:
            lower, upper = zip(*(body.shape.bounds(self.space_) for body in self.bodies), strict=True)
            extent = np.max(upper, axis=0) - np.min(lower, axis=0)
        return of_gravity + float(self.largest_forces @ np.where(self._periodic, self.height, extent))

    def sound_speed(self, material: Material) -> float | None:
        """Sound speed of a material at the start, m/s; None if its law needs none."""
        if not material.constitutive_law.uses_equation_of_state:
            return None
        speed = material.sound_speed
        if isinstance(speed, SoundSpeedFactor):
            return speed.factor * math.sqrt(2 * self.energy_of_fall)
        if isinstance(speed, SoundSpeedMach):
            return math.sqrt(2 * self.largest_energy) / speed.mach
        return speed
