"""Contacts: what a wall does to nodes, in numbers."""

import numpy as np
import pytest

from mpmkit.contracts import ContactNodes
from mpmkit.contracts.contact import initial_memory
from mpmkit.registry import installed

CONTACTS = installed().of_kind("contact")
FLOOR = [0.0, 1.0]
LEAN = [-0.6, 0.8]
PARAMETERS = {"coulomb": {"coefficient": 0.1}, "navier-slip": {"slip_length": 0.1}}


def contact(kind, **parameters):
    return CONTACTS[kind].model_validate({"kind": kind, **parameters})


def nodes(author, velocity, normal=FLOOR, wall=(0, 0), inner=(0, 0), depth=0.1, touched=True, pressed=0.0):
    """One node."""
    return ContactNodes(
        position=np.zeros((1, 2)),
        normal=np.array([normal], dtype=float),
        wall_velocity=np.array([wall], dtype=float),
        mass=np.ones(1),
        velocity=np.array([velocity], dtype=float),
        inner=np.array([inner], dtype=float),
        depth=np.array([depth]),
        touched=np.array([touched]),
        pressed=np.array([pressed]),
        memory=initial_memory(author, 1),
    )


def solved(kind, velocity, parameters=None, **more):
    author = contact(kind, **(parameters or {}))
    found = nodes(author, velocity, **more)
    author.solved(found, 1e-3)
    return found.velocity[0].tolist()


@pytest.mark.parametrize(
    ("kind", "parameters", "velocity", "after"),
    [
        ("slip", {}, [3, -2], [3, 0]),  # pushes
        ("slip", {}, [3, 2], [3, 2]),  # lets go
        ("stick", {}, [3, -2], [0, 0]),
        ("stick", {}, [3, 2], [0, 0]),  # holds
        ("stick", {"releases": True}, [3, 2], [3, 2]),
        ("stick", {"releases": True}, [3, -2], [0, 0]),
        ("coulomb", {"coefficient": 0.5}, [3, -2], [2, 0]),  # the drag takes half of the push
        ("coulomb", {"coefficient": 0.5}, [-3, -2], [-2, 0]),
        ("coulomb", {"coefficient": 0.5}, [0.5, -2], [0, 0]),  # and no more than there is
        ("coulomb", {"coefficient": 0.5}, [3, 2], [3, 2]),
        ("coulomb", {"coefficient": 0.0}, [3, -2], [3, 0]),
    ],
)
def test_what_a_floor_does(kind, parameters, velocity, after):
    assert solved(kind, velocity, parameters) == pytest.approx(after, abs=1e-15)


@pytest.mark.parametrize(
    ("velocity", "pressed", "after"),
    [
        ([3, -2], 1.0, [1.5, 0]),  # half of 2 and of what else the wall gives
        ([3, -2], -1.0, [2.5, 0]),  # of which neighbours, or what is mirrored, may take a part
        ([3, -2], -5.0, [3, 0]),
        ([3, 2], 1.0, [2.5, 2]),
        ([3, 2], -1.0, [3, 2]),
    ],
)
def test_drag_counts_all_that_the_wall_pushes_with(velocity, pressed, after):
    found = solved("coulomb", velocity, {"coefficient": 0.5}, pressed=pressed)
    assert found == pytest.approx(after, abs=1e-15)


def test_along_the_normal_and_against_the_wall():
    """An inclined, moving wall: only the component of v - w along n changes."""
    n, t, w = np.array(LEAN), np.array([0.8, 0.6]), np.array([5.0, -1.0])
    found = solved("coulomb", w - 2 * n + 3 * t, {"coefficient": 0.25}, normal=LEAN, wall=w)
    np.testing.assert_allclose(found, w + 2.5 * t, atol=1e-15)
    np.testing.assert_allclose(solved("stick", [1, 1], normal=LEAN, wall=w), w)


@pytest.mark.parametrize(
    ("length", "inner", "velocity", "slip"),
    [
        (0.0, 4.0, 3.0, 0.0),  # sticks
        (0.1, 4.0, 3.0, 2.0),  # u(y) b / (b + y), with b = y
        (0.3, 4.0, 3.5, 3.0),
        (0.3, 4.0, 1.0, 1.0),  # a wall does not speed up what is slower
        (1e9, 4.0, 4.0, 4.0),  # slips
        (0.1, 4.0, -3.0, 0.0),  # and does not turn it round
    ],
)
def test_navier_slip(length, inner, velocity, slip):
    found = solved("navier-slip", [velocity, -2], {"slip_length": length}, inner=[inner, 7])
    assert found == pytest.approx([slip, 0], abs=1e-7)


def test_navier_slip_comes_to_the_slip_of_couette_flow():
    """Couette flow of a Newtonian fluid: the slip velocity at the wall is U b / (b + h)."""
    author = contact("navier-slip", slip_length=0.05)
    y = np.linspace(0, 0.1, 6)
    u = np.zeros(6)
    h, nu, dt = y[1], 1.0, 1e-4
    node = nodes(author, [0, 0], depth=h)
    for _ in range(4000):
        u[-1] = 1.0
        flux = np.diff(u) / h
        u[1:-1] += dt * nu * np.diff(flux) / h
        node.velocity[0] = [u[0] + dt * nu * flux[0] / (h / 2), -1e-3]
        node.inner[0] = [u[1], 0]
        author.solved(node, dt)
        u[0] = node.velocity[0, 0]
    np.testing.assert_allclose(u, (y + 0.05) / 0.15, atol=1e-3)


@pytest.mark.parametrize("kind", ["slip", "coulomb", "navier-slip", "stick"])
def test_contact_is_decided_once_a_step(kind):
    """A pushed node stays held until the next decision, and a released node stays free."""
    parameters = {
        "coulomb": {"coefficient": 0.1},
        "navier-slip": {"slip_length": 0.1},
        "stick": {"releases": True},
    }
    author = contact(kind, **parameters.get(kind, {}))
    node = nodes(author, [0, -1])
    author.solved(node, 1e-3)
    assert node.memory["contact"].tolist() == [1]
    node.velocity[0] = [0, 1]
    author.mapped(node)
    assert node.velocity[0].tolist() == [0, 0]
    node.velocity[0] = [0, 1]
    author.solved(node, 1e-3)
    assert node.memory["contact"].tolist() == [0]
    node.velocity[0] = [0, -1]
    author.mapped(node)
    assert node.velocity[0].tolist() == [0, -1]


@pytest.mark.parametrize("kind", ["slip", "coulomb", "navier-slip", "stick"])
def test_what_is_not_touched_is_forgotten(kind):
    author = contact(kind, **PARAMETERS.get(kind, {}))
    node = nodes(author, [0, -1], touched=False)
    node.memory["contact"][:] = 1
    author.mapped(node)
    author.solved(node, 1e-3)
    assert node.velocity[0].tolist() == [0, -1]
    assert node.memory["contact"].tolist() == [0]


def test_what_contacts_say_of_themselves():
    assert contact("slip").parity == contact("coulomb", coefficient=1.0).parity == "mirror"
    assert contact("stick").parity == "odd"
    assert contact("navier-slip", slip_length=0.0).parity == "odd"
    assert contact("navier-slip", slip_length=0.1).parity == "mirror"
    assert contact("stick").pulls
    assert not contact("stick", releases=True).pulls
