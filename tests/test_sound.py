"""The sound speed that follows the flow, and the Mach number."""

import copy
import json
import logging
import math
from pathlib import Path

import numpy as np
import pytest

import mpmkit
from mpmkit.case import parse_case
from mpmkit.errors import CaseError
from mpmkit.solver.energies import compressive_energy, kinetic_energy
from mpmkit.solver.simulation import Simulation
from mpmkit.solver.sound import CHANGE, SLOWEST, follow_flow, largest_energy

FAST = json.loads((Path(__file__).parents[1] / "cases" / "slump_fast.json").read_text(encoding="utf-8"))
G = 9.81


def fast(sound_speed, **changes):
    data = copy.deepcopy(FAST) | {"name": "slump", "output": {"report": False}} | changes
    data["bodies"][0]["material"]["sound_speed"] = sound_speed
    return parse_case(data)


def advance(simulation, until):
    while simulation.time < until:
        simulation.advance(until - simulation.time)


def test_at_rest_a_mach_number_is_the_inverse_of_a_factor():
    """c = √(2 g h) / mach: no part of a body at rest can fall faster than √(2 g h)."""
    by_mach, by_factor = Simulation(fast({"mach": 0.1})), Simulation(fast({"factor": 10}))
    assert by_mach.particles.groups[0].sound_speed == pytest.approx(
        by_factor.particles.groups[0].sound_speed, rel=1e-9
    )
    assert fast({"mach": 0.1}).sound_speed(fast({"mach": 0.1}).bodies[0].material) == pytest.approx(
        10 * math.sqrt(2 * G * 0.3)
    )


def test_the_mach_number_stays_below_what_was_asked_and_steps_grow_as_the_body_falls():
    history = mpmkit.run(fast({"mach": 0.1}, until=1.5))
    assert float(history.mach_number.max()) <= 0.1 * (1 + 1e-12)
    assert float(history.mach_number.max()) > 0.04  # viscosity leaves half of the free fall
    # The head falls from 0.3 m to about the height of the sheet, and √ of it is the sound speed; G, 0.05 ρ c²
    # at the start, stays.
    fallen = float(history.height[-1]) / 0.3
    expected = math.sqrt((1 + 4 * 0.05 / 3) / (fallen + 4 * 0.05 / 3))
    assert float(history.time_step[-1] / history.time_step[0]) == pytest.approx(expected, rel=0.1)


def test_a_modulus_stays_as_it_is_where_the_sound_falls():
    """A former fault (5): G = 0.05 ρ c² fell with the sound speed, until the yield strain of the sheet at
    rest was 2.3 %."""
    simulation = Simulation(fast({"mach": 0.1}))
    advance(simulation, 0.7)
    (group,) = simulation.particles.groups
    assert group.sound_speed < 0.5 * math.sqrt(2 * G * 0.3) / 0.1
    kinematics = simulation.particles.kinematics(group)
    stress = np.zeros_like(simulation.particles.stress)
    stress[:, 4] = 188.91
    energy = group.law.strain_energy(kinematics, group.state, stress) / kinematics.volume_ratio
    assert 188.91 / (188.91**2 / (2 * energy)) == pytest.approx(188.91 / 75772.0, rel=1e-3)  # 0.25 %


def thrown(sound_speed, scheme):
    """Half a metre of inviscid fluid thrown at a wall in a tube, without gravity: K + U(0) = 1."""
    return parse_case(
        {
            "space": "plane-strain", "until": 1.0, "gravity": [0, 0], "name": "thrown",
            "grid": {
                "cell_size": 0.025, "domain": {"x": [0, 0.1], "z": [0, 6]},
                "faces": dict.fromkeys(("x_min", "x_max", "z_min", "z_max"), "slip"),
            },
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [0, 0.2], "upper": [0.1, 0.7]},
                    "material": {
                        "law": "newtonian", "density": 1000, "viscosity": 0.0, "sound_speed": sound_speed,
                    },
                    "velocity": [0, -1.0],
                }
            ],
            "scheme": scheme,
            "output": {"report": False},
        }
    )  # fmt: skip


@pytest.mark.parametrize("mach", [0.1, 0.3])
@pytest.mark.parametrize("scheme", [{}, {"order": "musl", "velocity": "flip"}], ids=["default", "musl"])
def test_a_sound_that_follows_the_flow_creates_no_energy_at_an_impact(mach, scheme):
    """Fault 38: K + U was up to 1.59 (default) and 1.87 (musl) of the first, and the rebound 1.04 as fast.

    1 % is the order's own: as much as with a sound speed that does not change.
    """
    simulation = Simulation(thrown({"mach": mach}, scheme | {"redistribution": "none"}))
    simulation.guards.watches_density = False  # FLIP leaves it 20 % off at the end of the tube
    p = simulation.particles
    first = kinetic_energy(p)
    while simulation.time < 0.9:
        simulation.advance()
        assert kinetic_energy(p) + compressive_energy(p) <= 1.01 * first
    assert 0.3 < float(p.mass @ p.velocity[:, 1] / p.mass.sum()) < 1.0  # it is on its way back


@pytest.mark.parametrize(("mach", "most"), [(0.1, 1.01), (0.3, 1.05)])
@pytest.mark.parametrize("scheme", [{}, {"velocity": "flip"}], ids=["default", "flip"])
def test_the_default_redistribution_creates_little_energy_at_an_impact(mach, most, scheme):
    """It counts the shear of the impact, and not the time in which the fluid flew to it without any.

    With that time it made 21 % of an inviscid fluid at Mach 0.1, and with FLIP doubled it.
    """
    simulation = Simulation(thrown({"mach": mach}, scheme))
    p, first = simulation.particles, kinetic_energy(simulation.particles)
    while simulation.time < 0.9:
        simulation.advance()
        assert kinetic_energy(p) + compressive_energy(p) <= most * first


def test_another_sound_speed_is_taken_at_the_same_energy_and_slowly():
    simulation = Simulation(thrown({"mach": 0.3}, {}))
    p, (group,) = simulation.particles, simulation.particles.groups
    p.volume_ratio[:] = np.linspace(0.6, 1.5, len(p))
    p.volume_ratio[3] = 1.0
    before, stored, ratio = group.sound_speed, group.compressive_energy(p.volume_ratio), p.volume_ratio.copy()
    length = float(np.ptp(p.position[:, 1]))
    follow_flow(p, simulation.grid, np.zeros(2), np.zeros(2), [before], elapsed=length / before)
    assert group.sound_speed == pytest.approx(before * math.exp(CHANGE), rel=1e-9)  # e is larger by U
    np.testing.assert_allclose(group.compressive_energy(p.volume_ratio), stored, rtol=1e-10, atol=1e-12)
    np.testing.assert_array_equal(np.sign(p.volume_ratio - 1), np.sign(ratio - 1))
    np.testing.assert_allclose(p.volume, p.volume_ratio * p.initial_volume, rtol=1e-15)
    np.testing.assert_array_equal(p.pressure, group.pressure(p.volume_ratio))


def test_the_slump_is_that_of_a_constant_sound_speed():
    """The compressibility stays the same part of the head, so the spread does not change."""
    follows, constant = (
        mpmkit.run(fast(c, until=0.6)).spread_diameter for c in ({"mach": 0.1}, {"factor": 10})
    )
    assert np.abs(follows.values / constant.values - 1).max() < 0.01


def test_energy_is_the_bernoulli_head_and_a_periodic_axis_has_no_potential():
    simulation = Simulation(fast({"mach": 0.1}))
    p, grid = simulation.particles, simulation.grid
    p.velocity[:] = 0.0
    p.velocity[7] = [3.0, 4.0]
    top = p.position[:, 1] + p.box[:, 1] - (p.position[:, 1] - p.box[:, 1]).min()
    expected = max(G * top.max(), G * top[7] + 12.5)
    gravity = np.array([0.0, -G])
    assert largest_energy(p, grid, gravity) == pytest.approx(expected, rel=1e-12)
    grid.faces[1] = 3  # periodic
    assert largest_energy(p, grid, gravity) == pytest.approx(12.5, rel=1e-12)


def test_a_flow_without_gravity_goes_by_its_speed_and_keeps_a_tenth_of_the_sound():
    data = copy.deepcopy(FAST) | {"name": "drop", "gravity": [0, 0], "until": 0.1}
    data["bodies"][0]["velocity"] = [0.0, -2.0]
    data["bodies"][0]["material"]["sound_speed"] = {"mach": 0.05}
    simulation = Simulation(parse_case(data))
    group = simulation.particles.groups[0]
    assert group.sound_speed == pytest.approx(2.0 / 0.05)
    simulation.particles.velocity[:] = 0.0
    first = [group.sound_speed]
    for _ in range(200):
        follow_flow(simulation.particles, simulation.grid, *np.zeros((2, 2)), first, elapsed=0.01)
    assert group.sound_speed == pytest.approx(SLOWEST * 2.0 / 0.05)


@pytest.mark.parametrize(
    ("sound_speed", "gravity", "sentence"),
    [
        ({"mach": 0.1}, [0, 0], "sound_speed is a Mach number, but gravity is .* and nothing moves"),
        ({"mach": 1.5}, None, "sound_speed.mach is 1.5"),
        ({"mach": 0}, None, "sound_speed.mach is 0"),
        ({"mach": 0.1, "factor": 10}, None, "factor"),
    ],
)
def test_a_bad_mach_number_is_met_with_one_sentence(sound_speed, gravity, sentence):
    changes = {} if gravity is None else {"gravity": gravity}
    with pytest.raises(CaseError, match=sentence) as error:
        fast(sound_speed, **changes)
    assert "\n" not in str(error.value)


def test_a_flow_that_is_fast_against_its_sound_is_warned_of_once(caplog):
    with caplog.at_level(logging.WARNING, logger="mpmkit"):
        history = mpmkit.run(fast({"factor": 3}, until=0.4))
    (warning,) = [r.getMessage() for r in caplog.records if "Mach" in r.getMessage()]
    assert "a larger sound_speed" in warning
    assert float(history.mach_number.max()) > 0.1
    caplog.clear()
    with caplog.at_level(logging.WARNING, logger="mpmkit"):
        mpmkit.run(fast({"factor": 10}, until=0.4))
    assert not caplog.records


def test_energy_is_not_created_as_the_sound_speed_falls():
    """Softening the material slowly stores work of gravity in it, and gives none back."""
    history = mpmkit.run(fast({"mach": 0.1}, until=1.5))
    total = (
        history.kinetic_energy + history.potential_energy + history.strain_energy + history.compressive_energy
    ).values
    assert np.diff(total).max() < 1e-3 * (total[0] - total[-1])
