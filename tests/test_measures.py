"""Measures of a scene: lengths of the material in the domain, and energies."""

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


# --- Lengths never exceed the scene


def test_a_box_behind_a_wall_counts_up_to_the_wall():
    particles, measures = scene(x_min="slip", x_max="stick", z_min="slip", z_max="slip")
    particles.position[0] = [0.01, 0.98]
    particles.position[1] = [0.99, 0.02]
    found = measures(particles)
    assert found["spread_diameter"] == 1.0
    assert found["height"] == 1.0


@pytest.mark.parametrize("drawn_out", [1.0, 100.0, 1e6])
def test_a_box_that_strain_has_drawn_out_reaches_no_further_than_half_a_cell(drawn_out):
    """Its ends share no node with the particle any more: the grid knows nothing of material there."""
    particles, measures = scene()
    particles.box[:] *= [drawn_out, 1.0]
    expected = 0.4 if drawn_out == 1.0 else 0.4 - 2 * 0.025 + 0.1
    assert measures(particles)["spread_diameter"] == pytest.approx(expected)
    particles.box[:] *= [1 / drawn_out, drawn_out]
    expected = 0.4 if drawn_out == 1.0 else 0.4 - 0.025 + 0.05
    assert measures(particles)["height"] == pytest.approx(expected)
    # The height on the axis is that of the nodes, to 0.025 cells, where the boxes say something else.
    assert abs(measures(particles)["slump"]) <= 0.025 * 0.1


@pytest.mark.parametrize("stretch", [0.5, 1.0, 1.6, 2.0])
def test_a_body_that_is_drawn_out_evenly_is_measured_exactly(stretch):
    """Up to boxes as long as a cell, four times as long as they are half-sizes here: all there is."""
    particles, measures = scene(x_min="open", z_min="slip")
    particles.position *= [stretch, 1 / stretch]
    particles.position[:, 0] += 0.5 - 0.5 * stretch
    particles.box *= [stretch, 1 / stretch]
    found = measures(particles)
    assert found["spread_diameter"] == pytest.approx(0.4 * stretch, rel=1e-12)
    assert found["height"] == pytest.approx(0.4 / stretch, rel=1e-12)


def test_behind_a_plane_of_symmetry_the_spread_is_twice_what_is_in_the_domain():
    particles, measures = scene(x_min="symmetry", z_min="slip")
    particles.position[:, 0] -= 0.3  # up to the plane
    particles.box[:, 0] = 9.0
    assert measures(particles)["spread_diameter"] == pytest.approx(2 * (0.4 - 0.025 + 0.05))


def test_lengths_of_material_that_is_thrown_about_in_a_tank_stay_in_the_tank():
    """Without a redistribution boxes of a splash are drawn out to many cells."""
    tank = {
        "space": "plane-strain",
        "until": 0.5,
        "grid": {
            "cell_size": 0.05,
            "domain": {"x": [0, 0.6], "z": [0, 0.4]},
            "faces": dict.fromkeys(("x_min", "x_max", "z_min", "z_max"), "slip"),
        },
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0, 0], "upper": [0.2, 0.3]},
                "material": {"law": "newtonian", "density": 1000, "viscosity": 0.1, "sound_speed": 20},
                "velocity": [1.0, 0.0],
            }
        ],
        "scheme": {"redistribution": "none"},
    }
    simulation = Simulation(parse_case(tank))
    p, longest = simulation.particles, 0.0
    while simulation.time < 0.5:
        simulation.advance()
        longest = max(longest, float((p.position + p.box)[:, 0].max() - (p.position - p.box)[:, 0].min()))
        found = simulation.measures(p)
        assert found["spread_diameter"] <= 0.6 * (1 + 1e-12)
        assert found["height"] <= 0.4 * (1 + 1e-12)
    assert longest > 0.61  # boxes alone would say so


# --- The surface by the nodes


@pytest.mark.parametrize("top", [0.2, 0.25, 0.3, 0.45])
def test_a_particle_that_lies_on_the_others_hardly_counts_on_the_axis(top):
    """A flat layer; one particle of the top row, next to the axis, lies a spacing above the others."""
    layer = [SCENE["bodies"][0] | {"shape": {"kind": "box", "lower": [-0.5, 0], "upper": [0.5, top]}}]
    grid = SCENE["grid"] | {"faces": dict.fromkeys(("x_min", "x_max", "z_min"), "slip")}
    simulation = Simulation(parse_case(SCENE | {"grid": grid, "bodies": layer}))
    particles, measures = simulation.particles, simulation.measures
    assert measures(particles)["axis_height"] == pytest.approx(top, rel=1e-12)
    distance = np.hypot(particles.position[:, 0] - 0.475, particles.position[:, 1] - (top - 0.025))
    particles.position[np.argmin(distance), 1] += 0.05
    found = measures(particles)
    assert found["height"] == pytest.approx(top + 0.05)
    # An eighth of the top row within reach is where it should not be, and misses where it was.
    assert found["axis_height"] == pytest.approx(top, abs=0.1 * 0.1)


def test_a_layer_thinner_than_a_cell_has_the_height_of_its_boxes():
    layer = [SCENE["bodies"][0] | {"shape": {"kind": "box", "lower": [-0.2, 0], "upper": [0.2, 0.05]}}]
    simulation = Simulation(parse_case(SCENE | {"bodies": layer}))
    simulation.particles.box[:, 1] *= 0.5
    assert simulation.measures(simulation.particles)["axis_height"] == pytest.approx(0.0375)
