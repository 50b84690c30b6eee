"""A surface or a contact at fault is named, while a case is validated and when it is called."""

import numpy as np
import pytest

from mpmkit.case import parse_case
from mpmkit.case.forewarnings import forewarnings
from mpmkit.contracts import Contact, Surface
from mpmkit.contracts.contact import ContactNodes, initial_memory
from mpmkit.errors import PluginFault, PluginStop
from mpmkit.registry import Registered, Registry, audit, check, installed
from mpmkit.solver.scene import make_particles
from mpmkit.spaces import SPACES

FLAT = SPACES["plane-strain"]
ONE, UP = np.ones(1), np.array([[0.0, 1.0]])

FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 1.0, "sound_speed": 10.0}


class Floor(Surface):
    """z = 0."""

    name = "of-the-tests"
    api_version = 2
    citation = "none"

    def distance(self, x, t):
        return x[:, -1].copy(), np.tile([0.0, 1.0], (len(x), 1))


class Free(Contact):
    """Nothing."""

    name = "of-the-tests"
    api_version = 2
    citation = "none"

    def mapped(self, nodes):
        return

    def solved(self, nodes, dt):
        return


def made(base, method, function):
    return type("Bad", (base,), {method: function, "__module__": __name__})


def read(kind, plugin):
    """A block on a floor with one plug-in of the tests: read, filled, and checked."""
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered(kind, plugin, "tests", "1", plugin.name)], [])
    of_the_tests = {"kind": plugin.name}
    floor = {"surface": {"kind": "plane", "point": [0, 0], "normal": [0, 1]}, "contact": "slip"}
    case = parse_case(
        {
            "space": "plane-strain",
            "until": 1.0,
            "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [-0.2, 1]}},
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]},
                    "material": {
                        "law": "newtonian",
                        "density": 1000.0,
                        "viscosity": 1.0,
                        "sound_speed": 10.0,
                    },
                }
            ],
            "walls": {"floor": floor | {kind: of_the_tests}},
        },
        registry=registry,
    )
    forewarnings(case)
    return make_particles(case)


def blamed(kind, plugin):
    with pytest.raises(PluginStop) as stop:
        read(kind, plugin)
    assert f"the plug-in 'of-the-tests' ({kind})" in str(stop.value)
    return str(stop.value)


def fail(*_):
    raise ValueError("my own")


def test_sound_ones_are_read():
    assert len(read("surface", Floor)) == len(read("contact", Free)) == 64


@pytest.mark.parametrize("method", ["problem", "placed", "distance", "present"])
def test_whatever_a_surface_raises_is_its_own_fault(method):
    assert "raised ValueError: my own (test_wall_faults.py" in blamed("surface", made(Floor, method, fail))


@pytest.mark.parametrize(
    ("method", "returned", "reason"),
    [
        ("problem", 3, "returned a int from problem; it must be a sentence, or None"),
        ("placed", None, "returned nothing from placed; it must have the method distance"),
        ("present", 1, "returned a int from present; it must be True or False"),
        ("distance", None, "returned nothing from distance; it must be a tuple of two arrays"),
        (
            "distance",
            (1.0, UP),
            "returned a float from distance (its first entry); it must be",
        ),
        ("distance", (ONE, UP), "returned an array of shape (1,) from distance (its first entry)"),
    ],
)
def test_what_a_surface_returns(method, returned, reason):
    assert reason in blamed("surface", made(Floor, method, lambda *_: returned))


@pytest.mark.parametrize(
    ("distance", "normal", "reason"),
    [
        (np.nan, 1.0, "gave a distance that is not finite at (0.05, -0.15) m, t = 0 s"),
        (0.0, 2.0, "gave a normal that is not of length 1 at (0.05, -0.15) m, t = 0 s"),
        (0.0, np.nan, "gave a normal that is not of length 1"),
    ],
)
def test_numbers_of_a_surface(distance, normal, reason):
    def both(self, x, t):
        return np.full(len(x), distance), np.tile([0.0, normal], (len(x), 1))

    assert reason in blamed("surface", made(Floor, "distance", both))


@pytest.mark.parametrize(
    ("method", "returned", "reason"),
    [
        ("velocity", np.array([[0.0, np.inf]]), "gave a velocity that is not finite at (0, 1) m, t = 0 s"),
        ("velocity", np.zeros(2), "returned an array of shape (2,) from velocity"),
        ("fastest", np.inf, "gave inf m/s as its fastest"),
        ("fastest", -1.0, "gave -1.0 m/s as its fastest"),
        ("fastest", "fast", "gave the text 'fast' as fastest"),
    ],
)
def test_motion_of_a_surface(method, returned, reason):
    bad = audit.placed(made(Floor, method, lambda *_: returned)(), FLAT)
    arguments = (UP, 0.0) if method == "velocity" else (0.0, 1.0)
    with pytest.raises(PluginFault) as fault:
        getattr(bad, method)(*arguments)
    assert reason in str(fault.value)


def test_a_thickness_that_is_none():
    class Thin(Floor):
        thickness: float = -1.0

    assert "has a thickness of -1.0 m; it must be above 0" in blamed("surface", Thin)


def test_a_surface_without_a_distance_is_not_registered():
    class Nothing(Surface):
        name = "nothing"
        api_version = 2
        citation = "none"

    with pytest.raises(TypeError, match="Nothing lacks distance, which a Surface must have"):
        check(Nothing, "surface")
    check(Floor, "surface")


@pytest.mark.parametrize(("base", "kind"), [(Floor, "surface"), (Free, "contact")])
def test_a_parameter_that_stands_in_the_way_is_refused(base, kind):
    class Kind(base):
        kind: str = "x"

    with pytest.raises(ValueError, match=f"it has a parameter 'kind', which a {kind} cannot have"):
        check(Kind, kind)

    class Name(base):
        label: str = "x"

    check(Name, kind)


@pytest.mark.parametrize(
    ("attribute", "value", "reason"),
    [
        ("parity", "even", "has the parity 'even'; it must be 'mirror' or 'odd'"),
        ("pulls", 1, "returned a int from pulls; it must be True or False"),
    ],
)
def test_what_a_contact_says_of_itself(attribute, value, reason):
    assert reason in blamed("contact", made(Free, attribute, value))


def touching(author):
    return ContactNodes(
        np.zeros((4, 2)),
        np.tile([0.0, 1.0], (4, 1)),
        np.zeros((4, 2)),
        np.ones(4),
        np.ones((4, 2)),
        np.ones((4, 2)),
        np.full(4, 0.1),
        np.array([True, False, True, False]),
        np.zeros(4),
        initial_memory(author, 4),
    )


@pytest.mark.parametrize(
    ("act", "reason"),
    [
        (lambda self, nodes, dt: nodes.velocity, "returned an array of shape (4, 2) from solved"),
        (lambda self, nodes, dt: nodes.velocity.fill(np.nan), "gave a velocity in solved that is not finite"),
        (lambda self, nodes, dt: setattr(nodes, "velocity", ONE), "replaced nodes.velocity in solved"),
        (
            lambda self, nodes, dt: nodes.memory.update(more=ONE),
            "replaced an array of nodes.memory",
        ),
        (
            lambda self, nodes, dt: nodes.velocity.fill(0.0),
            "changed the velocity of a node",
        ),
        (lambda self, nodes, dt: nodes.inner.fill(0.0), "changed 'inner', which it may only read"),
        (lambda self, nodes, dt: nodes.touched.fill(True), "changed 'touched', which it may only read"),
    ],
)
def test_what_a_contact_does(act, reason):
    author = made(Free, "solved", act)()
    with pytest.raises(PluginFault) as fault:
        audit.rehearse_contact(author, touching(author), 1e-3)
    assert reason in str(fault.value)
    assert fault.value.plugin is author
