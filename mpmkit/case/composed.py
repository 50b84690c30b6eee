"""The model of case files, composed of the case's own fields and the registered plug-ins.

Parameters of third-party plug-ins are validated, documented and completed in editors like the built-in ones.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache, reduce
from operator import or_
from typing import Annotated, Any, ClassVar, Literal

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    ValidationInfo,
    WithJsonSchema,
    create_model,
    model_validator,
)
from pydantic_core import PydanticKnownError

from ..contracts import BodyShape, ConstitutiveLaw, Plugin, Source
from ..registry import Registry, installed
from .bodies import Body, Inflow
from .consistency import check
from .html import case_html
from .material import Material
from .model import Case, Wall
from .output import OutputSettings
from .scheme import Scheme


class CheckedCase(Case):
    """A case whose fields are consistent."""

    registry: ClassVar[Registry]
    """Plug-ins that it was composed from."""

    @model_validator(mode="after")
    def _fits_together(self, info: ValidationInfo) -> CheckedCase:
        if info.context is not _CHECKED_BEFORE:
            check(self)
        return self

    def _repr_html_(self) -> str:
        """The view of the case in a notebook."""
        return case_html(self)

    def __reduce__(self) -> tuple:
        """Support for pickling: in another process, the class is made again from the plug-ins."""
        known = self.registry is installed()
        return _unpickled, (self.model_dump_json(), None if known else self.registry)


_CHECKED_BEFORE = {"checked": "before"}


def _unpickled(text: str, registry: Registry | None) -> Case:
    return case_model(registry or installed()).model_validate_json(text, context=_CHECKED_BEFORE)


def _one_of(kind: str, members: Mapping[str, type], key: str) -> Any:
    """Annotation of a field that holds a plug-in of a kind; the constant at ``key`` selects it."""

    def tag(value: Any) -> Any:
        if isinstance(value, dict):
            return value.get(key)
        if isinstance(value, Plugin):
            return value.name
        return value if isinstance(value, str) else getattr(value, key, None)

    if not members:  # all are broken or refused: report it only when a case is read
        return _none_of(kind)
    return Annotated[
        reduce(or_, [Annotated[cls, Tag(name)] for name, cls in members.items()]), Discriminator(tag)
    ]


def _none_of(kind: str) -> Any:
    """Annotation of a field for which no plug-in is installed: it takes no value."""
    allowed = f"a plug-in of the kind '{kind}', but none is installed"

    def refuse(value: Any) -> Any:
        raise PydanticKnownError("literal_error", {"expected": allowed})

    return Annotated[Any, BeforeValidator(refuse), WithJsonSchema({"not": {}, "allowed": allowed})]


def _choice(registry: Registry, kind: str, default: str, meaning: str) -> tuple[Any, Any]:
    """Annotation and field of a plug-in that is given by its name, or by name and parameters."""
    plugins = registry.of_kind(kind)
    preset: dict[str, Any] = {"default": default, "validate_default": True} if default in plugins else {}
    return _one_of(kind, plugins, "name"), Field(description=meaning, **preset)


def _named(plugins: Mapping[str, type[Plugin]], kind: str) -> tuple[Any, Any]:
    """Annotation and field of a plug-in of a wall, whose name is given at ``kind``, without a default."""
    return _one_of(kind, plugins, "kind"), Wall.model_fields[kind]


def _made_of(shape: Any, plugin: type[Plugin]) -> type[Plugin]:
    """A plug-in whose parameters that are body shapes may be of every registered kind."""
    own_fields = {
        name: (shape, Field(default=field.default, description=field.description))
        for name, field in plugin.model_fields.items()
        if field.annotation is BodyShape
    }
    if not own_fields:
        return plugin
    return create_model(
        plugin.__name__,
        __base__=plugin,
        __module__=plugin.__module__,
        __doc__=plugin.__doc__,
        **own_fields,  # type: ignore[call-overload]
    )


def _of_names(annotation: Any) -> Any:
    """Annotation of a field that holds values under names chosen by the user."""
    return dict[str, annotation]


def _by_name(registry: Registry, kind: str, field: Any) -> tuple[Any, Any]:
    """Annotation of a field that holds plug-ins under names chosen by the user."""
    return _of_names(_one_of(kind, registry.of_kind(kind), "kind")), field


def _fields_of(plugin: type[Plugin]) -> dict[str, tuple[Any, Any]]:
    """The parameters of a plug-in as fields of another model."""
    return {name: (field.annotation, field) for name, field in plugin.model_fields.items()}


def _material_model(law: type[ConstitutiveLaw], registry: Registry) -> type[Material]:
    base = type("Material", (Material,), {"law_class": law, "__module__": Material.__module__})
    return create_model(
        f"Material_{law.__name__}",
        __base__=base,
        __doc__=law.__doc__,
        law=(Literal[law.name], ...),
        equation_of_state=_choice(
            registry, "equation_of_state", "linear", "pressure as a function of the volume ratio J"
        ),
        **_fields_of(law),  # type: ignore[call-overload]
    )


def _inflow_model(source: type[Source], material: Any) -> type[Inflow]:
    base = type("Inflow", (Inflow,), {"source_class": source, "__module__": Inflow.__module__})
    return create_model(
        f"Inflow_{source.__name__}",
        __base__=base,
        __doc__=source.__doc__,
        kind=(Literal[source.name], ...),
        material=(material, Inflow.model_fields["material"]),
        **_fields_of(source),  # type: ignore[call-overload]
    )


@lru_cache(maxsize=4)
def case_model(registry: Registry) -> type[Case]:
    """The model of case files for the plug-ins that are registered."""
    laws = {name: _material_model(law, registry) for name, law in registry.of_kind("law").items()}  # type: ignore[arg-type]
    material = _one_of("law", laws, "law")
    shape = _one_of("body_shape", registry.of_kind("body_shape"), "kind")
    body = create_model(
        "Body",
        __base__=Body,
        __doc__=Body.__doc__,
        shape=(shape, Body.model_fields["shape"]),
        material=(material, Body.model_fields["material"]),
        initial=_by_name(registry, "initial_field", Body.model_fields["initial"]),
    )
    inflows = {
        name: _inflow_model(source, material)  # type: ignore[arg-type]
        for name, source in registry.of_kind("source").items()
    }
    scheme = create_model(
        "Scheme",
        __base__=Scheme,
        __doc__=Scheme.__doc__,
        shape=_choice(registry, "shape", "cpgimp", "how far a particle reaches on the grid"),
        order=_choice(registry, "order", "usl", "when in a step the stress is updated"),
        velocity=_choice(registry, "velocity", "apic", "how particles take the velocity of the grid"),
        volumetric=_choice(
            registry, "volumetric", "nodal-average", "how volumetric rate and pressure are averaged"
        ),
        redistribution=_choice(
            registry, "redistribution", "even", "how particles are kept evenly spaced in fluids"
        ),
        refinement=_choice(registry, "refinement", "none", "how the number of particles follows the flow"),
    )
    surfaces = {name: _made_of(shape, surface) for name, surface in registry.of_kind("surface").items()}
    wall = create_model(
        "Wall",
        __base__=Wall,
        __doc__=Wall.__doc__,
        surface=_named(surfaces, "surface"),
        contact=_named(registry.of_kind("contact"), "contact"),
    )
    output = create_model(
        "OutputSettings",
        __base__=OutputSettings,
        __doc__=OutputSettings.__doc__,
        diagnostics=_by_name(registry, "diagnostic", OutputSettings.model_fields["diagnostics"]),
        fields=_by_name(registry, "particle_field", OutputSettings.model_fields["fields"]),
    )
    model = create_model(
        "Case",
        __base__=CheckedCase,
        __doc__=Case.__doc__,
        bodies=(list[body], Case.model_fields["bodies"]),  # type: ignore[valid-type]
        walls=(dict[str, wall], Case.model_fields["walls"]),  # type: ignore[valid-type]
        sources=(_of_names(_one_of("source", inflows, "kind")), Case.model_fields["sources"]),
        forces=_by_name(registry, "body_force", Case.model_fields["forces"]),
        sinks=_by_name(registry, "sink", Case.model_fields["sinks"]),
        scheme=(scheme, Field(default={}, validate_default=True, description="the numerical method")),
        output=(output, Field(default={}, validate_default=True, description="what the run writes")),
    )
    model.registry = registry
    return model
