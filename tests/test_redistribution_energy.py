"""Energy that a redistribution adds or removes is in the energy balance, and counts as created."""

from __future__ import annotations

import numpy as np
import pytest
from test_redistribution import CELLS, DX, FLUID, SEAMED, WALLED, disorder, filled

import mpmkit
from mpmkit.case import parse_case
from mpmkit.contracts import Redistribution
from mpmkit.errors import GuardStop
from mpmkit.solver.simulation import Simulation

ENERGIES = ("kinetic_energy", "potential_energy", "strain_energy", "compressive_energy")
WAVE = {"amplitude": [0.5, 0.5], "wave_vector": [10.0, 10.0]}
AREA = (CELLS * DX) ** 2
MASS = 1000 * AREA


class Rare(Redistribution):
    """A redistribution that acts rarely; the tests define its action."""

    name = "rare"
    api_version = 2
    citation = "none"

    def is_due(self, shear):
        return shear > 1e-3


class Lifts(Rare):
    """All material by a hundredth of a cell."""

    def redistribute(self, ops, time):
        shift = np.zeros((len(ops.shear_rate()), 2))
        shift[:, 1] = DX / 100
        ops.shift(shift)


class Squeezes(Rare):
    """All volumes by a hundredth."""

    def redistribute(self, ops, time):
        ops.scale_volume_ratio(np.full(len(ops.shear_rate()), 0.99))


class Shakes(Rare):
    """Volumes of half of the particles up and of the others down, which the scheme then evens out again."""

    name = "shakes"
    by: float = 0.02

    def redistribute(self, ops, time):
        sign = np.where(np.arange(len(ops.shear_rate())) % 2, 1.0, -1.0)
        ops.scale_volume_ratio(1 + self.by * sign)


def with_(author, faces=WALLED, velocity=WAVE, gravity=(0.0, 0.0)):
    """A closed domain that is full of fluid, and this redistribution."""
    side = CELLS * DX
    body = {"shape": {"kind": "box", "lower": [0, 0], "upper": [side, side]}, "material": FLUID}
    case = parse_case(
        {
            "space": "plane-strain",
            "until": 1.0,
            "gravity": list(gravity),
            "grid": {
                "cell_size": DX,
                "domain": {"x": [0, side], "z": [0, side]},
                "faces": faces["plane-strain"],
            },
            "bodies": [body if velocity is None else body | {"velocity": velocity}],
        }
    )
    scheme = case.scheme.model_copy(update={"redistribution": author})
    return Simulation(case.model_copy(update={"scheme": scheme}))


def total(simulation):
    measured = simulation.measures(simulation.particles)
    return sum(measured[name] for name in ENERGIES)


def redistribute(simulation):
    """One redistribution between two steps; what the energies of the history have changed by, J."""
    simulation.operations.begin()
    stage, before = simulation.operations.stage, total(simulation)
    stage.shear = stage.elapsed = 0.5
    simulation.particles.velocity_gradient[:, 0, 1] = 1.0
    assert stage.redistribute_if_due(simulation.operations.window, simulation.operations.sorting)
    return total(simulation) - before


@pytest.mark.parametrize("gravity", [(0.0, -9.0), (5.0, -9.0)])
def test_what_is_lifted_has_gained_its_height(gravity):
    """m g δ of a domain without a lid. Along a periodic axis there is no height."""
    open_above = {"plane-strain": {"x_min": "periodic", "x_max": "periodic", "z_min": "slip"}}
    simulation = with_(Lifts(), open_above, None, gravity)
    changed = redistribute(simulation)
    assert simulation.redistribution_energy == pytest.approx(MASS * 9.0 * DX / 100, rel=1e-9)
    assert changed == pytest.approx(simulation.redistribution_energy, rel=1e-9)


def test_what_is_squeezed_has_stored_it():
    """ρ c² (1 - J)²/2 a volume, of an equation of state that is linear in J, and closely of any other."""
    simulation = with_(Squeezes(), velocity=None)
    changed = redistribute(simulation)
    assert simulation.redistribution_energy == pytest.approx(AREA * 1000 * 20**2 * 0.01**2 / 2, rel=0.02)
    assert changed == pytest.approx(simulation.redistribution_energy, rel=1e-9)


@pytest.mark.parametrize("faces", [WALLED, SEAMED], ids=["walls", "seams"])
def test_what_even_puts_in_or_takes_is_what_the_energies_change_by(faces):
    """Of disorder that moves: J, places and velocities change, and so does each of the energies."""
    simulation = filled("plane-strain", faces, WAVE)
    p = disorder(simulation)
    p.affine[:] = np.random.default_rng(2).normal(size=p.affine.shape)
    changes = [redistribute(simulation) for _ in range(3)]
    assert all(changes)
    assert simulation.redistribution_energy == pytest.approx(sum(changes), rel=1e-9)


def test_the_balance_counts_it_as_created_and_names_it():
    """It is part of what was created; the rest of the scheme has done nothing yet."""
    simulation = with_(Squeezes())
    guards = simulation.guards
    simulation.check()
    assert guards.balance.created == 0
    changed = redistribute(simulation)
    simulation.check()
    assert guards.balance.redistributed == pytest.approx(changed)
    assert guards.balance.created == pytest.approx(changed)


def run(simulation, steps):
    for _ in range(steps):
        simulation.advance()
    simulation.check()


def dissipated(simulation):
    """Power of the extra stress, W: Σ V s:D."""
    p = simulation.particles
    D = (p.velocity_gradient + p.velocity_gradient.transpose(0, 2, 1)) / 2
    normal = np.einsum("pi,pii->p", p.stress[:, :3], D)
    shear = p.stress[:, 3] * D[:, 1, 2] + p.stress[:, 4] * D[:, 0, 2] + p.stress[:, 5] * D[:, 0, 1]
    return float(p.volume @ (normal + 2 * shear))


def test_a_steady_film_dissipates_the_power_of_gravity():
    """Work of gravity and what the redistribution put in, less what moves and is stored, grows by what the
    material dissipates, and, in a film that moves steadily, by the power of gravity."""
    film = {
        "space": "plane-strain",
        "until": 0.6,
        "gravity": [9.81 * 0.5, -9.81 * np.sqrt(0.75)],
        "grid": {
            "cell_size": 0.01,
            "domain": {"x": [0, 0.02], "z": [0, 0.07]},
            "faces": {"z_min": "stick", "x_min": "periodic", "x_max": "periodic"},
        },
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0, 0], "upper": [0.02, 0.05]},
                "material": FLUID | {"density": 2300, "yield_stress": 40, "plastic_viscosity": 20},
            }
        ],
        "scheme": {"redistribution": "even"},
    }
    simulation, work, power = Simulation(parse_case(film)), 0.0, 0.0
    while simulation.time < 0.5:
        simulation.advance()
    p, balance = simulation.particles, simulation.guards.balance
    simulation.check()
    begin, first = simulation.time, balance.created - balance.redistributed
    while simulation.time < 0.6:
        dt = simulation.advance()
        work += dt * dissipated(simulation)
        power += dt * 9.81 * 0.5 * float(p.mass @ p.velocity[:, 0])
    simulation.check()
    lost = first - (balance.created - balance.redistributed)
    assert balance.redistributed != 0
    assert lost == pytest.approx(work, rel=0.03)
    assert lost == pytest.approx(power, rel=0.03)
    assert simulation.time - begin == pytest.approx(0.1, rel=0.01)


def test_no_energy_is_created_in_a_tank():
    simulation = with_(filled("plane-strain").case.scheme.redistribution, WALLED, WAVE, (0.0, -9.0))
    run(simulation, 300)
    balance = simulation.guards.balance
    assert balance.redistributed != 0
    assert balance.created - balance.redistributed < 0


@pytest.mark.parametrize("by", [0.05, 0.004])
def test_a_redistribution_that_heats_is_stopped(by):
    """Whether it puts in more than there was at once, or little by little, faster than it is dissipated."""
    simulation = with_(Shakes(by=by))
    with pytest.raises(GuardStop) as stop:
        run(simulation, 3000)
    assert stop.value.guard == "energy"
    put_in = simulation.guards.balance.redistributed
    assert f"redistribution 'shakes' has added {put_in:.4g} J: try another one, or 'none'" in str(stop.value)


def test_even_is_not_stopped_for_what_it_puts_in():
    simulation = filled("plane-strain", WALLED, WAVE)
    disorder(simulation)
    run(simulation, 600)
    balance = simulation.guards.balance
    assert balance.redistributed != 0
    assert balance.excess < 0.05


def test_it_is_a_variable_of_the_history_and_survives_a_checkpoint():
    simulation = filled("plane-strain", WALLED, WAVE)
    disorder(simulation)
    run(simulation, 100)
    assert simulation.redistribution_energy != 0
    other = Simulation(simulation.case)
    other.restore(simulation.state())
    assert other.redistribution_energy == simulation.redistribution_energy
    case = simulation.case.model_copy(update={"until": 0.05})
    history = mpmkit.run(case)
    assert history.redistribution_energy.attrs["units"] == "J"
    assert float(history.redistribution_energy[-1]) != 0
    assert float(history.redistribution_energy[0]) == 0
