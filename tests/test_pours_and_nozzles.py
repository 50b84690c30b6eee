"""A pour brings in exactly its mass; a nozzle follows its path, from a table or from G-code."""

from __future__ import annotations

import copy

import numpy as np
import pytest

from mpmkit.case import parse_case
from mpmkit.errors import CaseError
from mpmkit.plan import cheaper_models, plan
from mpmkit.registry import installed
from mpmkit.solver.ledger import IN, REST
from mpmkit.solver.simulation import Simulation
from mpmkit.spaces import SPACES

DENSITY, NOZZLE = 2000.0, installed().of_kind("source")["nozzle"]
MORTAR = {
    "law": "bingham-evp",
    "density": DENSITY,
    "yield_stress": 1000,
    "plastic_viscosity": 2,
    "sound_speed": 8,
    "shear_modulus": 100000,
}
POUR = {
    "space": "axisymmetric",
    "until": 1.0,
    "grid": {"cell_size": 0.01, "domain": {"r": [0, 0.1], "z": [0, 0.12]}, "faces": {"z_min": "stick"}},
    "sources": {
        "jug": {
            "kind": "pour",
            "centre": [0, 0.1],
            "radius": 0.02,
            "rate": 1.0,
            "mass": 0.1,
            "material": MORTAR,
        }
    },
    "output": {"report": False},
}
SPEED, HEIGHT, WIDTH, THICKNESS = 0.1, 0.03, 0.02, 0.02
PRINTED = {
    "space": "plane-strain",
    "until": 2.0,
    "grid": {"cell_size": 0.005, "domain": {"x": [0, 0.25], "z": [0, 0.04]}, "faces": {"z_min": "stick"}},
    "sources": {
        "nozzle": {
            "kind": "nozzle",
            "radius": WIDTH / 2,
            "points": [[0.03, HEIGHT], [0.23, HEIGHT]],
            "speeds": [SPEED],
            "fluxes": [SPEED * THICKNESS],
            "material": MORTAR,
        }
    },
    "output": {"report": False},
}
"""A sheet that is laid from 10 mm above it."""
GCODE = ["G90 ; places are absolute", "G0 X30 Y0 Z30 F6000", "G92 E0", "G1 X150 E2400000 F6000"]


def case(data, **source):
    data = copy.deepcopy(data)
    (one,) = data["sources"].values()
    one.update(source)
    for key in [key for key, value in one.items() if value is None]:
        del one[key]
    return parse_case(data)


def advanced(simulation, until):
    while simulation.time < until:
        simulation.advance()
    simulation.check()
    return simulation


def test_a_pour_ends_when_its_mass_is_in():
    simulation = advanced(Simulation(case(POUR)), 0.15)
    p, account = simulation.particles, simulation.account()
    assert p.mass.sum() == pytest.approx(0.1, rel=1e-12)
    assert simulation.measured()["mass_in"] == pytest.approx(0.1, rel=1e-12)
    assert account[IN, 0] == pytest.approx(0.1, rel=1e-12)
    assert abs(account[REST, 0]) < 1e-13
    assert p.position[:, 1].min() < 0.06  # it has fallen from its height


@pytest.mark.slow
def test_a_nozzle_lays_a_sheet_as_thick_as_flux_over_speed():
    simulation = advanced(Simulation(case(PRINTED)), 1.95)
    p = simulation.particles
    inside = (p.position[:, 0] > 0.12) & (p.position[:, 0] < 0.18)
    assert p.volume[inside].sum() / 0.06 == pytest.approx(THICKNESS, rel=0.02)
    assert len(np.unique(p.number)) == len(p)


def test_gcode_and_a_table_are_the_same_path():
    points = [[0.03, 0.0, HEIGHT], [0.15, 0.0, HEIGHT]]
    table = NOZZLE.model_validate({"radius": 0.01, "points": points, "speeds": [SPEED], "fluxes": [2e-3]})
    other = NOZZLE.model_validate({"radius": 0.01, "gcode": GCODE})
    mouths = [one.mouth(SPACES["3d"], (np.zeros(3), np.ones(3))) for one in (table, other)]
    assert mouths[0] == mouths[1]
    for time in (0.0, 0.3, 0.7, 1.2, 5.0):
        np.testing.assert_allclose(table.moved(time), other.moved(time), atol=1e-12)
        pushed = [one.pushed(time, 3e-4, DENSITY) for one in (table, other)]
        assert pushed[0] == pytest.approx(pushed[1], rel=1e-12)
    assert table.spell(1, 1) == pytest.approx((0, 1.2))


HALF = {
    "space": "3d",
    "until": 1.0,
    "grid": {
        "cell_size": 0.01,
        "domain": {"x": [0, 0.2], "y": [0, 0.05], "z": [0, 0.04]},
        "faces": {"z_min": "stick", "y_min": "symmetry"},
    },
    "sources": {
        "nozzle": {
            "kind": "nozzle",
            "radius": WIDTH / 2,
            "points": [[0.03, 0, HEIGHT], [0.15, 0, HEIGHT]],
            "speeds": [SPEED],
            "fluxes": [1e-5],
            "material": MORTAR,
        }
    },
    "output": {"report": False},
}
"""Half of a filament."""


def test_a_nozzle_moves_along_a_plane_of_symmetry_but_not_off_it():
    simulation = Simulation(case(HALF))
    assert simulation.case.mouth_area("nozzle") == pytest.approx(np.pi * (WIDTH / 2) ** 2 / 2)
    advanced(simulation, 0.1)
    row = DENSITY * 0.005 * np.pi * (WIDTH / 2) ** 2 / 2
    assert simulation.measured()["mass_in"] == pytest.approx(DENSITY * 1e-5 * simulation.time, abs=row)
    with pytest.raises(CaseError, match="the plane of symmetry y_min cuts its mouth, which moves along y"):
        case(HALF, points=[[0.03, 0, HEIGHT], [0.15, 0.02, HEIGHT]])


@pytest.mark.parametrize("sound_speed", [8, {"mach": 0.1}])
def test_the_cost_of_a_scene_that_begins_empty_is_known(sound_speed):
    planned = plan(case(POUR, material=MORTAR | {"sound_speed": sound_speed}))
    whole = 0.1 / DENSITY / (np.pi * 0.02**2) / 0.005 * 4
    assert planned["particles"] == 0
    assert planned["particles_at_end"] == pytest.approx(whole, rel=0.1)
    assert 0 < planned["expected_seconds"] < 600


def test_a_filament_diameter_makes_a_volume_of_e():
    lines = [line.replace("E2400000", "E100") for line in GCODE]
    wire = NOZZLE.model_validate({"radius": 0.01, "gcode": lines, "filament_diameter": 0.1})
    assert wire.pushed(9.0, 1.0, DENSITY) == pytest.approx(0.1 * np.pi * 0.05**2)


def gcode(*lines):
    return {"gcode": list(lines), "points": None, "speeds": None, "fluxes": None}


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"points": [[0.03, 0.02], [0.3, 0.02]], "speeds": [0.5]}, "its mouth reaches x = 0."),
        ({"speeds": [0.1, 0.1]}, "speeds has 2 entries; 2 points have 1 moves between them"),
        ({"fluxes": [0.0]}, "its path brings in no material: no flux, or no E, is above 0"),
        ({"gcode": GCODE}, "it has points and gcode; it must have one of them"),
        (gcode("G0 X0 Y0 Z20 F60", "G2 X10 Y10"), "only G0, G1, G90 and G92 E are known"),
        (gcode("G0 X0 Y0 Z20 F60", "M104 S200"), "gcode.1 is 'M104 S200'; a line must be G0, G1, G90 or G92"),
        (gcode("G0 X0 Y0 Z20", "G1 X10 E1"), "and no F has given a speed before"),
        (gcode("G0 X30 Y0 Z20 F60", "G1 X100 E-1"), "draws material back; a nozzle only pushes"),
    ],
)
def test_a_wrong_path_has_its_sentence(changes, sentence):
    with pytest.raises(CaseError) as error:
        case(PRINTED, **changes)
    assert sentence in str(error.value)


def test_a_regularised_law_in_a_pour_gives_a_warning_with_its_cost_and_a_cure():
    """At rest its viscosity is τ0 m = 1 MPa s, so that the viscous limit, 3/8 ρ Δx²/μ, is right."""
    regularised = {key: value for key, value in MORTAR.items() if key != "shear_modulus"} | {"law": "bingham"}
    poured = case(POUR, material=regularised)
    assert Simulation(poured).limits.viscous == pytest.approx(0.375 * DENSITY * 0.01**2 / 1e6, rel=1e-3)
    (exact,) = (model for model in cheaper_models(poured) if model.name == "exact yield")
    law = exact.case.sources["jug"].material.constitutive_law
    assert (law.name, law.yield_stress, law.plastic_viscosity) == ("bingham-evp", 1000, 2)
    assert exact.options[0].startswith("sources.jug.material=")
    assert plan(exact.case)["limited_by"] == "acoustic"
