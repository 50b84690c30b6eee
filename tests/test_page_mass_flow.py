"""The page of a run with sources and sinks: how much came in and went out, from where, and its flow curve."""

from __future__ import annotations

import numpy as np
import pytest
from test_page import data_of, text_of

from mpmkit.case import parse_case
from mpmkit.output.netcdf import read_dataset
from mpmkit.report.page import page_of
from mpmkit.report.page.headline import figures
from mpmkit.report.page.source import read_source
from mpmkit.running.runner import run

MORTAR = {
    "law": "bingham-evp",
    "density": 2000,
    "sound_speed": 10,
    "yield_stress": 20,
    "plastic_viscosity": 2,
}
TAP = {"kind": "inlet", "lower": [0, 0.1], "upper": [0.02, 0.1], "direction": "-z", "velocity": 0.2}
CASE = {
    "name": "tap",
    "space": "axisymmetric",
    "until": 0.25,
    "grid": {
        "cell_size": 0.01,
        "domain": {"r": [0, 0.06], "z": [0, 0.1]},
        "faces": {"z_min": "stick"},
    },
    "bodies": [],
    "sources": {"tap": {**TAP, "material": MORTAR}},
    "sinks": {"drain": {"kind": "box", "lower": [0, 0.05], "upper": [0.06, 0.06]}},
}


@pytest.fixture(scope="module")
def directory(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "tap"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mpmkit.report.draw_pictures", lambda directory: [])
        run(parse_case(CASE), path, threads=1)
    return path


def test_the_headline_says_how_much_came_in_and_from_where(directory):
    """ρ π r² v t = 2000 π 0.02² 0.2 0.25 kg, to within a row of particles."""
    history, text = read_dataset(directory / "history.nc"), text_of(page_of(directory))
    mass = float(history.mass_in[-1])
    assert mass == pytest.approx(2000 * np.pi * 0.02**2 * 0.2 * 0.25, rel=0.1)
    where = "came in through the source tap (inlet, at z = 100 mm in the direction −z)"
    assert f"Mass in {mass:.3f} kg {where}" in text
    out = float(history.mass_out[-1])
    assert out > 0
    assert "left through the sink drain (box)" in text


def test_a_scene_that_begins_empty_has_no_slump(directory):
    names = [name for name, _, _ in figures(read_source(directory))]
    assert "Slump" not in names
    assert "Height" in names


def test_masses_and_rates_are_drawn_against_time(directory):
    history = read_dataset(directory / "history.nc")
    charts = {chart["title"]: chart for chart in data_of(page_of(directory))["measured"]["charts"].values()}
    came = charts["Mass that has come in through the source: tap"]
    assert came["unit"] == "kg"
    np.testing.assert_allclose(came["curves"][0]["values"], history.mass_in, rtol=1e-6)
    left = charts["Mass that has left through the sink: drain"]
    np.testing.assert_allclose(left["curves"][0]["values"], history.mass_out, rtol=1e-6)
    assert charts["Rate at which mass comes in: tap"]["unit"] == "kg/s"


def test_the_material_of_a_source_has_its_flow_curve_and_the_shear_rates_that_it_reached(directory):
    chart = data_of(page_of(directory))["materials"]["charts"]["material-0"]
    assert chart["unit"] == "Pa"
    assert chart["band"]["most"] > 0
    assert "Yield stress 20 Pa" in text_of(page_of(directory))
