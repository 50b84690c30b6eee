"""Measurements of a case: in the history, in the summary, and the sentences about wrong ones."""

import json

import numpy as np
import pytest

import mpmkit
from mpmkit.case.measurements import NAMES, TAKEN
from mpmkit.case.resolved import resolved
from mpmkit.errors import CaseError
from mpmkit.running.measuring import measurements
from mpmkit.running.recorder import COLUMNS, wall_columns
from mpmkit.solver.simulation import Simulation

MATERIAL = {
    "law": "bingham-evp",
    "density": 2000,
    "yield_stress": 1e4,
    "plastic_viscosity": 10,
    "sound_speed": 20,
}


def case(space="plane-strain", **measurements):
    """A block 0.1 m wide and 0.05 m high that stands on a floor."""
    axes = {"plane-strain": "xz", "axisymmetric": "rz", "3d": "xyz"}[space]
    upper = [0.1, 0.05] if len(axes) == 2 else [0.1, 0.04, 0.05]
    return {
        "space": space,
        "until": 0.02,
        "grid": {
            "cell_size": 0.01,
            "domain": {axis: [0, 0.04 if axis == "y" else 0.2] for axis in axes},
            "faces": {"z_min": "stick"},
        },
        "bodies": [
            {"shape": {"kind": "box", "lower": [0] * len(axes), "upper": upper}
             if space != "axisymmetric" else {"kind": "cylinder", "radius": 0.1, "height": 0.05},
             "material": MATERIAL}
        ],
        "output": {"report": False, "history_interval": 0.01},
        "measurements": {
            name: {"formula": formula, "unit": unit, "description": name}
            for name, (formula, unit) in measurements.items()
        },
    }  # fmt: skip


@pytest.mark.parametrize("space", ["plane-strain", "axisymmetric", "3d"])
def test_depths_and_the_front_of_a_block_are_its_own(space):
    history = mpmkit.run(
        mpmkit.parse_case(
            case(space, inside=("depth(0.05)", "m"), end=("depth(0)", "m"), edge=("depth(0.1)", "m"),
                 beyond=("depth(0.15)", "m"), tip=("front()", "m"), ratio=("inside / end", "1"))
        )
    )  # fmt: skip
    first = history.isel(time=0)
    if space == "axisymmetric":  # its lattice has boxes of equal sides in r, not of equal volumes
        assert float(first["inside"]) == pytest.approx(0.05, rel=0.02)
    else:
        assert float(first["inside"]) == pytest.approx(0.05, rel=1e-12)
        assert float(first["end"]) == pytest.approx(0.05, rel=1e-12)
        assert float(first["edge"]) == pytest.approx(0.025, rel=1e-12)  # the strip is half empty
    assert float(first["beyond"]) == 0.0
    assert float(first["tip"]) == pytest.approx(0.1, rel=1e-12)
    assert history["ratio"].attrs["units"] == "1"


def test_the_depth_at_a_point_is_that_of_a_step():
    """A block fills one half of the domain along y; a second, of half of its height, the other half."""
    scene = case("3d", high=("depth(0.05, 0.01)", "m"), low=("depth(0.05, 0.035)", "m"),
                 edge=("depth(0.1, 0.02)", "m"))  # fmt: skip
    block = scene["bodies"][0]
    scene["bodies"] = [
        block | {"shape": {"kind": "box", "lower": [0, y, 0], "upper": [0.1, y + 0.02, top]}}
        for y, top in ((0, 0.04), (0.02, 0.02))
    ]
    first = mpmkit.run(mpmkit.parse_case(scene)).isel(time=0)
    found = [float(first[name]) for name in ("high", "low", "edge")]
    assert found == pytest.approx(
        [0.04, 0.02, (0.04 + 0.02) / 4], rel=1e-12
    )  # the edge is a quarter of a cell
    scene["measurements"]["high"]["formula"] = "depth(0.05, 0.1)"
    with pytest.raises(CaseError, match=r"one along y, from 0 to 0\.04 m"):
        mpmkit.parse_case(scene)


def quarter(space="3d"):
    """A quarter of a block, or a half of a cylinder, of 0.1 m by 0.05 m, beside planes of symmetry."""
    scene = case(space)
    if space == "3d":
        scene["grid"]["domain"]["y"] = [0, 0.2]
        scene["grid"]["faces"] |= {"x_min": "symmetry", "y_min": "symmetry"}
        scene["bodies"][0]["shape"]["upper"] = [0.1, 0.1, 0.05]
    return scene


PLACES = {"corner": "0, 0", "on_a_plane": "0.05, 0", "on_the_other": "0, 0.05", "inside": "0.05, 0.05"}


@pytest.mark.parametrize(
    ("space", "places"), [("3d", PLACES), ("axisymmetric", {"axis": "0", "inside": "0.05"})]
)
def test_the_depth_beside_planes_of_symmetry_is_that_of_the_block(space, places):
    """Also where all particles of a cell are in its half at the plane, which the grid does not see."""
    scene = quarter(space)
    scene["measurements"] = {
        f"{look}_{name}": {"formula": f"{look}({at})", "unit": "m", "description": name}
        for name, at in places.items()
        for look in ("depth", "surface")
    }
    simulation = Simulation(mpmkit.parse_case(scene))
    first = measurements(simulation, {})
    near = 1e-12 if space == "3d" else 1e-3  # the volumes of rings are those of boxes with equal sides
    for name in places:
        assert first[f"depth_{name}"] == pytest.approx(0.05, rel=near)
        assert first[f"surface_{name}"] == pytest.approx(0.05, abs=0.025 * 0.01)
    p = simulation.particles
    ring = p.position[:, 0].copy() if space == "axisymmetric" else np.ones(len(p))
    for axis in range(p.dim - 1):
        p.position[p.position[:, axis] < 0.01, axis] = 0.0025
    if space == "axisymmetric":
        p.volume *= p.position[:, 0] / ring
    moved = measurements(simulation, {})
    for name in places:
        assert moved[f"depth_{name}"] == pytest.approx(0.05, rel=near)


def test_a_surface_is_measured_at_a_point():
    with pytest.raises(
        CaseError, match=r"surface takes one place along x, from 0 to 0\.2 m and one place along y"
    ):
        mpmkit.parse_case(case("3d", top=("surface(0.1)", "m")))
    with pytest.raises(CaseError, match=r"surface takes one place along x, from 0 to 0\.2 m"):
        mpmkit.parse_case(case(top=("surface(0.3)", "m")))
    history = mpmkit.run(mpmkit.parse_case(case(top=("surface(0.05)", "m"), beyond=("surface(0.15)", "m"))))
    assert float(history["top"][0]) == pytest.approx(0.05, abs=0.025 * 0.01)
    assert np.isnan(history["beyond"].values).all()


def test_the_outflow_is_what_a_sink_takes_between_two_rows():
    """A block that slides at 1 m/s out of the domain."""
    scene = case(rate=("outflow('end')", "kg/s"))
    scene["bodies"][0] |= {"velocity": [1.0, 0.0]}
    scene["bodies"][0]["shape"] = {"kind": "box", "lower": [0.1, 0], "upper": [0.2, 0.05]}
    scene["grid"]["faces"] = {"z_min": "slip"}
    scene |= {"gravity": [0, 0], "sinks": {"end": {"kind": "face", "face": "x_max"}}}
    history = mpmkit.run(mpmkit.parse_case(scene))
    taken = np.diff(history["mass_out"].values) / np.diff(history["time"].values)
    np.testing.assert_allclose(history["rate"].values[1:], taken)
    assert history["rate"].values[-1] == pytest.approx(2000 * 0.05 * 1.0, rel=0.05)


def test_no_volume_is_lost_at_a_wall():
    """The depths of all strips of a cell add up to the volume of what has flowed against a wall."""
    strips = {f"d{k}": (f"depth({0.01 * k + 0.005})", "m") for k in range(20)}
    leaning = case(**strips)
    leaning["grid"]["faces"] |= {"x_min": "slip"}
    leaning["bodies"][0]["material"] = MATERIAL | {"yield_stress": 10}
    leaning["until"] = 0.1
    history = mpmkit.run(mpmkit.parse_case(leaning))
    total = sum(float(history[name].values[-1]) for name in strips) * 0.01
    assert total == pytest.approx(0.1 * 0.05, rel=5e-3)  # ρ c² is 800 times the pressure at the foot


def test_the_last_value_is_in_the_summary_with_its_unit(tmp_path):
    measured = case(weight=("force('z_min', 'z') / 9.81", "kg"), nothing=("1 / depth(0.15)", "1/m"))
    history = mpmkit.run(mpmkit.parse_case(measured), tmp_path / "run")
    summary = json.loads((tmp_path / "run/summary.json").read_text())
    assert summary["units"]["weight"] == "kg"
    assert summary["weight"] == float(history["weight"].values[-1])
    force = history["wall_force"].sel(wall="z_min", component="z").values
    np.testing.assert_array_equal(history["weight"].values, force / 9.81)
    assert summary["nothing"] is None
    assert np.isnan(history["nothing"].values).all()


@pytest.mark.parametrize(
    ("name", "formula", "words"),
    [
        ("tip", "front(1)", "front takes nothing"),
        ("tip", "depth(0.3)", "depth takes one place along x, from 0 to 0.2 m"),
        ("tip", "depth('x')", "a number is needed, and not a name in quotes"),
        ("push", "force('lid', 'z')", "force takes the name of a wall ('z_min') and an axis ('x', 'z')"),
        ("gone", "outflow('drain')", "outflow takes the name of a sink (there is none), in quotes"),
        ("mass_out", "front()", "measurements has one called 'mass_out'"),
        ("push", "torque('lid')", "torque takes the name of a wall ('z_min')"),
        ("tip", "hight", "there is no 'hight'; did you mean 'height'?"),
        ("height", "front()", "measurements has one called 'height'"),
        ("t500", "front()", "measurements has one called 't500'"),
        ("Tip", "front()", "measurements has one called 'Tip'"),
        ("tip", "front(", "this is not a formula"),
    ],
)
def test_a_wrong_measurement_has_its_sentence(name, formula, words):
    with pytest.raises(CaseError) as refused:
        mpmkit.parse_case(case(**{name: (formula, "m")}))
    assert words in str(refused.value)


def test_no_measurement_can_have_the_name_of_a_variable_of_the_history():
    names = {column.name for column in (*COLUMNS, *wall_columns(("x", "z")))}
    assert names | {"time"} <= {*NAMES, *TAKEN}


def test_a_parameter_stands_in_the_formula_of_a_measurement():
    data = case(settled=("start - height", "m"))
    data["parameters"] = {"start": {"value": 0.05, "unit": "m", "description": "height at first"}}
    found = mpmkit.parse_case(data)
    assert found.measurements["settled"].formula == "0.05 - height"


def test_the_case_of_a_run_has_numbers_only_and_is_the_same(tmp_path):
    data = case(settled=("start - height", "m"))
    data["parameters"] = {"start": {"value": 0.05, "unit": "m", "description": "height at first"}}
    given = mpmkit.parse_case(data)
    mpmkit.run(given, tmp_path / "run")
    written = json.loads((tmp_path / "run/case.json").read_text())
    assert "parameters" not in written
    again = mpmkit.parse_case(written)
    assert resolved(again) == resolved(given)


def test_a_measurement_ends_a_run():
    """The block flows out; the run ends at the first look, every 20 steps, at which it is 105 mm long."""
    data = case(tip=("front()", "m"), grown=("tip - 0.1", "m"))
    data["bodies"][0]["material"] = MATERIAL | {"yield_stress": 10}
    data["grid"]["faces"]["x_min"] = "slip"
    data["until"] = {"grown": {"at_least": 0.005}, "at_most": 1}
    history = mpmkit.run(mpmkit.parse_case(data))
    assert history.attrs["stopped_because"] == "condition"
    assert int(history.attrs["steps"]) % 20 == 0
    assert 0.105 <= float(history["tip"][-1]) < 0.107


@pytest.mark.parametrize("condition", ["weight", "twice"])
def test_a_mean_between_rows_cannot_end_a_run(condition):
    data = case(weight=("force('z_min', 'z')", "N"), twice=("2 * weight", "N"))
    data["until"] = {condition: {"at_least": 1}, "at_most": 1}
    with pytest.raises(CaseError, match=f"until has the key '{condition}', a measurement with a mean over"):
        mpmkit.parse_case(data)
