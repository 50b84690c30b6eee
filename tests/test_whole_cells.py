"""A cell size that does not divide the domain: extended where a face is open, refused where none is."""

import copy
import pickle

import pytest
from case_sentences import GOOD, sentence

from mpmkit.case import parse_case
from mpmkit.case.whole_cells import is_whole
from mpmkit.plan import plan
from mpmkit.running.setting import setting

CLOSED = {"x_min": "slip", "x_max": "slip", "z_min": "slip", "z_max": "stick"}


def scene(cell, faces, x=(0, 1), z=(0, 1)):
    grid = {"cell_size": cell, "domain": {"x": list(x), "z": list(z)}, "faces": faces}
    return copy.deepcopy(GOOD) | {"grid": grid}


def test_the_open_upper_end_moves_out_and_the_log_says_so():
    case = parse_case(scene(0.3, {"z_min": "slip"}))
    assert case.grid.domain == {"x": [0, pytest.approx(1.2)], "z": [0, pytest.approx(1.2)]}
    assert case.domain_bounds[1] == pytest.approx([1.2, 1.2])
    said = "grid.domain.x is extended from [0, 1] to [0, 1.2] at its open face x_max: 4 whole cells of 0.3 m"
    assert case.grid.extensions[0] == said
    assert said in setting(case)


def test_where_only_the_lower_face_is_open_the_lower_end_moves():
    case = parse_case(scene(0.3, {"x_max": "slip", "z_min": "slip", "z_max": "slip"}, z=(0, 0.9)))
    assert case.grid.domain == {"x": [pytest.approx(-0.2), 1], "z": [0, 0.9]}


def test_a_domain_that_fits_is_left_alone_to_the_bit():
    case = parse_case(scene(0.1, {"z_min": "slip"}, x=(0, 0.7 + 0.1 + 0.1)))
    assert 0.7 + 0.1 + 0.1 != 0.9
    assert case.grid.domain["x"] == [0, 0.7 + 0.1 + 0.1]
    assert case.grid.extensions == ()
    assert parse_case(case.model_dump(mode="json")).grid.domain == case.grid.domain


def test_the_extended_case_is_its_own_fixed_point_and_goes_to_other_processes():
    case = parse_case(scene(0.07, {"z_min": "slip"}))
    again = parse_case(case.model_dump(mode="json"))
    assert (again.grid.domain, again.grid.extensions) == (case.grid.domain, ())
    assert pickle.loads(pickle.dumps(case)).grid.domain == case.grid.domain


@pytest.mark.parametrize("faces", [CLOSED, CLOSED | {"x_min": "periodic", "x_max": "periodic"}])
def test_between_closed_faces_the_sentence_names_the_nearest_sizes_and_they_fit(faces):
    said = sentence(parse_case, scene(0.3, faces))
    assert (
        "grid.domain.x is 3.33333 cells long; it must be a whole number of cells of 0.3 m, and it cannot be "
        "extended, since neither of its faces is open: set grid.cell_size to 0.25 m or 0.333333333 m, or set "
        "grid.domain.x to [0, 0.9]"
    ) in said
    for size in (0.25, 0.333333333):
        assert parse_case(scene(size, faces)).grid.extensions == ()


def test_the_sizes_named_fit_all_closed_axes_at_once():
    said = sentence(parse_case, scene(0.07, CLOSED, x=(0, 0.36), z=(0, 0.3)))
    assert "set grid.cell_size to 0.06 m, or set grid.domain.x to [0, 0.35]" in said
    assert all(is_whole(length / 0.06) for length in (0.36, 0.3))


def test_the_axis_is_no_open_face():
    radial = scene(0.07, {"r_max": "slip", "z_min": "slip"}) | {"space": "axisymmetric"}
    radial["grid"]["domain"] = {"r": [0, 1], "z": [0, 1]}
    assert "grid.domain.r is 14.2857 cells long" in sentence(parse_case, radial)


def test_a_plan_says_so_as_well(monkeypatch):
    monkeypatch.setattr("mpmkit.plan.cost.PILOT_SECONDS", 0.2)
    assert "grid.domain.x is extended" in plan(parse_case(scene(0.3, {"z_min": "slip"})))["remarks"][0]
