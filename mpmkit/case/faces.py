"""The condition on a face of the grid, and help for values that are not valid conditions."""

from __future__ import annotations

import json
from typing import Annotated, Any, Literal, get_args

from pydantic import BeforeValidator, Discriminator, Field, Tag

from ..contracts import quantity
from .allowed import one_of, shown
from .base import Model
from .synonyms import nearest


class Friction(Model):
    """A Coulomb wall: it pushes but does not pull, and drags with at most ``coefficient`` times its push."""

    kind: Literal["friction"]
    coefficient: float = quantity("1", "Coulomb friction coefficient", ge=0)


class Stick(Model):
    """A wall to which material sticks; with ``releases`` it releases material instead of pulling it."""

    kind: Literal["stick"]
    releases: bool = Field(
        description='whether the wall releases material that it would have to pull; the plain name "stick" '
        "does not"
    )


FaceName = Literal["slip", "stick", "periodic", "open", "symmetry"]
NAMES = list(get_args(FaceName))


def _written_as_it_must_be(value: Any) -> Any:
    """The value itself; an object that is not a valid condition is refused with the correct form."""
    if not isinstance(value, dict) or value.get("kind") == "friction":
        return value
    if value.get("kind") == "stick" and len(value) > 1:
        return value
    kind = value.get("kind", value.get("type", value.get("name")))
    if isinstance(kind, str):
        near = nearest(kind, [*NAMES, "friction"])
        if near is None:
            friction = '{"kind": "friction", "coefficient": 0.4}'
            raise ValueError(f'there is no kind of face "{kind}"; it must be {one_of(NAMES)}, or {friction}')
        raise ValueError(_sentence(value, _friction(value) if near == "friction" else json.dumps(near)))
    named = next((name for key in value if (name := nearest(key, [*NAMES, "friction"]))), "friction")
    if named != "friction":
        raise ValueError(_sentence(value, json.dumps(named)))
    if not any(nearest(key, ["friction", "coefficient"]) for key in value):
        raise ValueError(
            f"{shown(value)} is not a face condition; it must be {one_of(NAMES)}, or {_friction(None)}"
        )
    raise ValueError(_sentence(value, _friction(value)))


def _sentence(value: Any, right: str) -> str:
    return f"{shown(value)} must be written as {right}"


def _friction(value: Any) -> str:
    """The object of a friction wall, with the coefficient found in a value."""
    while isinstance(value, dict):
        value = next((v for v in value.values() if not isinstance(v, str | bool | list | None)), None)
    return f'{{"kind": "friction", "coefficient": {"…" if value is None else json.dumps(value)}}}'


def _face_tag(value: Any) -> str:
    # Tags differ from all names of keys, so that the path of an error is clear.
    if isinstance(value, str):
        return "by-name"
    kind = value.get("kind") if isinstance(value, dict) else getattr(value, "kind", None)
    return "by-stick" if kind == "stick" else "by-object"


Face = Annotated[
    Annotated[FaceName, Tag("by-name")]
    | Annotated[Friction, Tag("by-object")]
    | Annotated[Stick, Tag("by-stick")],
    Discriminator(_face_tag),
    BeforeValidator(_written_as_it_must_be),
]
