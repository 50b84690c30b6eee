"""Walls in the history and in the energy balance, and walls beside a face of the grid."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray
from walled import FLUID, SLOPE, scene, simulated, wall

import mpmkit
from mpmkit.errors import CaseError
from mpmkit.solver.simulation import Simulation

# --- History ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("space", ["plane-strain", "3d"])
def test_history_of_walls(tmp_path, space):
    """Force, torque and power of each wall, means over the time since the last row."""
    slope = {**SLOPE, "contact": "stick"}
    data = scene({"slope": slope, "lid": wall([0, 0.9], [0, -1.0])}, velocity=(0.0, -1.0))
    if space == "3d":
        data["space"] = "3d"
        data["grid"]["domain"] = {a: [-0.2, 0.8] for a in "xyz"}
        data["walls"]["slope"]["surface"] = {"kind": "plane", "point": [0, 0, 0.15], "normal": [0.1, 0, 1.0]}
        data["walls"]["lid"]["surface"] |= {"point": [0, 0, 0.7], "normal": [0, 0, -1.0]}
        data["bodies"][0] |= {"velocity": [0, 0, -1.0]}
        data["bodies"][0]["shape"] = {"kind": "box", "lower": [0, 0, 0.2], "upper": [0.2, 0.2, 0.3]}
    data |= {"until": 0.1, "output": {"history_interval": 0.02, "report": False}}
    mpmkit.run(mpmkit.parse_case(data), tmp_path / "run")
    with xarray.open_dataset(tmp_path / "run" / "history.nc") as history:
        history.load()
    axes = ("x", "z") if space != "3d" else ("x", "y", "z")
    assert list(history["wall"].values) == ["slope", "lid"]
    force, torque, power = (history[f"wall_{name}"] for name in ("force", "torque", "power"))
    assert (force.dims, force.attrs["units"]) == (("time", "wall", "component"), "N")
    assert torque.dims == ("time", "wall", "about")
    assert torque.attrs["units"] == "N m"
    assert (power.dims, power.attrs["units"]) == (("time", "wall"), "W")
    assert list(history["component"].values) == list(axes)
    assert list(history["about"].values) == (["y"] if space != "3d" else list(axes))
    for variable in (force, torque, power, history["wall"]):
        assert variable.attrs["long_name"]
    assert not force.sel(wall="lid").any()  # far away
    assert float(force.sel(wall="slope", component="z").max()) > 0
    assert (force.isel(time=0) == 0).all()
    whole = Simulation(mpmkit.parse_case(data))
    while whole.time < 0.1 * (1 - 1e-12):
        whole.advance(0.1 - whole.time)
    means = force.sel(wall="slope").values[1:] * np.diff(history["time"].values)[:, None]
    np.testing.assert_allclose(means.sum(axis=0), whole.wall_sums()[0, : len(axes)], rtol=0.02, atol=1e-3)


def test_history_without_walls_has_none(tmp_path):
    data = scene({}) | {"until": 0.01, "output": {"report": False}}
    del data["walls"]
    mpmkit.run(mpmkit.parse_case(data), tmp_path / "run")
    with xarray.open_dataset(tmp_path / "run" / "history.nc") as history:
        assert not [name for name in history.variables if str(name).startswith("wall_force")]
        assert "wall" not in history.dims


# --- Energy -------------------------------------------------------------------------------------------------


def test_a_plate_that_drags_a_fluid_creates_no_energy():
    """The guard counts the work of the wall; the rest is created by the scheme, and must not be positive."""
    drag = {"kind": "velocity", "velocity": [1.0, 0.0]}
    simulation = simulated(
        {
            "plate": wall([0.0, 0.39], [0.0, -1.0], "stick", motion=drag),
            "floor": wall([0.0, 0.21], [0.0, 1.0], "stick"),
        },
        lower=(0.0, 0.21),
        upper=(0.4, 0.39),
        gravity=[0, 0],
        material={**FLUID, "viscosity": 50.0},
    )
    while simulation.time < 0.2:
        simulation.advance()
    simulation.guards.check()
    balance = simulation.guards.balance
    assert simulation.walls_work > 0.1
    assert balance.created <= 1e-9 * simulation.walls_work


# --- Beside a face of the grid ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("face", "contact", "gap"),
    [
        ("slip", "slip", 0.0),
        ("slip", "slip", 5e-5),
        ("slip", "stick", 0.0),
        ("slip", "stick", 5e-5),
        ("stick", "slip", 0.0),
        ("stick", "stick", 0.0),
        ({"kind": "friction", "coefficient": 0.5}, "slip", 0.0),
    ],
)
def test_a_piston_that_starts_at_a_face_throws_nothing(face, contact, gap):
    """The free end of what it pushes moves at no more than twice its speed, as in any impact.

    Found by the fuzz: beside a held node the wall's velocity has to come from the next one alone, of which
    the wall's place has a small part, and which got 1/part times as fast.
    """
    motion = {"kind": "velocity", "velocity": [0.5, 0.0]}
    piston = wall([-0.5 - gap, 0.0], [1.0, 0.0], contact, motion=motion)
    block = {"lower": (-0.5, 0.0), "upper": (-0.2, 0.2), "faces": {"x_min": face}, "gravity": [0.0, 0.0]}
    simulation = simulated({"piston": piston}, **block)
    for _ in range(19):
        simulation.advance()
        assert simulation.particles.velocity[:, 0].max() < 1.1


@pytest.mark.parametrize(("face", "point", "speed"), [("x_min", -0.5, 0.5), ("x_max", 1.0, -0.5)])
def test_no_wall_moves_into_the_scene_from_a_plane_of_symmetry(face, point, speed):
    """The plane would still hold the nodes that the wall has passed."""
    motion = {"kind": "velocity", "velocity": [speed, 0.0]}
    walls = {"piston": wall([point, 0.0], [math.copysign(1, speed), 0.0], "slip", motion=motion)}
    for kind in ("slip", "symmetry"):
        data = scene(walls, faces={face: kind})
        if kind == "slip":
            mpmkit.parse_case(data)
        else:
            sentence = f"piston.surface moves into the scene from {face}, a plane of symmetry"
            with pytest.raises(CaseError, match=sentence):
                mpmkit.parse_case(data)
    along = wall([0.0, 0.1], [0.0, 1.0], "slip", motion=motion)  # its velocity is along itself
    mpmkit.parse_case(scene({"floor": along}, faces={face: "symmetry"}))
