"""Slump test with a lifted mould, compared with an independent finite-element solution of the same problem.

The reference is incompressible; its code is that of the reference for release at once. Nothing in mpmkit is
fitted to it.
"""

from __future__ import annotations

import csv
import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from bands import below, close_to
from clock import at

import mpmkit

pytestmark = pytest.mark.section(6)
ROOT = Path(__file__).parents[2]
REFERENCE = Path(__file__).parent / "reference" / "slump_lifted_free_slip_herschel_bulkley.csv"
STEP = 0.02


@cache
def reference() -> tuple[np.ndarray, np.ndarray]:
    """Time, s, and spread diameter, m, of the independent solution."""
    with REFERENCE.open() as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    time, spread = (np.array([float(row[name]) for row in rows]) for name in ("time_s", "spread_diameter_m"))
    return time, spread


def slump(speed: float | None, cell: float, until: float) -> tuple[np.ndarray, np.ndarray]:
    """Time, s, and spread diameter, m, with a mould that is lifted at a speed, m/s, or without one."""
    data = json.loads((ROOT / "cases/slump.json").read_text())
    data["until"] = until
    data["grid"] |= {"cell_size": cell, "domain": {"r": [0, 0.4], "z": [0, 0.4]}}
    if speed is not None:
        up = {"kind": "velocity", "velocity": [0, speed]}
        shape = data["bodies"][0]["shape"]
        mould = {"kind": "body", "shape": shape, "side": "inside", "thickness": 2 * cell, "motion": up}
        data["walls"] = {"mould": {"surface": mould, "contact": "slip"}}
    simulation = mpmkit.Simulation(mpmkit.parse_case(data))
    time = np.round(np.arange(0.0, until + STEP / 2, STEP), 6)
    spread = [simulation.measures.spread(simulation.particles)]
    spread += [simulation.measures.spread(simulation.particles) for _ in at(simulation, time[1:])]
    return time, np.array(spread)


def compare(validate, name: str, time: np.ndarray, spread: np.ndarray) -> None:
    exact_time, exact = reference()
    moving = time >= 0.1 - 1e-9
    off = np.abs(spread / np.interp(time, exact_time, exact) - 1)[moving].max()
    validate(f"{name}: D(t) from 0.1 s on, largest departure from the reference", off, below(0.02, "0"))
    if spread[-1] > 0.5:
        t500 = float(np.interp(0.5, spread, time))
        validate(f"{name}: T500", t500, close_to(0.600, rel=0.02), unit="s")
    if time[-1] >= 1.6:
        validate(f"{name}: spread at rest", spread[-1], close_to(0.572, abs=0.006), unit="m")
    chart = validate.figure(
        "lifted_mould", "Slump with a mould that is lifted at 0.3 m/s", x="time (s)", y="spread (mm)"
    )
    chart.reference("incompressible finite elements", exact_time, 1e3 * exact)
    chart.line(name, time, 1e3 * spread)


def test_the_mould_is_lifted_at_10_mm(validate):
    """Until after T500."""
    compare(validate, "Lifted mould, 10 mm", *slump(0.3, 0.01, 0.7))


@pytest.mark.slow
@pytest.mark.parametrize("cell", [0.01, 0.005])
def test_the_mould_is_lifted_until_the_concrete_rests(validate, cell):
    compare(validate, f"Lifted mould, {1e3 * cell:g} mm", *slump(0.3, cell, 2.0))


@pytest.mark.slow
def test_a_mould_lifted_ever_faster_tends_to_none(validate):
    """At 10 m/s the mould is gone in 0.03 s. The next test records the error of the spread over time."""
    time, free = slump(None, 0.01, 2.0)
    off = {speed: np.abs(slump(speed, 0.01, 2.0)[1] / free - 1) for speed in (0.3, 1.0, 10.0)}
    on_the_way, late = time >= 0.1 - 1e-9, time >= 0.5 - 1e-9
    assert off[0.3][on_the_way].max() > 2 * max(off[fast][on_the_way].max() for fast in (1.0, 10.0))
    name = "Mould lifted at 10 m/s, 10 mm: D(t) off that of the release at once"
    validate(f"{name}, from 0.5 s on", off[10.0][late].max(), below(0.003, "0"))
    validate(f"{name}, at rest", off[10.0][-1], below(0.003, "0"))


@pytest.mark.slow
@pytest.mark.xfail(
    reason="0.7 % at worst, soon after the mould is gone: the lift holds back some 4 ms", strict=True
)
def test_a_mould_lifted_at_10_m_s_is_a_release_at_once_at_all_times(validate):
    time, free = slump(None, 0.01, 2.0)
    off = np.abs(slump(10.0, 0.01, 2.0)[1] / free - 1)[time >= 0.1 - 1e-9].max()
    validate(
        "Mould lifted at 10 m/s, 10 mm: D(t) off that of the release, from 0.1 s on", off, below(0.003, "0")
    )
