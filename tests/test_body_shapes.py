"""A body shape of a third party needs bounds and a distance, and serves as body, mould and obstacle."""

from __future__ import annotations

import numpy as np
import pytest

from mpmkit.case import case_model, parse_case
from mpmkit.case.plugins import plugins_of
from mpmkit.contracts import BodyShape, quantity
from mpmkit.errors import CaseError, PluginStop
from mpmkit.geometry import shared_volume
from mpmkit.plan import plan
from mpmkit.registry import Registered, Registry, audit, installed
from mpmkit.solver.scene import make_particles
from mpmkit.solver.simulation import Simulation
from mpmkit.spaces import SPACES

FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 1.0, "sound_speed": 10.0}


class Ball(BodyShape):
    """A ball with a distance function only."""

    name = "ball-of-the-tests"
    api_version = 2
    citation = "none"

    centre: list[float] = quantity("m", "centre")
    radius: float = quantity("m", "radius", gt=0)

    def problem(self, space):
        return (
            None if len(self.centre) == space.dim else f"centre is {self.centre}, not of {space.dim} numbers"
        )

    def bounds(self, space):
        lower, upper = np.array(self.centre) - self.radius, np.array(self.centre) + self.radius
        if space.radial:
            lower[0] = 0.0
        return lower, upper

    def signed_distance(self, x, space):
        return np.linalg.norm(x - self.centre, axis=1) - self.radius


def with_shape(plugin):
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    return Registry([*found, Registered("body_shape", plugin, "tests", "1", plugin.name)], [])


def scene(kind, space="plane-strain", plugin=Ball):
    """A ball in a bowl of the same shape, above an obstacle of it."""
    middle = [0.0, 0.3] if space == "axisymmetric" else [0.5, 0.3]
    centre = middle if space != "3d" else [0.5, 0.5, 0.3]

    def ball(radius, shift=0.0):
        return {"kind": kind, "centre": [*centre[:-1], centre[-1] + shift], "radius": radius}

    axes = SPACES[space].axes
    body, bowl = {"kind": "body", "side": "outside"}, {"kind": "body", "side": "inside", "thickness": 0.06}
    return parse_case(
        {
            "space": space,
            "until": 0.1,
            "grid": {"cell_size": 0.05, "domain": {axis: [0, 1] for axis in axes}},
            "bodies": [{"shape": ball(0.1), "material": FLUID}],
            "walls": {
                "bowl": {"surface": bowl | {"shape": ball(0.25)}, "contact": "slip"},
                "stone": {"surface": body | {"shape": ball(0.08, -0.19)}, "contact": "stick"},
            },
        },
        registry=with_shape(plugin),
    )


@pytest.mark.parametrize("space", SPACES)
def test_it_is_the_same_body_mould_and_obstacle_as_the_built_in_sphere(space):
    mine, known = scene(Ball.name, space), scene("sphere", space)
    particles, expected = make_particles(mine), make_particles(known)
    np.testing.assert_allclose(particles.position, expected.position, atol=1e-9)
    np.testing.assert_allclose(particles.volume, expected.volume, rtol=1e-4)
    assert particles.volume.sum() == pytest.approx(expected.volume.sum(), rel=5e-5)
    x = np.random.default_rng(0).uniform(0, 0.8, (200, mine.space_.dim))
    for name in ("bowl", "stone"):
        walls = [audit.placed(case.walls[name].surface, case.space_) for case in (mine, known)]
        (distance, normal), (found, direction) = (wall.distance(x, 0.0) for wall in walls)
        np.testing.assert_allclose(distance, found, atol=1e-12)
        np.testing.assert_allclose(normal, direction, atol=1e-5)
        assert walls[0].thickness == pytest.approx(walls[1].thickness)
    assert [kind for kind, _ in plugins_of(mine)].count("body_shape") == 3


def test_a_scene_with_it_runs_as_with_the_sphere():
    runs = [Simulation(scene(kind)) for kind in (Ball.name, "sphere")]
    for simulation in runs:
        for _ in range(10):
            simulation.advance()
        simulation.check()
    np.testing.assert_allclose(runs[0].particles.position, runs[1].particles.position, atol=1e-8)


def test_two_shapes_that_overlap_are_known_to():
    one, other = Ball(centre=[0.0, 0.0], radius=0.1), Ball(centre=[0.15, 0.0], radius=0.1)
    lens = 2 * 0.1**2 * np.arccos(0.75) - 0.15 / 2 * np.sqrt(4 * 0.1**2 - 0.15**2)
    bounds = np.full(2, -1.0), np.full(2, 1.0)
    found = shared_volume(one, other, SPACES["plane-strain"], np.full(2, 0.005), bounds)
    assert found == pytest.approx(lens, rel=0.02)


@pytest.mark.parametrize(
    ("space", "volume", "size"),
    [
        ("3d", 4 / 3 * np.pi * 0.2**3, 4 / 3 * np.pi * 0.2**3),
        ("plane-strain", np.pi * 0.2**2, np.pi * 0.2**2),
        ("axisymmetric", 4 / 3 * np.pi * 0.2**3, np.pi * 0.2**2 / 2),
    ],
)
def test_its_volume_is_computed_from_the_distance(space, volume, size):
    space = SPACES[space]
    ball = Ball(centre=[0.0] * space.dim, radius=0.2)
    rel = 5e-5 if space.dim == 3 else 1e-7
    assert ball.volume(space) == pytest.approx(volume, rel=rel)
    assert ball.size(space) == pytest.approx(size, rel=rel)
    lower, upper = ball.bounds(space)
    middle = (lower + upper) / 2
    assert ball.part(np.append(lower[:-1], middle[-1]), upper, space) == pytest.approx(volume / 2, rel=rel)
    assert ball.part(upper, upper + 1, space) == 0


def test_a_wrong_parameter_has_its_sentence():
    case = scene("sphere").model_dump(mode="json", exclude_unset=True)
    case["walls"]["bowl"]["surface"]["shape"]["kind"] = "bal"
    with pytest.raises(CaseError, match=r'walls\.bowl\.surface\.shape\.kind is "bal"; it must be'):
        parse_case(case, registry=with_shape(Ball))
    for where in ("bodies.0.shape", "walls.bowl.surface.shape"):
        field = where.split(".")[0]
        case = scene(Ball.name).model_dump(mode="json", exclude_unset=True)
        part = case["bodies"][0] if field == "bodies" else case["walls"]["bowl"]["surface"]
        part["shape"]["centre"] = [0.5, 0.3, 0.0]
        with pytest.raises(CaseError, match=rf"{where}: centre is .*not of 2 numbers"):
            parse_case(case, registry=with_shape(Ball))


FAULTS = {
    "bounds": (lambda self, space: np.zeros(2), "from bounds"),
    "problem": (lambda self, space: 3, "from problem"),
    "signed_distance": (lambda self, x, space: np.full(len(x), np.nan), "not finite at"),
    "within": (lambda self, x, space, tolerance: 1.0, "True or False from within"),
    "volume": (lambda self, space: np.inf, "volume"),
    "size": (lambda self, space: "large", "size"),
    "solid": (lambda self, space: 1 / 0, "ZeroDivisionError"),
}


@pytest.mark.parametrize("method", FAULTS)
def test_a_faulty_shape_is_named(method):
    wrong, said = FAULTS[method]
    bad = type("Bad", (Ball,), {method: wrong, "__module__": __name__})
    with pytest.raises(PluginStop) as stop:
        plan(scene(bad.name, plugin=bad))
    assert "the plug-in 'ball-of-the-tests' (body shape)" in str(stop.value)
    assert said in str(stop.value)


def test_its_parameters_are_in_the_schema_of_cases():
    text = str(case_model(with_shape(Ball)).model_json_schema())
    assert text.count("'const': 'ball-of-the-tests'") == 1
