"""Measures of a scene: of the material in the domain, and with a potential where there is one."""

import numpy as np
import pytest

from mpmkit.case import parse_case
from mpmkit.solver.simulation import Simulation

SCENE = {
    "space": "plane-strain",
    "until": 1.0,
    "gravity": [3.0, -9.0],
    "grid": {
        "cell_size": 0.1,
        "domain": {"x": [-0.5, 0.5], "z": [0, 1]},
        "faces": {"z_min": "slip", "x_min": "slip"},
    },
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [-0.2, 0], "upper": [0.2, 0.4]},
            "material": {"law": "newtonian", "density": 1000, "viscosity": 1, "sound_speed": 10},
        }
    ],
}
PERIODIC = {"z_min": "slip", "x_min": "periodic", "x_max": "periodic"}


def scene(**faces):
    grid = SCENE["grid"] | ({"faces": faces} if faces else {})
    simulation = Simulation(parse_case(SCENE | {"grid": grid}))
    return simulation.particles, simulation.measures


@pytest.mark.parametrize("position", [[9e5, 0.2], [0.5, 9e5], [-1e-9, 0.2], [np.nan, 0.2], [0.5, np.inf]])
def test_a_particle_that_has_left_is_not_measured(position):
    particles, measures = scene()
    particles.position[0] = position  # from the corner of the domain
    found = measures(particles)
    assert found["spread_diameter"] == pytest.approx(0.4)
    assert found["height"] == found["axis_height"] == pytest.approx(0.4)


def test_where_nothing_is_left_there_is_no_length():
    particles, measures = scene()
    particles.position[:] = np.nan
    found = measures(particles)
    assert np.isnan([found[name] for name in ("spread_diameter", "height", "axis_height", "slump")]).all()


def test_a_step_over_a_periodic_face_is_not_out_of_the_domain():
    particles, measures = scene(**PERIODIC)
    particles.position[:, 0] += 0.9
    assert measures(particles)["height"] == pytest.approx(0.4)


@pytest.mark.parametrize(("faces", "along"), [({}, 3.0), (PERIODIC, 0.0)])
def test_gravity_along_a_periodic_axis_has_no_potential(faces, along):
    particles, measures = scene(**faces)
    before = measures(particles)["potential_energy"]
    particles.position += [0.05, 0.02]
    mass = 1000 * 0.4 * 0.4
    assert measures(particles)["potential_energy"] - before == pytest.approx(mass * (9 * 0.02 - along * 0.05))
