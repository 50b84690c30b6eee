"""Error against cost is shown only for members that solve one problem with other numerics."""

from pathlib import Path

import numpy as np
import pytest
import xarray
from studies import Now, one_line, status, study

from mpmkit.study import collect, execute, load_study, members_of
from mpmkit.study.problem import solve_one_problem
from mpmkit.study.store import Store

STUDIES = Path(__file__).parent.parent / "cases/studies"
NUMERICAL = {
    "order": {"scheme.order": ["usl", "usf"]},
    "cells": {"grid.cell_size": [0.1, 0.05]},
    "particles": {"bodies.0.particles_per_cell": [4, 9]},
    "sound speed": {"bodies.0.material.sound_speed": [20, 40]},
    "end": {"until": [0.001, 0.002]},
}
PHYSICAL = {
    "viscosity": {"bodies.0.material.viscosity": [5, 10]},
    "density": {"bodies.0.material.density": [1000, 1200]},
    "shape": {"bodies.0.shape.upper": [[0.6, 0.4], [0.5, 0.4]]},
    "gravity": {"gravity": [[0, -9.81], [-9.81, 0]]},
    "floor": {"grid.faces.z_min": ["slip", "stick"]},
    "both": {"scheme.order": ["usl", "usf"], "bodies.0.material.viscosity": [5, 10]},
}


@pytest.mark.parametrize("vary", NUMERICAL.values(), ids=NUMERICAL)
def test_numerics_leave_the_problem_as_it_is(vary):
    assert solve_one_problem(members_of(study(vary=vary)))


@pytest.mark.parametrize("vary", PHYSICAL.values(), ids=PHYSICAL)
def test_a_material_a_body_a_boundary_or_a_force_makes_another_problem(vary):
    assert not solve_one_problem(members_of(study(vary=vary)))


def test_a_quarter_in_3d_and_a_regularised_law_are_the_problem_of_the_shipped_accuracy_study():
    shipped = load_study(STUDIES / "accuracy_vs_cost.json")
    vary = {name: shipped.vary[name] for name in ("model", "law")}
    assert solve_one_problem(members_of(shipped.model_copy(update={"vary": vary})))


@pytest.mark.parametrize("name", ["yield_stress_fast", "floors", "viscosity_fine"])
def test_shipped_studies_of_materials_and_floors_are_not_one_problem(name):
    assert not solve_one_problem(members_of(load_study(STUDIES / f"{name}.json")))


def finished(path, vary):
    """The directory of a study that has been run."""
    given = study(vary=vary)
    members, store = members_of(given), Store(path)
    store.open(given)
    execute(members, store, executor=Now())
    store.write(collect(given, members, store))
    return path


def test_the_page_and_the_command_chart_the_error_of_schemes_but_not_of_materials(tmp_path, capsys):
    schemes = finished(tmp_path / "schemes", NUMERICAL["order"])
    materials = finished(tmp_path / "materials", PHYSICAL["viscosity"])
    assert "Error against cost" in (schemes / "index.html").read_text(encoding="utf-8")
    assert "Error against cost" not in (materials / "index.html").read_text(encoding="utf-8")
    assert status("chart", schemes) == 0
    capsys.readouterr()
    assert status("chart", materials) == 2
    assert one_line(capsys).endswith(
        "--reference finest: the members differ in their materials, bodies, boundaries or forces, so that a "
        "difference from the finest member is not an error; give a CSV file or a number as --reference"
    )
    assert not (materials / "chart.png").exists()
    assert status("chart", materials, "--variable", "final_height", "--reference", "0.4") == 0
    with xarray.open_dataset(materials / "results.nc") as dataset:
        assert np.all(dataset.fate.values == "finished")
