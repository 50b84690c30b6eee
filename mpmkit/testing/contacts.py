"""What every contact must do, on nodes of a wall in all kinds of motion."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from itertools import product

import numpy as np

from ..contracts import Contact, ContactNodes
from ..contracts.contact import initial_memory
from ..registry import audit
from .violation import require_all, require_close, require_same

DIMS = (2, 3)
K = 400
"""Nodes of a wall."""
DT = 1e-4
"""s, of a step."""
ROUNDING = 1e-12
"""Of velocities, m/s, of the order of one."""
WITH_THE_WALL = 40
"""Nodes that move with the wall."""


def nodes_of(contact: Contact, dim: int, seed: int = 0) -> ContactNodes:
    """Nodes of a wall: some are not touched, some do not slide, some move with the wall.

    They have a memory of one step, in which they moved otherwise.
    """
    rng = np.random.default_rng(seed)
    normal = rng.standard_normal((K, dim))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    wall, velocity, inner, before = rng.standard_normal((4, K, dim))
    velocity[:WITH_THE_WALL] = wall[:WITH_THE_WALL]
    velocity[40:80] = wall[40:80] + rng.standard_normal((40, 1)) * normal[40:80]
    inner[60:100] = wall[60:100]
    nodes = ContactNodes(
        position=rng.uniform(-1, 1, (K, dim)),
        normal=normal,
        wall_velocity=wall,
        mass=10 ** rng.uniform(-6, 2, K),
        velocity=before,
        inner=inner,
        depth=10 ** rng.uniform(-4, -1, K),
        touched=rng.uniform(size=K) < 0.7,
        pressed=rng.uniform(-0.5, 0.5, K),
        memory=initial_memory(contact, K),
    )
    audit.call_contact(contact, nodes, DT)
    nodes.velocity[:] = velocity
    return nodes


def acted(contact: Contact, nodes: ContactNodes, dt: float | None) -> ContactNodes:
    """Copies of nodes after a call of the contact, of ``mapped`` without a ``dt``."""
    after = deepcopy(nodes)
    audit.call_contact(contact, after, dt)
    return after


def situations(contact: Contact) -> Iterator[tuple[ContactNodes, float | None, str]]:
    """Nodes in each dimension, before ``mapped`` and before ``solved``: nodes, step, and which it is."""
    for dim in DIMS:
        yield nodes_of(contact, dim), None, "mapped"
        yield nodes_of(contact, dim), DT, "solved"


def declares(contact: Contact) -> None:
    """Its parity, whether it pulls, and a memory that has a beginning."""
    audit.require_contact(contact)


def arrays(contact: Contact) -> None:
    """It writes finite numbers into velocity and memory alone, and only where material touches the wall."""
    for nodes, dt, what in situations(contact):
        audit.rehearse_contact(contact, nodes, dt)
        after, free = acted(contact, nodes, dt), ~nodes.touched
        require_same(
            after.velocity[free],
            nodes.velocity[free],
            lambda p, a, w=what: f"component {a} of the velocity of a node that nothing touches, after {w},",
        )


def extremes(contact: Contact) -> None:
    """Finite impulses: at rest and at any speed, in a short and in a long step, with hardly any mass."""
    for dim in DIMS:
        for scale, dt in product((0.0, 1e-150, 1e6), (None, 1e-12, 1.0)):
            nodes = nodes_of(contact, dim)
            for name in ("wall_velocity", "velocity", "inner"):
                getattr(nodes, name)[:] *= scale
            nodes.mass[:] = 1e-30
            after = acted(contact, nodes, dt)
            impulse = nodes.mass[:, None] * (after.velocity - nodes.velocity)
            require_all(
                np.isfinite(impulse), lambda *at, s=scale: f"an impulse at speeds of {s:g} m/s is not finite"
            )


def energy(contact: Contact) -> None:
    """Relative to the wall, no node gains kinetic energy."""
    for nodes, dt, what in situations(contact):
        after = acted(contact, nodes, dt)
        before, now = (
            ((velocity - nodes.wall_velocity) ** 2).sum(axis=1) / 2
            for velocity in (nodes.velocity, after.velocity)
        )
        require_all(
            now <= before + ROUNDING,
            lambda p, b=before, n=now, w=what: (
                f"{w} raises the kinetic energy relative to the wall from {b[p]:.6g} to {n[p]:.6g} J/kg"
            ),
            now - before,
        )


def pushes_only(contact: Contact) -> None:
    """After the momentum equation it does not pull, unless it says so."""
    if contact.pulls:
        return
    for dim in DIMS:
        nodes = nodes_of(contact, dim)
        after = acted(contact, nodes, DT)
        push = ((after.velocity - nodes.velocity) * nodes.normal).sum(axis=1)
        require_all(
            push >= -ROUNDING,
            lambda p, f=push: (
                f"it pulls: it changes the velocity along the normal by {f[p]:.6g} m/s; one that is to do so "
                "says pulls = True"
            ),
            -push,
        )


def objectivity(contact: Contact) -> None:
    """In a turned frame it does the same, turned."""
    for nodes, dt, what in situations(contact):
        dim = nodes.velocity.shape[1]
        Q, _ = np.linalg.qr(np.random.default_rng(3).standard_normal((dim, dim)))
        turned = deepcopy(nodes)
        for name in ("position", "normal", "wall_velocity", "velocity", "inner"):
            setattr(turned, name, getattr(nodes, name) @ Q.T)
        after = acted(contact, nodes, dt)
        _require_alike(acted(contact, turned, dt), after.velocity @ Q.T, after, f"{what} in a turned frame")


def galilei(contact: Contact) -> None:
    """Where wall and material move on together, it does the same."""
    for nodes, dt, what in situations(contact):
        ahead = np.array([3.0, -7.0, 5.0])[: nodes.velocity.shape[1]]
        moving = deepcopy(nodes)
        for name in ("wall_velocity", "velocity", "inner"):
            getattr(moving, name)[:] += ahead
        after = acted(contact, nodes, dt)
        _require_alike(acted(contact, moving, dt), after.velocity + ahead, after, f"{what} in a moving frame")


def batch_order(contact: Contact) -> None:
    """Nodes do not know each other, nor the calls before: in another order each gets the same, to the bit."""
    order = np.random.default_rng(2).permutation(K)
    for nodes, dt, what in situations(contact):
        arrays_ = {n: array[order] for n, array in vars(nodes).items() if isinstance(array, np.ndarray)}
        memory = {name: array[order] for name, array in nodes.memory.items()}
        after = acted(contact, nodes, dt)
        found = acted(contact, ContactNodes(**arrays_, memory=memory, time=nodes.time), dt)
        for name, array in {"velocity": found.velocity, **found.memory}.items():
            expected = after.velocity if name == "velocity" else after.memory[name]
            require_same(
                array,
                expected[order],
                lambda *at, n=name, w=what: f"the {n} of a node that is handed over in another order to {w}",
            )


def _require_alike(found: ContactNodes, velocity: np.ndarray, after: ContactNodes, what: str) -> None:
    """The velocity that is expected, and the memory except at the first nodes: those move with the wall to
    rounding only, and may come out on either side of a decision."""
    require_close(
        found.velocity,
        velocity,
        10 * ROUNDING,
        lambda p, a: f"component {a} of the velocity of a node, after {what},",
        "m/s",
    )
    for name, array in after.memory.items():
        require_close(
            found.memory[name][WITH_THE_WALL:],
            array[WITH_THE_WALL:],
            1e-9 * max(1.0, float(np.abs(array).max())),
            lambda p, n=name: f"the memory '{n}' of a node, after {what},",
        )
