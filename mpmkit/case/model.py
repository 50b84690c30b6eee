"""The case: a scene, its materials and the schemes that solve it, as pydantic models.

The models of the schemes and the materials are made from the registered plug-ins, so that a third party's
parameters are validated, documented and completed in an editor exactly as the built-in ones.
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache, reduce
from operator import or_
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag, create_model, model_validator

from ..contracts import ConstitutiveLaw, EquationOfState, quantity
from ..contracts.order import UpdateOrder
from ..contracts.shape import ShapeFunction
from ..contracts.velocity import VelocityUpdate
from ..contracts.volumetric import VolumetricTreatment
from ..geometry import AnyShape
from ..registry import Registry
from ..spaces import SPACES, Space
from .base import Model
from .output import OutputSettings
from .sound_speed import SoundSpeed, SoundSpeedFactor, SoundSpeedMach

STANDARD_GRAVITY = 9.81


class Friction(Model):
    """A Coulomb wall: it pushes but does not pull, and drags with at most ``coefficient`` times its push."""

    kind: Literal["friction"]
    coefficient: float = quantity("1", "Coulomb friction coefficient", ge=0)


FaceName = Literal["slip", "stick", "periodic", "open", "symmetry"]


def _face_tag(value: Any) -> str:
    return "name" if isinstance(value, str) else "friction"


Face = Annotated[
    Annotated[FaceName, Tag("name")] | Annotated[Friction, Tag("friction")], Discriminator(_face_tag)
]


class Grid(Model):
    """The background grid: cubic cells on a box whose faces carry the boundary conditions."""

    cell_size: float = quantity("m", "side of a cell", gt=0)
    domain: dict[str, Annotated[list[float], Field(min_length=2, max_length=2)]] = quantity(
        "m", "lower and upper end of the domain along each axis of the space"
    )
    faces: dict[str, Face] = Field(
        default={}, description="condition on each face, such as z_min; a face that is not named is open"
    )


class Material(Model):
    """A constitutive law with its parameters, a density and, for a fluid, a sound speed."""

    law: str
    density: float = quantity("kg/m^3", "initial density", gt=0)
    sound_speed: SoundSpeed | None = quantity(
        "m/s", "artificial sound speed, or a factor of √(2 g h), or the largest Mach number", default=None
    )
    equation_of_state: EquationOfState

    law_class: ClassVar[type[ConstitutiveLaw]]

    @cached_property
    def constitutive_law(self) -> ConstitutiveLaw:
        """The law with its parameters."""
        return self.law_class.model_validate(
            {name: getattr(self, name) for name in self.law_class.model_fields}
        )


class SineVelocity(Model):
    """A standing wave as initial velocity: v(x) = amplitude sin(wave_vector · x)."""

    amplitude: list[float] = quantity("m/s", "amplitude along each axis")
    wave_vector: list[float] = quantity("rad/m", "2 pi over the wave length, along each axis")

    def at(self, position: np.ndarray) -> np.ndarray:
        """Velocity, m/s, ``(n, dim)``, at positions ``(n, dim)``, m."""
        return np.sin(position @ np.array(self.wave_vector))[:, None] * np.array(self.amplitude)


def _velocity_tag(value: Any) -> str:
    return "sine" if isinstance(value, dict | SineVelocity) else "uniform"


InitialVelocity = Annotated[
    Annotated[list[float], Tag("uniform")] | Annotated[SineVelocity, Tag("sine")],
    Discriminator(_velocity_tag),
]


ParticleCount = Annotated[int, Field(gt=0, le=1000)]


class Body(Model):
    """A shape filled with a material."""

    shape: AnyShape
    material: Material
    particles_per_cell: ParticleCount | list[ParticleCount] | None = Field(
        default=None,
        description="particles in a full cell (a square or cubic number), or their number along each axis; "
        "2 along each axis unless told",
    )
    velocity: InitialVelocity | None = quantity(
        "m/s", "initial velocity along each axis, or a standing wave; at rest unless told", default=None
    )

    @property
    def largest_speed(self) -> float:
        """Bound of the initial speed, m/s."""
        if self.velocity is None:
            return 0.0
        vector = self.velocity if isinstance(self.velocity, list) else self.velocity.amplitude
        return float(np.linalg.norm(vector))


class TimeStep(Model):
    """The step as a fraction of the smallest limit that is not ignored."""

    fraction: float = quantity("1", "fraction of the critical step", gt=0, le=1, default=0.5)
    ignore: list[Literal["acoustic", "viscous", "advective"]] = Field(
        default=[], description="limits that the step may exceed; a warning says by how much"
    )


class Scheme(Model):
    """The numerical method."""

    shape: ShapeFunction
    order: UpdateOrder
    velocity: VelocityUpdate
    volumetric: VolumetricTreatment
    splitting: bool = Field(
        default=False, description="whether particles whose box is drawn longer than a cell are split in two"
    )
    time_step: TimeStep = TimeStep()


class Case(Model):
    """A whole scene."""

    name: str = Field(
        default="case",
        pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$",
        max_length=100,
        description="name of its run directory",
        json_schema_extra={
            "allowed": "at most 100 letters, digits, '_', '.' and '-', first a letter or a digit"
        },
    )
    description: str = ""
    space: Literal["3d", "plane-strain", "axisymmetric"]
    until: float = quantity("s", "simulated time", gt=0)
    gravity: list[float] | None = quantity(
        "m/s^2", "acceleration along each axis; 9.81 down the last axis unless told", default=None
    )
    grid: Grid
    bodies: list[Body] = Field(min_length=1)
    scheme: Scheme
    output: OutputSettings = OutputSettings()

    @property
    def space_(self) -> Space:
        """The space as an object that knows its axes."""
        return SPACES[self.space]

    @cached_property
    def gravity_vector(self) -> np.ndarray:
        """Acceleration of gravity, m/s², ``(dim,)``."""
        if self.gravity is not None:
            return np.array(self.gravity)
        vector = np.zeros(self.space_.dim)
        vector[-1] = -STANDARD_GRAVITY
        return vector

    @cached_property
    def height(self) -> float:
        """Vertical extent h of all bodies together, m."""
        bounds = [body.shape.bounds(self.space_) for body in self.bodies]
        return float(max(upper[-1] for _, upper in bounds) - min(lower[-1] for lower, _ in bounds))

    @cached_property
    def largest_energy(self) -> float:
        """Largest energy that a particle has at the start, of speed and height above the lowest one, J/kg."""
        fastest = max((body.largest_speed for body in self.bodies), default=0.0)
        return float(np.linalg.norm(self.gravity_vector)) * self.height + fastest**2 / 2

    def sound_speed(self, material: Material) -> float | None:
        """Sound speed of a material at the start, m/s; None where its law needs none."""
        if not material.constitutive_law.uses_equation_of_state:
            return None
        speed = material.sound_speed
        if isinstance(speed, SoundSpeedFactor):
            return speed.factor * math.sqrt(2 * float(np.linalg.norm(self.gravity_vector)) * self.height)
        if isinstance(speed, SoundSpeedMach):
            return math.sqrt(2 * self.largest_energy) / speed.mach
        return speed

    @model_validator(mode="after")
    def _fits_together(self) -> Case:
        from .consistency import check  # the rules that span several fields, apart from the fields

        check(self)
        return self


def _one_of(members: dict[str, type], key: str) -> Any:
    """Annotation of a field that holds one of several models, told apart by the constant at ``key``."""

    def tag(value: Any) -> Any:
        if isinstance(value, dict):
            return value.get(key)
        return value if isinstance(value, str) else getattr(value, key, None)

    if not members:  # every one of them is broken or refused: only a case that is read fails of it
        return Literal["none is installed"]
    return Annotated[
        reduce(or_, [Annotated[cls, Tag(name)] for name, cls in members.items()]), Discriminator(tag)
    ]


def _choice(plugins: dict[str, type], default: str) -> tuple[Any, Any]:
    """Annotation and default of a field that holds a plug-in, by its name or by name and parameters."""
    preset = Field(default=default, validate_default=True) if default in plugins else ...
    return _one_of(plugins, "name"), preset


def _material_model(law: type[ConstitutiveLaw], registry: Registry) -> type[Material]:
    own_fields = {name: (field.annotation, field) for name, field in law.model_fields.items()}
    base = type("Material", (Material,), {"law_class": law, "__module__": __name__})
    return create_model(
        f"Material_{law.__name__}",
        __base__=base,
        __doc__=law.__doc__,
        law=(Literal[law.name], ...),
        equation_of_state=_choice(registry.of_kind("equation_of_state"), "linear"),
        **own_fields,  # type: ignore[call-overload]
    )


@lru_cache(maxsize=4)
def case_model(registry: Registry) -> type[Case]:
    """The model of case files for the plug-ins that are registered."""
    laws = {name: _material_model(law, registry) for name, law in registry.of_kind("law").items()}  # type: ignore[arg-type]
    body = create_model("Body", __base__=Body, __doc__=Body.__doc__, material=(_one_of(laws, "law"), ...))
    scheme = create_model(
        "Scheme",
        __base__=Scheme,
        __doc__=Scheme.__doc__,
        shape=_choice(registry.of_kind("shape"), "cpgimp"),
        order=_choice(registry.of_kind("order"), "usl"),
        velocity=_choice(registry.of_kind("velocity"), "apic"),
        volumetric=_choice(registry.of_kind("volumetric"), "nodal-average"),
    )
    return create_model(
        "Case",
        __base__=Case,
        __doc__=Case.__doc__,
        bodies=(list[body], Field(min_length=1)),  # type: ignore[valid-type]
        scheme=(scheme, Field(default={}, validate_default=True)),
    )
