"""Contract of a contact: what a wall allows the material that touches it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np

from .base import Plugin
from .law import StateVariable

Parity = Literal["mirror", "odd"]


@dataclass
class ContactNodes:
    """The k nodes of one wall at which it may act; a contact changes ``velocity`` and ``memory`` in place."""

    position: np.ndarray
    """``(k, dim)``, m, in the coordinates of the case file."""
    normal: np.ndarray
    """``(k, dim)``, n, unit vectors into the material."""
    wall_velocity: np.ndarray
    """``(k, dim)``, w, m/s."""
    mass: np.ndarray
    """``(k,)``, kg: the effective mass for an impulse at this place."""
    velocity: np.ndarray
    """``(k, dim)``, v, m/s, of the material at the wall."""
    inner: np.ndarray
    """``(k, dim)``, m/s, of the material at ``depth`` from the wall, along the normal."""
    depth: np.ndarray
    """``(k,)``, m."""
    touched: np.ndarray
    """``(k,)``, bool: whether material has reached the wall there. Elsewhere the velocity must not change."""
    pressed: np.ndarray
    """``(k,)``, m/s: a push beside that of the contact itself, over the mass, for a contact that
    ``counts_push``. It comes from what is mirrored beyond the wall, and from neighbours, which push the same
    nodes; it is below 0 where they take from it. A drag may count on the sum, where that is above 0."""
    memory: dict[str, np.ndarray] = field(default_factory=dict)
    """``(k,)`` each: the variables that the contact declares, kept for each node from step to step."""
    time: float = 0.0
    """Time at the start of the step, s."""

    def slip(self) -> tuple[np.ndarray, np.ndarray]:
        """u_n = (v - w)·n, m/s, ``(k,)``, and u_t = v - w - u_n n, m/s, ``(k, dim)``: material leaves where
        u_n > 0, and slides with u_t."""
        relative = self.velocity - self.wall_velocity
        away = _dot(relative, self.normal)
        return away, relative - away[:, None] * self.normal

    def tangential(self, velocity: np.ndarray) -> np.ndarray:
        """The part of a velocity against the wall, m/s, ``(k, dim)``, along it: (I - n n)(v - w)."""
        relative = velocity - self.wall_velocity
        return relative - _dot(relative, self.normal)[:, None] * self.normal

    def stop(self, which: np.ndarray) -> None:
        """v_n = w_n at nodes ``which`` (True or False): material neither approaches nor leaves."""
        away, _ = self.slip()
        self.velocity[which] -= away[which, None] * self.normal[which]

    def brake(self, which: np.ndarray, lost: np.ndarray) -> None:
        """v ← v - ``lost`` at nodes ``which`` (True or False); ``lost``, m/s, ``(k, dim)``."""
        self.velocity[which] -= lost[which]


class Contact(Plugin):
    """What a wall allows.

    In a case it is at ``walls.<name>.contact``, by its name or as ``{"kind": name, …parameters}``. It
    acts twice in a step. Only the velocity of nodes that are touched may change, and the impulse that the
    wall gives is the mass times that change. It depends on v - w alone, and adds no kinetic energy relative
    to the wall.
    """

    named_by: ClassVar[str] = "kind"

    parity: ClassVar[Parity] = "mirror"
    """How the velocity is continued beyond the wall: ``mirror`` reverses its normal part against the wall,
    ``odd`` all of it, as for material that sticks."""
    pulls: ClassVar[bool] = False
    """Whether it may hold material that would leave."""
    counts_push: ClassVar[bool] = False
    """Whether it reads ``pressed`` of its nodes, as friction proportional to the push; else that is zero."""
    memory: ClassVar[Mapping[str, StateVariable]] = {}
    """Variables that it keeps at each node, one number each; they start at ``initial``."""

    @abstractmethod
    def mapped(self, nodes: ContactNodes) -> None:
        """Constrain the velocities that the particles have given to the nodes, before the forces act."""

    @abstractmethod
    def solved(self, nodes: ContactNodes, dt: float) -> None:
        """Constrain the velocities after the momentum equation of a step of ``dt`` s, and decide what is in
        contact."""


def initial_memory(contact: Contact, count: int) -> dict[str, np.ndarray]:
    """The memory of so many nodes that no material has touched yet, ``(count,)`` each.

    Raises:
        ValueError: a variable has no value there.
    """
    return {name: np.full(count, variable.at_start(contact)) for name, variable in contact.memory.items()}


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)
