"""The slump test: the spaces against each other, and against an independent finite-element solution."""

import csv
from pathlib import Path

import numba
import numpy as np
import pytest

import mpmkit

ROOT = Path(__file__).parents[2]
REFERENCE = Path(__file__).parent / "reference" / "slump_free_slip_herschel_bulkley.csv"
COARSE = ["grid.cell_size=0.01", 'grid.domain={"r": [0, 0.36], "z": [0, 0.31]}']


def spread(case: mpmkit.Case, times: list[float]) -> np.ndarray:
    """Spread diameter, m, at some times, s."""
    numba.set_num_threads(1)
    simulation = mpmkit.Simulation(case)
    found = []
    for time in times:
        while simulation.time < time * (1 - 1e-12):
            simulation.advance(time - simulation.time)
        found.append(simulation.measures(simulation.particles)["spread_diameter"])
    return np.array(found)


def reference(times: list[float]) -> np.ndarray:
    """Spread diameter of the independent incompressible solution, m."""
    with REFERENCE.open() as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    columns = [[float(row[name]) for row in rows] for name in ("time_s", "spread_diameter_m")]
    return np.interp(times, *columns)


def test_quarter_model_agrees_with_axisymmetric():
    """Two spaces, two sets of kernels, one body: within 3 % at 10 mm while it falls."""
    times = [0.05, 0.1, 0.15, 0.2]
    softer = "bodies.0.material.sound_speed.factor=15"  # the same in both, for fewer steps
    round_body = mpmkit.load_case(ROOT / "cases" / "slump.json", [*COARSE, softer])
    quarter = mpmkit.load_case(ROOT / "cases" / "slump_quarter.json", [softer])
    assert spread(quarter, times) == pytest.approx(spread(round_body, times), rel=0.03)


def test_coarse_slump_follows_the_reference_while_it_flows():
    """The paper's settings at 10 mm stay within 4 % of the incompressible solution for half a second."""
    times = [0.1, 0.2, 0.3, 0.4, 0.5]
    case = mpmkit.load_case(ROOT / "cases" / "slump.json", COARSE)
    assert spread(case, times) == pytest.approx(reference(times), rel=0.04)
