"""The ledger: in every kind of scene, the causes add up to the present mass, momentum and energy."""

from __future__ import annotations

import copy
from functools import cache

import numpy as np
import pytest

import mpmkit
from mpmkit.case import parse_case
from mpmkit.errors import GuardStop
from mpmkit.solver.ledger import (
    CAUSES,
    ENERGY,
    FORCES,
    GRAVITY,
    MASS,
    OUT,
    REDISTRIBUTION,
    REFINEMENT,
    REST,
    WALLS,
)
from mpmkit.solver.simulation import Simulation

MUD = {"law": "bingham-evp", "density": 1500, "yield_stress": 20, "plastic_viscosity": 5, "sound_speed": 15}
COLUMN = {
    "space": "plane-strain",
    "until": 1.0,
    "grid": {
        "cell_size": 0.02,
        "domain": {"x": [0, 0.6], "z": [0, 0.3]},
        "faces": {"x_min": "symmetry", "x_max": "slip", "z_min": "stick"},
    },
    "bodies": [{"shape": {"kind": "box", "lower": [0, 0], "upper": [0.2, 0.2]}, "material": MUD}],
    "output": {"report": False},
}
"""A column that collapses on a floor that holds it back, beside a plane of symmetry."""


def advanced(steps=150, **changes):
    data = copy.deepcopy(COLUMN) | changes
    simulation = Simulation(parse_case(data))
    for _ in range(steps):
        simulation.advance()
    return simulation, simulation.account()


@cache
def of_kind(kind):
    """One run for all who only look at it."""
    return advanced(200, **KINDS[kind])


def scale(simulation, account):
    """Impulse of the weight, N s, or of the walls if there is no gravity."""
    return np.abs(account[[GRAVITY, WALLS], 1:-1]).max()


PLATE = {
    "surface": {
        "kind": "body",
        "shape": {"kind": "box", "lower": [0.25, 0.0], "upper": [0.35, 0.1]},
        "side": "outside",
        "motion": {"kind": "velocity", "velocity": [-0.5, 0]},
    },
    "contact": "slip",
}
SLOPE = {
    "gravity": [4.9, -8.5],
    "grid": {
        "cell_size": 0.02,
        "domain": {"x": [0, 0.2], "z": [0, 0.1]},
        "faces": {"x_min": "periodic", "x_max": "periodic", "z_min": "stick"},
    },
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0, 0], "upper": [0.2, 0.06]},
            "material": MUD,
            "velocity": [0.3, 0],
        }
    ],
}
DRAIN = {"kind": "box", "lower": [0.22, 0.0], "upper": [0.6, 0.3]}
KINDS = {
    "faces": {},
    "wall that moves": {"walls": {"plate": PLATE}},
    "periodic slope": SLOPE,
    "refinement": {"scheme": {"refinement": "split-and-merge", "redistribution": "none"}},
    "no redistribution": {"scheme": {"redistribution": "none"}},
    "flip": {"scheme": {"velocity": "flip", "order": "usf"}},
    "musl": {"scheme": {"order": "musl"}},
    "forces": {
        "gravity": None,
        "forces": {
            "tilt": {"kind": "gravity-table", "times": [0, 0.05], "vectors": [[0, -9.81], [4, -9]]},
            "shake": {"kind": "oscillation", "amplitude": [0, 0.001], "frequency": 40},
        },
        "grid": COLUMN["grid"] | {"faces": {"x_min": "slip", "x_max": "slip", "z_min": "stick"}},
    },
    "rotation": {
        "forces": {"turn": {"kind": "rotating-frame", "point": [0.1, 0], "rate": 3}},
        "grid": COLUMN["grid"] | {"faces": {"x_min": "slip", "x_max": "slip", "z_min": "stick"}},
    },
    "sink": {"sinks": {"drain": DRAIN}},
    "open face": {
        "grid": COLUMN["grid"] | {"domain": {"x": [0, 0.24], "z": [0, 0.3]},
                                  "faces": {"x_min": "symmetry", "z_min": "stick"}},
        "sinks": {"edge": {"kind": "face", "face": "x_max"}},
    },
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_mass_and_momentum_are_accounted_for(kind):
    simulation, account = of_kind(kind)
    p = simulation.particles
    np.testing.assert_allclose(account[:, MASS].sum(), p.mass.sum(), rtol=1e-14)
    np.testing.assert_allclose(account[:, 1:-1].sum(axis=0), p.mass @ p.velocity, rtol=0, atol=1e-10)
    assert abs(account[REST, MASS]) <= 1e-12 * account[0, MASS]
    assert np.abs(account[REST, 1:-1]).max() <= 1e-9 * scale(simulation, account)
    assert scale(simulation, account) > 1
    if "sink" in kind or "open" in kind:
        assert -account[OUT, MASS] == pytest.approx(simulation.ledger.mass_out.sum(), rel=1e-14)
        assert simulation.ledger.mass_out.sum() > 0.02 * account[0, MASS]
        assert account[OUT, 1] < 0


@pytest.mark.parametrize("kind", KINDS)
def test_energy_is_dissipated_and_not_created(kind):
    """The rest is the dissipation of the material: negative, and small at first."""
    simulation, account = of_kind(kind)
    energies = account[:, ENERGY]
    supply = energies[0] + abs(energies[GRAVITY]) + abs(energies[FORCES]) + abs(energies[WALLS])
    assert energies[REST] < 0.01 * supply
    assert energies[REST] > -supply
    if kind == "wall that moves":
        assert energies[WALLS] == simulation.walls_work > 0
    if kind in ("forces", "rotation"):
        assert energies[FORCES] == simulation.force_work.sum() != 0
    if kind == "refinement":
        assert simulation.refiner.acts
        assert energies[REDISTRIBUTION] == 0
    else:
        assert energies[REFINEMENT] == 0
        assert energies[REDISTRIBUTION] == simulation.redistribution_energy
    if kind != "wall that moves":  # where a shift makes a millionth of what walls give
        assert np.abs(account[REDISTRIBUTION, 1:-1]).max() <= 1e-9 * scale(simulation, account)


def test_free_fall_is_exact():
    """Free fall: K grows by the loss of potential energy, and the momentum is m g t."""
    block = {"shape": {"kind": "box", "lower": [0.2, 0.1], "upper": [0.3, 0.2]}, "material": MUD}
    grid = {"cell_size": 0.02, "domain": {"x": [0, 0.6], "z": [0, 0.3]}}
    simulation, account = advanced(50, bodies=[block], grid=grid)
    mass = 1500 * 0.01
    assert account[GRAVITY, 2] == pytest.approx(-9.81 * mass * simulation.time, rel=1e-12)
    p = simulation.particles
    assert account[:, ENERGY].sum() == pytest.approx(mass * (9.81 * simulation.time) ** 2 / 2, rel=1e-9)
    fallen = 0.15 - p.mass @ p.position[:, 1] / mass
    assert account[GRAVITY, ENERGY] == pytest.approx(9.81 * mass * fallen, rel=1e-9)
    # A step moves with the velocity at its end: the fall is g t dt/2 deeper than g t²/2.
    late = 9.81**2 * mass * simulation.time * simulation.time_step / 2
    assert account[REST, ENERGY] == pytest.approx(-late, rel=1e-3)
    assert np.abs(account[REST, :ENERGY]).max() <= 1e-12
    assert not account[WALLS].any()


def test_the_expected_mass_excludes_the_mass_in_sinks():
    """The guard compares with the ledger, so it also notices mass that no sink has removed."""
    simulation, _ = advanced(100, sinks={"drain": DRAIN})
    simulation.check()
    simulation.particles.mass[3] *= 0.5
    with pytest.raises(
        GuardStop, match=r"but they should have [\d.]+ kg; a plug-in may have changed their masses"
    ):
        simulation.check()


def test_the_history_holds_it():
    history = mpmkit.run(parse_case(copy.deepcopy(COLUMN) | {"until": 0.05}))
    assert history.ledger_mass.dims == ("time", "cause")
    assert history.ledger_momentum.dims == ("time", "cause", "component")
    assert history.cause.values.tolist() == list(CAUSES)
    np.testing.assert_allclose(history.ledger_mass.sum("cause"), history.total_mass, rtol=1e-14)
    np.testing.assert_allclose(history.ledger_momentum.sum("cause"), history.momentum, rtol=0, atol=1e-10)
    stored = history.kinetic_energy + history.strain_energy + history.compressive_energy
    np.testing.assert_allclose(history.ledger_energy.sum("cause"), stored, rtol=1e-9, atol=1e-9)
    work = history.ledger_energy.sel(cause="gravity")
    np.testing.assert_allclose(work, history.potential_energy[0] - history.potential_energy, atol=1e-9)
