"""Surfaces and contacts: what they return, and what they write."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import get_args

import numpy as np

from ...contracts import Contact, ContactNodes, Space, Surface
from ...contracts.contact import Parity, initial_memory
from ...contracts.surface import PlacedSurface
from ...errors import PluginFault
from .fences import READ, WRITTEN, Fenced, require_intact, require_unchanged, sample
from .returned import described, require_array, require_number, require_truth

UNIT = 1e-6
"""Largest difference between the length of a normal and 1."""


def problem(author: Surface, space: Space) -> str | None:
    """Why a surface cannot be used in a space, in one sentence; None if it can.

    Raises:
        PluginFault: the surface returned something else.
    """
    found = author.problem(space)
    if found is not None and not isinstance(found, str):
        raise PluginFault(author, f"returned {described(found)} from problem; it must be a sentence, or None")
    return found


@dataclass(frozen=True)
class AuditedSurface:
    """A surface in its space, whose values are checked before they are used; see ``PlacedSurface``.

    Make all calls inside a block of ``blaming_plugins``.
    """

    author: Surface
    placed: PlacedSurface

    @property
    def thickness(self) -> float:
        """Thickness, m; infinite for a wall that fills the whole space behind its surface."""
        given = getattr(self.placed, "thickness", None)
        found = math.inf if given is None else require_number(self.author, "thickness", given)
        if not found > 0:
            raise PluginFault(self.author, f"has a thickness of {found} m; it must be above 0")
        return found

    @property
    def parts(self) -> list[AuditedSurface]:
        """The surfaces that together form the wall; the surface itself if it has no parts."""
        found = getattr(self.placed, "parts", None)
        if found is None:
            return [self]
        if not isinstance(found, Sequence) or not found:
            raise PluginFault(
                self.author, f"has the parts {described(found)}; they must be a sequence of surfaces"
            )
        for part in found:
            _require_methods(self.author, part, "has {} among its parts")
        return [AuditedSurface(self.author, part) for part in found]

    def distance(self, x: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
        """Distance, m, (k,), and unit normal, (k, dim), at points, m, (k, dim)."""
        returned = self.placed.distance(x, t)
        if not isinstance(returned, tuple) or len(returned) != 2:
            raise PluginFault(
                self.author,
                f"returned {described(returned)} from distance; it must be a tuple of two arrays, "
                "distance and normal",
            )
        distance, normal = returned
        require_array(self.author, "distance (its first entry)", distance, (len(x),))
        require_array(self.author, "distance (its second entry)", normal, x.shape)
        length = np.sqrt((normal * normal).sum(axis=1))
        self._require("a distance that is not finite", np.isfinite(distance), x, t)
        self._require("a normal that is not of length 1", np.abs(length - 1) <= UNIT, x, t)
        return distance, normal

    def velocity(self, x: np.ndarray, t: float) -> np.ndarray:
        """Velocity of the wall, m/s, (k, dim), at the points of its surface nearest to ``x``."""
        returned = self.placed.velocity(x, t)
        require_array(self.author, "velocity", returned, x.shape)
        self._require("a velocity that is not finite", np.isfinite(returned).all(axis=1), x, t)
        return returned

    def fastest(self, t0: float, t1: float) -> float:
        """Upper bound, m/s, of the velocity between two times, s."""
        found = require_number(self.author, "fastest", self.placed.fastest(t0, t1))
        if not 0 <= found < math.inf:
            raise PluginFault(
                self.author, f"gave {found} m/s as its fastest; it must be finite and not below 0"
            )
        return found

    def present(self, t: float) -> bool:
        """Whether the wall is present at a time, s."""
        return require_truth(self.author, "present", self.placed.present(t))

    def _require(self, what: str, sound: np.ndarray, x: np.ndarray, t: float) -> None:
        if not sound.all():
            place = ", ".join(f"{c:.4g}" for c in x[int(np.argmin(sound))])
            raise PluginFault(self.author, f"gave {what} at ({place}) m, t = {t:.4g} s")


def placed(author: Surface, space: Space) -> AuditedSurface:
    """A surface in its space, for use in a block of ``blaming_plugins``.

    Raises:
        PluginFault: it did not return a surface for this space.
    """
    found = author.placed(space)
    _require_methods(author, found, "returned {} from placed")
    return AuditedSurface(author, found)


def _require_methods(author: Surface, found: object, what: str) -> None:
    for method in ("distance", "velocity", "fastest", "present"):
        if not callable(getattr(found, method, None)):
            raise PluginFault(author, f"{what.format(described(found))}; it must have the method {method}")


def require_contact(author: Contact) -> None:
    """Raise PluginFault if the class attributes of a contact cannot be used."""
    if author.parity not in get_args(Parity):
        allowed = " or ".join(f"'{name}'" for name in get_args(Parity))
        raise PluginFault(author, f"has the parity {author.parity!r}; it must be {allowed}")
    require_truth(author, "pulls", author.pulls)
    try:
        initial_memory(author, 1)
    except ValueError as error:
        raise PluginFault(author, f"has a memory that {error}") from None


def call_contact(author: Contact, nodes: ContactNodes, dt: float | None = None) -> None:
    """Call ``mapped`` of a contact, or ``solved`` if a step ``dt``, s, is given.

    Raises:
        PluginFault: it returned a value, replaced an array, or wrote a velocity or a memory that is not
            finite although all were finite before.
    """
    velocity, kept = nodes.velocity, dict(nodes.memory)
    sound = np.isfinite(velocity).all()
    what, returned = _act(author, nodes, dt)
    if returned is not None:
        raise PluginFault(
            author, f"returned {described(returned)} from {what}; it must write into nodes.velocity"
        )
    if nodes.velocity is not velocity:
        raise PluginFault(author, f"replaced nodes.velocity in {what}; it must write into the array there")
    if nodes.memory.keys() != kept.keys() or any(nodes.memory[name] is not kept[name] for name in kept):
        raise PluginFault(
            author, f"replaced an array of nodes.memory in {what}; it must write into those there"
        )
    if sound and not np.isfinite(velocity).all():
        raise PluginFault(author, f"gave a velocity in {what} that is not finite")
    for name, array in nodes.memory.items():
        if sound and not np.isfinite(array).all():
            raise PluginFault(author, f"gave its memory '{name}' in {what} a value that is not finite")


def rehearse_contact(author: Contact, nodes: ContactNodes, dt: float | None = None) -> None:
    """``call_contact`` on copies of a sample of the nodes.

    Raises:
        PluginFault: it wrote to an array that it may only read, to a node that is not touched, or beyond an
            array.
    """
    which = sample(len(nodes.mass))
    read = {
        name: Fenced(getattr(nodes, name)[which], READ)
        for name in ("position", "normal", "wall_velocity", "mass", "inner", "depth", "pressed")
    }
    touched = Fenced(nodes.touched[which], WRITTEN)
    velocity = Fenced(nodes.velocity[which], WRITTEN)
    memory = {name: Fenced(array[which], WRITTEN) for name, array in nodes.memory.items()}
    rehearsed = replace(
        nodes,
        velocity=velocity.rows,
        touched=touched.rows,
        memory={name: array.rows for name, array in memory.items()},
        **{name: array.rows for name, array in read.items()},  # type: ignore[arg-type]
    )
    call_contact(author, rehearsed, dt)
    require_unchanged(author, {**read, "touched": touched})
    require_intact(author, {"velocity": velocity, **{f"memory '{name}'": a for name, a in memory.items()}})
    free = ~nodes.touched[which]
    if velocity.rows[free].tobytes() != nodes.velocity[which][free].tobytes():
        raise PluginFault(author, "changed the velocity of a node that no material has reached")


def _act(author: Contact, nodes: ContactNodes, dt: float | None) -> tuple[str, object]:
    if dt is None:
        return "mapped", author.mapped(nodes)  # type: ignore[func-returns-value]
    return "solved", author.solved(nodes, dt)  # type: ignore[func-returns-value]
