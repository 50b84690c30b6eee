"""The slump test: against an independent finite-element solution, and the spaces against each other.

The reference is an incompressible solution of the stated equations on a free-slip floor. Nothing in mpmkit is
fitted to it.
"""

from __future__ import annotations

import csv
import math
from functools import cache
from pathlib import Path

import numba
import numpy as np
import pytest
from bands import below, close_to
from clock import advance_to, at

import mpmkit
from mpmkit.solver.crowding import crowding

pytestmark = pytest.mark.section(3)
ROOT = Path(__file__).parents[2]
REFERENCE = Path(__file__).parent / "reference" / "slump_free_slip_herschel_bulkley.csv"
STEP = 0.02


def cells(millimetres: float) -> list[str]:
    """Another cell size, with a domain that is a whole number of them."""
    height = 0.3 + millimetres / 1000
    return [f"grid.cell_size={millimetres / 1000}", f'grid.domain={{"r": [0, 0.36], "z": [0, {height:g}]}}']


class Slump:
    """Histories of a run, sampled every 20 ms."""

    def __init__(self, case: mpmkit.Case, until: float, threads: int | None = 1) -> None:
        numba.set_num_threads(threads or numba.config.NUMBA_NUM_THREADS)
        self.simulation = simulation = mpmkit.Simulation(case)
        self.time = np.round(np.arange(0, until + STEP / 2, STEP), 2)
        rows = []
        for t in self.time:
            while simulation.time < t * (1 - 1e-12):
                simulation.advance(t - simulation.time)
            rows.append(simulation.measures(simulation.particles))
        self.spread, self.height, self.axis_height, self.energy = (
            np.array([row[name] for row in rows])
            for name in ("spread_diameter", "height", "axis_height", "kinetic_energy")
        )

    @property
    def t500(self) -> float:
        return float(np.interp(0.5, self.spread, self.time))

    def at(self, times) -> np.ndarray:
        return np.interp(times, self.time, self.spread)


@cache
def reference() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, s, spread diameter and height on the axis, m, of the independent solution."""
    with REFERENCE.open() as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    time, spread, height = (
        np.array([float(row[name]) for row in rows])
        for name in ("time_s", "spread_diameter_m", "axis_height_m")
    )
    return time, spread, height


def compare(validate, name: str, slump: Slump, curve: float, t500: float, final: float) -> None:
    """The rows of section 3; the bands of D(t) and T500 are relative, that of the final spread in m."""
    time, spread, axis = reference()
    off = np.abs(slump.spread / np.interp(slump.time, time, spread) - 1).max()
    validate(f"{name}: D(t), largest departure from the reference", off, below(curve, "0"))
    validate(f"{name}: T500", slump.t500, close_to(0.607, rel=t500), unit="s")
    validate(f"{name}: final spread", slump.spread[-1], close_to(0.56, abs=final), unit="m")
    validate(f"{name}: largest height at rest", slump.height[-1], close_to(0.033, rel=0.05), unit="m")
    validate(
        f"{name}: height on the axis at rest", slump.axis_height[-1], close_to(0.0285, rel=0.05), unit="m"
    )
    late = slump.time >= 2.0
    validate(
        f"{name}: largest kinetic energy from 2 s on", slump.energy[late].max(), below(1e-4, "0"), unit="J"
    )
    if slump.time[-1] > 2.5:
        from_2_s = slump.spread[late]
        rate = (from_2_s[-1] / from_2_s[0] - 1) / (slump.time[-1] - 2.0)
        validate(f"{name}: growth of the spread from 2 s on", rate, below(0.01, "0"), unit="/s")
    for quantity, obtained, exact in (
        ("spread", slump.spread, spread),
        ("axis_height", slump.axis_height, axis),
    ):
        label = {"spread": "spread diameter (mm)", "axis_height": "height on the axis (mm)"}[quantity]
        figure = validate.figure(f"slump_{quantity}", f"Slump: {label[:-5]}", x="time (s)", y=label)
        figure.reference("incompressible finite elements", time, 1e3 * exact)
        figure.line(name, slump.time, 1e3 * obtained)


def test_slump_at_10_mm(validate):
    """900 particles at the start; the bands are those for cells of 5 mm."""
    slump = Slump(mpmkit.load_case(ROOT / "cases/slump.json", cells(10)), until=2.0)
    compare(validate, "Slump, 10 mm", slump, curve=0.015, t500=0.04, final=0.01)


@pytest.mark.slow
def test_slump_at_5_mm(validate):
    """The main job."""
    slump = Slump(mpmkit.load_case(ROOT / "cases/slump.json"), until=4.0)
    compare(validate, "Slump, 5 mm", slump, curve=0.015, t500=0.04, final=0.01)


def test_slump_faster_than_the_concrete(validate):
    """Accuracy with cells of 20 mm and a sound speed that follows the flow."""
    slump = Slump(mpmkit.load_case(ROOT / "cases/slump_fast.json"), until=4.0)
    compare(validate, "Slump, fast (20 mm, Mach 0.1)", slump, curve=0.025, t500=0.08, final=0.01)


@pytest.mark.slow
def test_what_has_stopped_on_a_stick_floor_stays(validate):
    """Concrete that has stopped does not creep.

    Without a redistribution its spread grew from 0.440 m at 2 s to 0.449 m at 16 s, by 0.15 % per second. Now
    the growth is 0.01 % per second, with cells of 20 mm 0.07 %, and with `none` 0.22 %.
    """
    stick = [*cells(10), "grid.faces.z_min=stick", "until=6"]
    simulation = mpmkit.Simulation(mpmkit.load_case(ROOT / "cases/slump.json", stick))
    spread = [simulation.measures.spread(simulation.particles) for _ in at(simulation, [4.0, 6.0])]
    growth = (spread[1] / spread[0] - 1) / 2.0
    validate(
        "Slump, stick floor, 10 mm: growth of the spread from 4 to 6 s", growth, below(2e-4, "0"), unit="/s"
    )


@pytest.mark.slow
def test_quarter_at_5_mm(validate):
    """88,000 particles in minutes."""
    slump = Slump(mpmkit.load_case(ROOT / "cases/slump_quarter_fine.json"), until=1.5, threads=None)
    time, spread, _ = reference()
    off = np.abs(slump.spread / np.interp(slump.time, time, spread) - 1).max()
    validate("Quarter model, 5 mm, Mach 0.1: D(t), largest departure", off, below(0.025, "0"))
    validate("Quarter model, 5 mm, Mach 0.1: T500", slump.t500, close_to(0.607, rel=0.08), unit="s")


def test_quarter_model_agrees_with_axisymmetric(validate):
    """Cells of 20 mm; 8 particles per cell are enough while the concrete falls."""
    round_body = Slump(mpmkit.load_case(ROOT / "cases/slump.json", cells(20)), until=0.3)
    few = ["bodies.0.particles_per_cell=8", "grid.cell_size=0.02"]
    domain = 'grid.domain={"x": [0, 0.36], "y": [0, 0.36], "z": [0, 0.32]}'
    quarter = Slump(mpmkit.load_case(ROOT / "cases/slump_quarter.json", [*few, domain]), until=0.3)
    off = np.abs(quarter.spread / round_body.spread - 1).max()
    validate("Quarter model over axisymmetric, 20 mm, to 0.3 s: D(t) off", off, below(0.03, "0"))


@pytest.mark.slow
def test_quarter_model_agrees_with_axisymmetric_to_its_rest(validate):
    """27 particles per cell, as many at the end as at the start."""
    round_body = Slump(mpmkit.load_case(ROOT / "cases/slump.json", cells(10)), until=1.4)
    quarter = Slump(mpmkit.load_case(ROOT / "cases/slump_quarter.json"), until=1.4)
    off = np.abs(quarter.spread / round_body.spread - 1).max()
    validate("Quarter model over axisymmetric, 10 mm, to 1.4 s: D(t) off", off, below(0.03, "0"))
    time, spread, _ = reference()
    off = np.abs(quarter.spread / np.interp(quarter.time, time, spread) - 1).max()
    validate("Quarter model, 10 mm: D(t), largest departure from the reference", off, below(0.04, "0"))
    validate("Quarter model, 10 mm: T500", quarter.t500, close_to(0.607, rel=0.1), unit="s")


@pytest.mark.xfail(strict=True, reason="rows of the lattice along the flow make tips: docs/findings.md")
def test_front_on_a_stick_floor_is_round(validate):
    """Slump flow, quarter model, 15 mm, 8 particles per cell: the front is as far on an axis as between them.

    On the axes the rows of the lattice lie along the flow. Particles that stay in rows are pushed along
    them, and the front has a tip there. Position of the front: where the crowding of the nodes is 1/2.
    """
    flowing = (
        'bodies.0.material={"law": "bingham-evp", "density": 2300, "yield_stress": 50, '
        '"plastic_viscosity": 30, "sound_speed": {"mach": 0.1}}'
    )
    domain = 'grid.domain={"x": [0, 0.36], "y": [0, 0.36], "z": [0, 0.315]}'
    changes = [
        flowing,
        "grid.cell_size=0.015",
        domain,
        "grid.faces.z_min=stick",
        "bodies.0.particles_per_cell=8",
    ]
    simulation = mpmkit.Simulation(mpmkit.load_case(ROOT / "cases/slump_quarter.json", changes))
    advance_to(simulation, 0.5)
    found = crowding(simulation.particles, simulation.grid, radial=False)
    first = -found.block.lower
    values = found.values.reshape(found.block.shape)[first[0] :, first[1] :]
    count = np.arange(min(values.shape[:2]))
    fronts = [
        spacing * max(map(edge, rows.T))
        for rows, spacing in (
            (values[:, 0], 0.015),
            (values[0], 0.015),
            (values[count, count], 0.015 * math.sqrt(2)),
        )
    ]
    on_axes, between_them = np.mean(fronts[:2]), fronts[2]
    row = "Slump flow, stick floor, quarter model: front on the axes over front between them"
    validate(row, on_axes / between_them, close_to(1.0, abs=0.025))


def edge(crowding_along: np.ndarray) -> float:
    """Where the crowding of a row of nodes falls below 1/2 for the last time, in nodes; else 0."""
    (above,) = np.nonzero(crowding_along[:-1] >= 0.5)
    if not len(above):
        return 0.0
    last = above[-1]
    inner, outer = crowding_along[last], crowding_along[last + 1]
    return float(last + (inner - 0.5) / (inner - outer))


@cache
def to_half_a_second(order: str) -> Slump:
    case = mpmkit.load_case(ROOT / "cases/slump.json", [*cells(20), f"scheme.order={order}"])
    return Slump(case, until=0.5)


@pytest.mark.parametrize("order", ["usf", "musl"])
def test_update_orders_agree(validate, order):
    times = [0.1, 0.3, 0.5]
    usl, other = to_half_a_second("usl"), to_half_a_second(order)
    off = np.abs(other.at(times) / usl.at(times) - 1).max()
    validate(f"Slump, 20 mm, {order.upper()} over USL to 0.5 s: D(t) off", off, below(0.01, "0"))


def test_own_pressure_locks_on_a_stick_floor(validate):
    """Without averaging of pressures, a nearly incompressible material spreads much less: it locks."""
    stick = [*cells(20), "grid.faces.z_min=stick", 'bodies.0.material.sound_speed={"factor": 50}']
    averaged, own = (
        Slump(mpmkit.load_case(ROOT / "cases/slump.json", [*stick, f"scheme.volumetric={name}"]), until=0.5)
        for name in ("nodal-average", "own")
    )
    grown = (own.spread[-1] - 0.2) / (averaged.spread[-1] - 0.2)
    validate(
        "Stick floor, 20 mm, c = 50 √(2 g h), 0.5 s: growth of the spread, own over averaged",
        grown,
        below(0.5, "locks"),
    )


def test_the_settings_of_the_paper_follow_the_reference_while_it_flows(validate):
    """On a floor that is a mirror; see docs/findings.md for the floor that locks."""
    slump = Slump(mpmkit.load_case(ROOT / "cases/slump_as_published.json", cells(10)), until=0.3)
    time, spread, _ = reference()
    off = np.abs(slump.spread / np.interp(slump.time, time, spread) - 1).max()
    validate("Settings of the paper, 10 mm, to 0.3 s: D(t) off", off, below(0.04, "0"))


@pytest.mark.slow
def test_the_settings_of_the_paper_do_not_rest(validate):
    """The regularised law creeps below its yield stress; the report shows by how much, with cells of 5 mm."""
    slump = Slump(mpmkit.load_case(ROOT / "cases/slump_as_published.json"), until=4.0)
    time, spread, _ = reference()
    figure = validate.figure("slump_spread", "Slump: spread diameter", x="time (s)", y="spread diameter (mm)")
    figure.reference("incompressible finite elements", time, 1e3 * spread)
    figure.line("settings of the paper, 5 mm", slump.time, 1e3 * slump.spread)
    for t in (0.1, 0.2, 0.5, 1.0):
        exact = float(np.interp(t, time, spread))
        validate(
            f"Settings of the paper, 5 mm: D at {t:g} s", slump.at(t), close_to(exact, rel=0.04), unit="m"
        )
    rate = (slump.at(4.0) / slump.at(2.0) - 1) / 2
    assert rate > 0.01  # it does not pass the criterion of rest
    assert slump.energy[-1] > 1e-4


def test_the_sound_speed_has_no_influence(validate):
    """A sound speed above that of a nearly incompressible fluid changes only the noise of the pressure.

    The paper's factor is 50. A correction of J that acted at once would be a pressure of ρ c² times the
    correction: with ``even`` it once reduced the spread at 0.3 s by 4 % here, and by 7 % with cells of 10 mm.
    """
    soft, stiff = (
        Slump(
            mpmkit.load_case(
                ROOT / "cases" / "slump.json",
                [*cells(20), f'bodies.0.material.sound_speed={{"factor": {factor}}}'],
            ),
            0.3,
        )
        for factor in (10, 50)
    )
    name = "Slump, 20 mm, c = 50 √(2 g h) in place of 10"
    validate(f"{name}: spread at 0.3 s", stiff.spread[-1] / soft.spread[-1], close_to(1.0, rel=0.01))
    available = 9.81 * stiff.simulation.particles.mass.sum() * 0.3 / 4
    fed = stiff.simulation.redistribution_energy / available
    validate(f"{name}: energy that the redistribution adds, over m g h/4", fed, below(0.06, "0"))
