"""Diagnostics and particle fields: their values, where these are written, and faulty plug-ins."""

from __future__ import annotations

import json

import numpy as np
import pytest
from test_milestones import CAKE

import mpmkit
from mpmkit.contracts import Column, Diagnostic, ParticleField
from mpmkit.errors import CaseError, GuardStop
from mpmkit.output import read_frame, read_frames
from mpmkit.registry import Registered, Registry, installed
from mpmkit.solver.observation import Observation
from mpmkit.solver.simulation import Simulation

TANK = {
    "space": "plane-strain",
    "until": 0.01,
    "grid": {
        "cell_size": 0.02,
        "domain": {"x": [-0.1, 0.3], "z": [0.1, 0.5]},
        "faces": {"x_min": "slip", "x_max": "slip", "z_min": "slip"},
    },
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [-0.1, 0.1], "upper": [0.3, 0.3]},
            "material": {"law": "newtonian", "density": 1000, "viscosity": 1, "sound_speed": 20},
        }
    ],
    "output": {"report": False},
}
"""Water that rests from wall to wall, and begins with the pressure of its weight; 0.2 m deep."""


def tank(registry=None, **output):
    return mpmkit.parse_case(TANK | {"output": {"report": False} | output}, registry=registry)


def made(kind, **parameters):
    return installed().of_kind("diagnostic")[kind].model_validate({"kind": kind, **parameters})


def rested():
    """After a step, in which the pressure of the weight comes to the particles."""
    simulation = Simulation(tank())
    simulation.advance()
    return simulation


def test_a_probe_is_exact_for_what_is_linear_in_space():
    simulation = Simulation(tank())
    p = simulation.particles
    p.velocity[:] = p.position @ np.array([[1.0, 0.5], [-2.0, 0.0]]) + [0.1, 0.2]
    for at in ([0.1, 0.2], [0.0123, 0.2871], [0.3, 0.1]):  # in the middle, off the lattice, in a corner
        found = made("probe", at=at).measure(Observation(simulation))
        exact = (np.array(at) - simulation.grid.lower) @ np.array([[1.0, 0.5], [-2.0, 0.0]]) + [0.1, 0.2]
        assert [found["velocity_x"], found["velocity_z"]] == pytest.approx(exact, rel=1e-9)
    outside = made("probe", at=[0.1, 0.4]).measure(Observation(simulation))
    assert all(np.isnan(value) for value in outside.values())


def test_a_probe_finds_the_pressure_of_the_weight():
    found = made("probe", at=[0.1, 0.15]).measure(Observation(rested()))
    assert found["pressure"] == pytest.approx(1000 * 9.81 * 0.15, rel=1e-2)


def test_the_flux_of_a_block_that_moves_is_its_area_times_its_speed():
    simulation = Simulation(tank())
    simulation.particles.velocity[:] = [0.5, 0.0]
    for at in (0.1, 0.1077):  # on the lattice and off it
        found = made("flux", axis="x", at=at).measure(Observation(simulation))
        assert found["mass_flux"] == pytest.approx(1000 * 0.2 * 0.5, rel=1e-9)
        ratio = simulation.particles.volume_ratio.mean()  # the weight has compressed it by some 0.1 %
        assert found["volume_flux"] == pytest.approx(0.2 * 0.5 * ratio, rel=1e-3)
    assert made("flux", axis="z", at=0.2).measure(Observation(simulation))["mass_flux"] == 0


def test_the_flux_along_r_is_through_a_cylinder():
    data = CAKE | {"bodies": [CAKE["bodies"][0] | {"velocity": [1.0, 0.0]}]}
    simulation = Simulation(mpmkit.parse_case(data))
    found = made("flux", axis="r", at=0.12).measure(Observation(simulation))
    assert found["mass_flux"] == pytest.approx(2000 * 2 * np.pi * 0.12 * 0.1, rel=2e-2)


def test_the_largest_pressure_is_that_at_the_foot():
    scene = Observation(rested())
    floor, side = (made("largest-pressure", wall=w).measure(scene) for w in ("z_min", "x_min"))
    foot = 1000 * 9.81 * 0.195  # of the lowest row, which is 5 mm up
    assert floor["mean"] == pytest.approx(foot, rel=0.03)
    assert side["largest"] == pytest.approx(foot, rel=0.03)
    assert side["mean"] == pytest.approx(1000 * 9.81 * 0.1, rel=0.01)
    assert np.isnan(made("largest-pressure", wall="z_max").measure(scene)["largest"])


def test_history_frames_and_conditions_have_them(tmp_path):
    output = {
        "report": False,
        "diagnostics": {"gauge": {"kind": "probe", "at": [0.1, 0.15]}},
        "fields": {"thick": "apparent-viscosity"},
        "particle_history": ["thick", "position"],
    }
    data = TANK | {"output": output, "until": {"gauge.pressure": {"at_least": 1}, "at_most": 1.0}}
    history = mpmkit.run(mpmkit.parse_case(data), tmp_path / "run")
    assert history["gauge.pressure"].attrs == {"units": "Pa", "long_name": "pressure at (0.1, 0.15) m"}
    assert history.thick.attrs == {"units": "Pa s", "long_name": "apparent viscosity"}
    assert history.thick.dims == ("time", "particle")
    sheared = history.thick.values[-1][np.isfinite(history.thick.values[-1])]
    assert len(sheared) > 0
    assert sheared == pytest.approx(1.0)
    assert history.attrs["stopped_because"] == "condition"
    assert history.time.values[-1] < 0.1
    frame = read_frame(read_frames(tmp_path / "run/frames")[-1][1])
    assert frame["thick"].shape == (len(frame["particle"]),)
    with mpmkit.output.netcdf.read_dataset(tmp_path / "run/history.nc") as written:
        assert "gauge.shear_rate" in written
    kinds = {(entry["kind"], entry["name"]) for entry in json.loads(history.attrs["plugins"])}
    assert {("diagnostic", "probe"), ("particle_field", "apparent-viscosity")} <= kinds


@pytest.mark.parametrize(
    ("output", "sentence"),
    [
        (
            {"diagnostics": {"g": {"kind": "probe", "at": [0, 0, 0]}}},
            "output.diagnostics.g: at is [0.0, 0.0, 0.0]",
        ),
        ({"diagnostics": {"g": {"kind": "prob", "at": [0, 0]}}}, 'did you mean "probe"?'),
        ({"diagnostics": {"a.b": {"kind": "probe", "at": [0, 0]}}}, 'the name "a.b"; it must be of letters'),
        ({"diagnostics": {"g": {"kind": "flux", "axis": "y", "at": 0}}}, "has the axes x, z"),
        ({"diagnostics": {"g": {"kind": "largest-pressure", "wall": "mould"}}}, "one of x_min, x_max, z_min"),
        ({"fields": {"pressure": "apparent-viscosity"}}, "which another particle field has"),
        ({"particle_history": ["thick"]}, 'output.particle_history.0 is "thick"'),
    ],
)
def test_a_wrong_diagnostic_has_its_sentence(output, sentence):
    with pytest.raises(CaseError) as error:
        tank(**output)
    assert sentence in str(error.value)


class Broken(Diagnostic):
    """Whose columns and numbers are what the test makes them."""

    name, citation, api_version = "broken", "none", 2
    of_columns, of_measure = staticmethod(lambda: None), staticmethod(lambda scene: None)

    def columns(self, space):
        return type(self).of_columns()

    def measure(self, scene):
        return type(self).of_measure(scene)


class Rooted(ParticleField):
    """Of what may be negative."""

    name, citation, api_version = "rooted", "none", 2
    unit, long_name = "1", "nothing"

    def values(self, scene):
        return np.zeros(3)


def registry():
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    found += [Registered("diagnostic", Broken, "tests", "1", "broken")]
    return Registry([*found, Registered("particle_field", Rooted, "tests", "1", "rooted")], [])


X = [Column("x", "m", "a length")]


@pytest.mark.parametrize(
    ("columns", "measure", "sentence"),
    [
        (lambda: None, None, "returned None from columns; it must be a list of Column"),
        (lambda: [Column("X y", "m", "")], None, "has a column of the name 'X y'; it must be of lower-case"),
        (lambda: X + X, None, "has two columns of the name 'x'"),
        (lambda: X, lambda s: {"y": 1.0}, "returned ['y'] from measure; it must be a number for each of x"),
        (lambda: X, lambda s: {"x": "far"}, "as x; it must be a number"),
        (lambda: X, lambda s: {"x": 1 / 0}, "raised ZeroDivisionError"),
        (lambda: X, lambda s: s.mass.__imul__(2), "raised ValueError: output array is read-only"),
        (lambda: X, lambda s: s.wall_distance("mould"), "asked for the wall 'mould'; there are: x_min"),
        (lambda: X, lambda s: s.state("age"), "asked for the state 'age', which no law has; there are: none"),
    ],
)
def test_a_faulty_diagnostic_is_named(monkeypatch, columns, measure, sentence):
    monkeypatch.setattr(Broken, "of_columns", staticmethod(columns))
    monkeypatch.setattr(Broken, "of_measure", staticmethod(measure))
    with pytest.raises(GuardStop) as stop:
        mpmkit.run(tank(registry(), diagnostics={"b": "broken"}))
    assert "the plug-in 'broken' (diagnostic)" in str(stop.value)
    assert sentence in str(stop.value)


def test_a_faulty_particle_field_is_named():
    case = tank(registry(), fields={"r": "rooted"}, particle_history=["r"])
    with pytest.raises(
        GuardStop, match=r"'rooted' \(particle field\) returned an array of .* from values; it must"
    ):
        mpmkit.run(case)
