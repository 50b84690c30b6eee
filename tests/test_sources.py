"""Sources bring in what the case says, without a pressure pulse, and the ledger has it."""

from __future__ import annotations

import copy
import json
from typing import ClassVar

import numpy as np
import pytest
import xarray

import mpmkit
from mpmkit.case import parse_case
from mpmkit.contracts import ConstitutiveLaw
from mpmkit.errors import CaseError
from mpmkit.registry import Registered, Registry, installed
from mpmkit.running.runner import resume
from mpmkit.solver.ledger import ENERGY, IN, MASS, REST
from mpmkit.solver.memory import expected_particles
from mpmkit.solver.simulation import Simulation
from mpmkit.solver.stresses import mean_pressure

SPEED, SOUND, DENSITY = 0.2, 5.0, 1000.0
RUBBER = {"law": "neo-hookean", "density": 1000, "youngs_modulus": 1e4, "poisson_ratio": 0.3}
OIL = {"law": "newtonian", "density": DENSITY, "viscosity": 1, "sound_speed": SOUND}
CHANNEL = {
    "space": "plane-strain",
    "until": 0.5,
    "gravity": [0, 0],
    "grid": {
        "cell_size": 0.01,
        "domain": {"x": [0, 0.2], "z": [0, 0.03]},
        "faces": {"z_min": "slip", "z_max": "slip"},
    },
    "sources": {"pump": {"kind": "inlet", "face": "x_min", "velocity": SPEED, "material": OIL}},
    "output": {"report": False},
}
"""An empty channel that is filled as a plug."""


def case(**changes):
    return parse_case(copy.deepcopy(CHANNEL) | changes)


def pump(**changes):
    """The source of the channel with changes; None takes a key out."""
    one = copy.deepcopy(CHANNEL["sources"]["pump"]) | changes
    return {"pump": {key: value for key, value in one.items() if value is not None}}


@pytest.mark.parametrize("space", ["plane-strain", "axisymmetric", "3d"])
def test_a_plug_fills_an_empty_channel(space):
    """Volume = flux t, the front where it must be, the density, and no pulse of pressure at any row."""
    changes, area = {"space": space}, 0.03
    if space == "axisymmetric":
        changes["grid"] = {
            "cell_size": 0.01,
            "domain": {"r": [0, 0.03], "z": [0, 0.2]},
            "faces": {"r_max": "slip"},
        }
        changes["sources"], area = pump(face="z_min"), np.pi * 0.03**2
    if space == "3d":
        faces = dict.fromkeys(("y_min", "y_max", "z_min", "z_max"), "slip")
        domain = {"x": [0, 0.2], "y": [0, 0.02], "z": [0, 0.03]}
        changes |= {"grid": {"cell_size": 0.01, "domain": domain, "faces": faces}, "gravity": [0, 0, 0]}
        area = 0.02 * 0.03
    simulation = Simulation(case(**changes))
    axis = 1 if space == "axisymmetric" else 0
    worst = 0.0
    while simulation.time < 0.26:
        simulation.advance()
        p = simulation.particles
        worst = max(worst, np.abs(p.mapped_pressure).max(initial=0.0), np.abs(p.pressure).max(initial=0.0))
    simulation.check()
    length = SPEED * simulation.time
    assert p.volume.sum() == pytest.approx(area * length, abs=0.5 * area * 0.005 * (1 + 1e-9))
    assert simulation.measured()["mass_in"] == pytest.approx(p.mass.sum(), rel=1e-12)
    front = (p.position + p.box)[:, axis]
    assert front.max() == pytest.approx(length, abs=1e-9)
    assert simulation.measured()["density_mean"] == pytest.approx(1, abs=0.01)
    assert worst <= 0.05 * DENSITY * SOUND * SPEED
    assert np.ptp(p.velocity[:, axis]) < 1e-6 * SPEED
    assert len(np.unique(p.number)) == len(p)


def test_what_came_in_is_in_the_ledger_and_in_the_history(tmp_path):
    history = mpmkit.run(case(until=0.2), tmp_path / "run")
    mass = history.mass_in.values
    np.testing.assert_allclose(history.total_mass, mass, rtol=1e-12)
    assert mass[0] == 0
    assert (np.diff(mass) >= 0).all()
    assert history.source_mass.sel(source="pump").values.tolist() == mass.tolist()
    assert history.source_rate.attrs["units"] == "kg/s"
    entered = history.ledger_mass.sel(cause="in").values
    np.testing.assert_allclose(entered, mass, rtol=1e-12)
    momentum = history.ledger_momentum.sel(cause="in", component="x").values
    np.testing.assert_allclose(momentum, SPEED * mass, rtol=1e-9, atol=1e-12)
    energy = history.ledger_energy.sel(cause="in").values
    np.testing.assert_allclose(energy, SPEED**2 / 2 * mass, rtol=1e-6, atol=1e-12)
    assert history.attrs["mass_in"] == mass[-1]
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["source_mass"] == {"pump": mass[-1]}


def test_a_scene_that_begins_empty_has_a_report(tmp_path):
    mpmkit.run(case(until=0.1, output={"report": True}), tmp_path / "run")
    page = (tmp_path / "run" / "report" / "index.html").read_text()
    assert "put in by sources" in page


def test_a_column_that_is_filled_and_drained_loses_no_mass():
    """Material stands between a pump and a drain: mass inside = start + in - out."""
    body = {"shape": {"kind": "box", "lower": [0, 0], "upper": [0.12, 0.03]}, "material": OIL}
    sink = {"end": {"kind": "box", "lower": [0.1, 0], "upper": [0.2, 0.03]}}
    grid = copy.deepcopy(CHANNEL["grid"])
    grid["faces"] = {"z_min": "stick", "z_max": "slip"}
    simulation = Simulation(case(bodies=[body], sinks=sink, grid=grid))
    for _ in range(300):
        simulation.advance()
    simulation.check()
    account, p = simulation.account(), simulation.particles
    put_in, out = simulation.operations.sources.mass_in.sum(), simulation.ledger.mass_out.sum()
    assert min(put_in, out) > 0.5
    assert p.mass.sum() == pytest.approx(account[0, MASS] + put_in - out, rel=1e-12)
    assert abs(account[REST, MASS]) < 1e-12 * account[0, MASS]
    np.testing.assert_allclose(account[:, 1:-1].sum(axis=0), p.mass @ p.velocity, rtol=0, atol=1e-10)
    assert np.abs(account[REST, 1:-1]).max() < 1e-6 * np.abs(account[IN, 1:-1]).max()
    energies = account[:, ENERGY]
    assert energies[REST] < 0.01 * energies[IN]
    assert energies[REST] > -energies[IN] - energies[0]


@pytest.mark.parametrize("velocity", ["apic", "flip"])
@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
def test_momentum_is_accounted_for_with_every_scheme(velocity, order):
    grid = copy.deepcopy(CHANNEL["grid"])
    grid["faces"] = {"z_min": "stick", "z_max": "stick"}
    simulation = Simulation(case(grid=grid, scheme={"velocity": velocity, "order": order}))
    for _ in range(150):
        simulation.advance()
    account = simulation.account()
    assert account[IN, 1] > 1
    assert abs(account[REST, 1]) < 1e-6 * account[IN, 1]


def test_a_source_with_an_end_brings_in_exactly_its_column():
    table = {"times": [0.0, 0.1, 0.2], "values": [0.0, 0.3, 0.1]}
    simulation = Simulation(case(sources=pump(velocity=table, start=0.05, end=0.3)))
    while simulation.time < 0.32:
        simulation.advance()
    length = 0.05 * (0.15 + 0.3) / 2 + 0.1 * 0.2 + 0.1 * 0.1
    assert simulation.particles.mass.sum() == pytest.approx(DENSITY * 0.03 * length, rel=1e-12)
    assert not simulation.operations.sources.goes_on(simulation.time)


def test_a_stream_from_a_slot_falls_as_it_must():
    """After a fall of h it has √(v² + 2 g h), with h from at most a width below the mouth.

    At the mouth the column is rigid, as in a nozzle, so that gravity accelerates it within about w/π.
    """
    thin = OIL | {"viscosity": 0.05, "sound_speed": 10.0}
    slot = pump(
        face=None, lower=[0.045, 0.15], upper=[0.055, 0.15], direction="-z", velocity=1, material=thin
    )
    grid = {"cell_size": 0.005, "domain": {"x": [0, 0.1], "z": [0, 0.2]}}
    simulation = Simulation(case(gravity=[0, -9.81], sources=slot, grid=grid))
    while simulation.time < 0.09:
        simulation.advance()
    p = simulation.particles
    fallen = 0.15 - p.position[:, 1]
    for depth in (0.03, 0.06, 0.09):
        near = np.abs(fallen - depth) < 0.01
        free, late = (np.sqrt(1 + 2 * 9.81 * (fallen[near] - h)).mean() for h in (0.0, 0.01))
        assert late < -p.velocity[near, 1].mean() < free
    assert simulation.account()[IN, MASS] == pytest.approx(DENSITY * 0.01 * simulation.time, abs=0.013)


def test_a_run_goes_on_with_the_same_bits(tmp_path):
    """In the middle of a row, with a sink that takes some of it."""
    settings = {"history_interval": 0.01, "frame_interval": 0.1, "report": False, "particle_history": ["age"]}
    sink = {"end": {"kind": "box", "lower": [0.03, 0], "upper": [0.2, 0.03]}}
    whole = mpmkit.run(case(until=0.3, output=settings, sinks=sink), tmp_path / "whole")
    mpmkit.run(case(until=0.197, output=settings, sinks=sink), tmp_path / "part")
    resume(tmp_path / "part", until=0.3)
    files = [tmp_path / name / "history.nc" for name in ("part", "whole")]
    with xarray.open_dataset(files[0]) as again, xarray.open_dataset(files[1]) as once:
        xarray.testing.assert_identical(again.drop_attrs(), once.drop_attrs())
    assert float(whole.mass_out[-1]) > 0


def test_the_number_of_threads_makes_no_difference():
    one, two = (mpmkit.run(case(until=0.15), threads=threads) for threads in (1, 2))
    xarray.testing.assert_identical(one.drop_attrs(), two.drop_attrs())


def test_age_counts_from_when_a_particle_came_in():
    body = {
        "shape": {"kind": "box", "lower": [0, 0], "upper": [0.05, 0.03]},
        "material": OIL,
        "velocity": [SPEED, 0],
    }
    simulation = Simulation(case(bodies=[body]))
    while simulation.time < 0.2:
        simulation.advance()
    p = simulation.particles
    old = p.body == 0
    np.testing.assert_allclose(p.age[old], simulation.time, rtol=1e-12)
    # A row comes in when its middle is through, and has gone x = v age since.
    np.testing.assert_allclose(
        SPEED * p.age[~old], p.position[~old, 0], atol=SPEED * simulation.time_step * 1.01
    )
    assert (~old).any()


class Setting(ConstitutiveLaw):
    """A fluid without viscosity that keeps the ages that it was given."""

    name, citation, api_version, needs_age = "setting", "none", 2, True
    seen: ClassVar[list] = []

    def update_stress(self, kinematics, state, dt, stress):
        self.seen.append(kinematics.age.copy())
        stress[:] = 0.0


def test_a_law_that_needs_the_age_gets_it():
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered("law", Setting, "tests", "1", "setting")], [])
    material = {"law": "setting", "density": DENSITY, "sound_speed": SOUND}
    simulation = Simulation(
        parse_case(copy.deepcopy(CHANNEL) | {"sources": pump(material=material)}, registry=registry)
    )
    while simulation.time < 0.1:
        simulation.advance()
    assert Setting.seen[-1].max() == pytest.approx(simulation.time - 0.0125, abs=0.01)
    assert len(Setting.seen[-1]) <= len(simulation.particles)


def test_plan_and_memory_count_what_will_come_in():
    assert expected_particles(case()) == pytest.approx(0.5 * SPEED / 0.005 * 6)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"sources": {}, "bodies": []}, "bodies is []; it must be a list of one or more objects, unless"),
        ({"sources": pump(face="r_min")}, "sources.pump: face is 'r_min'; it must be one of x_min, x_max"),
        ({"sources": pump(face="z_min")}, "its section is at the face z_min, which is"),
        ({"sources": pump(flux=0.1)}, "it has velocity and flux; it must have one of them"),
        ({"sources": pump(velocity=None)}, "it has no velocity and no flux; it must have one of them"),
        ({"sources": pump(velocity=3.0)}, "comes in at up to 3 m/s; it must be at most 0.5 of the sound"),
        ({"sources": pump(end=0.0)}, "end is 0 s; it must be above start, 0 s"),
        ({"sources": pump(direction="x")}, "direction is given, but a face lets material in along its own"),
        ({"sources": {"a b": pump()["pump"]}}, "sources has the name"),
        (
            {"sources": pump(face=None, lower=[0.1, 0.01], upper=[0.1, 0.05], direction="x")},
            "its section reaches z = 0.05 m, outside the grid",
        ),
        (
            {"sources": pump(face=None, lower=[0.195, 0], upper=[0.195, 0.03], direction="x")},
            "has less than a cell before it",
        ),
        (
            {
                "sources": pump(face=None, lower=[0.1, 0], upper=[0.1, 0.03], direction="x"),
                "bodies": [
                    {"shape": {"kind": "box", "lower": [0.05, 0], "upper": [0.15, 0.03]}, "material": OIL}
                ],
            },
            "its section is in bodies.0.shape, which fills the place that its material comes from",
        ),
        (
            {"sources": pump(material=RUBBER)},
            "sources.pump.material.law is 'neo-hookean', a solid; a source brings in fluids only",
        ),
        ({"sources": pump(kind="inle")}, "sources.pump.kind is \"inle\"; it must be"),
    ],
)  # fmt: skip
def test_a_wrong_source_has_its_sentence(changes, sentence):
    with pytest.raises(CaseError) as error:
        case(**changes)
    assert sentence in str(error.value)


RADIUS, MEAN, YIELD, PLASTIC = 0.0125, 0.1, 200.0, 10.0


def buckingham_reiner():
    """Pressure gradient, Pa/m, of a Bingham fluid in a tube at a mean velocity."""
    low, high = 2 * YIELD / RADIUS, 1e7
    for _ in range(100):
        gradient = (low + high) / 2
        part = 2 * YIELD / (gradient * RADIUS)
        velocity = gradient * RADIUS**2 / (8 * PLASTIC) * (1 - 4 / 3 * part + part**4 / 3)
        low, high = (gradient, high) if velocity < MEAN else (low, gradient)
    return gradient


@pytest.mark.slow
def test_a_bingham_fluid_in_a_tube_needs_the_pressure_of_buckingham_and_reiner():
    """A plug comes into a tube with a wall that holds it, and develops; 10 cells across the radius."""
    paste = {
        "law": "bingham-evp",
        "density": 2000,
        "yield_stress": YIELD,
        "plastic_viscosity": PLASTIC,
        "shear_modulus": 20000,
        "sound_speed": 20,
    }
    shape = {"kind": "cylinder", "radius": RADIUS, "height": 0.05}
    simulation = Simulation(
        case(
            space="axisymmetric",
            until=0.15,
            grid={
                "cell_size": RADIUS / 10,
                "domain": {"r": [0, RADIUS], "z": [0, 0.05]},
                "faces": {"r_max": "stick"},
            },
            bodies=[{"shape": shape, "velocity": [0, MEAN], "material": paste}],
            sources=pump(face="z_min", velocity=MEAN, material=paste),
            sinks={"end": {"kind": "face", "face": "z_max"}},
        )
    )
    ends, means = np.arange(0.01375, 0.0375, 0.0025), []
    while simulation.time < 0.15:
        simulation.advance()
        if simulation.steps % 20 == 0 and simulation.time > 0.08:
            p, z = simulation.particles, simulation.particles.position[:, 1]
            where = np.digitize(z, ends)
            volume = np.bincount(where, p.volume, len(ends) + 1)
            means.append((np.bincount(where, p.volume * mean_pressure(p), len(ends) + 1) / volume)[1:-1])
    slope = -np.polyfit((ends[1:] + ends[:-1]) / 2, np.mean(means, axis=0), 1)[0]
    assert buckingham_reiner() == pytest.approx(93.5e3, rel=1e-3)
    assert slope == pytest.approx(buckingham_reiner(), rel=0.03)
