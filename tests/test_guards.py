"""Every guard of a run, provoked: its sentence names the step, the particle, a likely cause and a cure."""

from __future__ import annotations

import numpy as np
import pytest

import mpmkit
from mpmkit.case.plugins import plugins_of
from mpmkit.contracts import ConstitutiveLaw, quantity
from mpmkit.errors import GuardStop
from mpmkit.registry import Registered, Registry, installed
from mpmkit.registry.blame import blaming_plugins
from mpmkit.solver.balance import CREATED
from mpmkit.solver.simulation import CONTROL_INTERVAL

FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 1.0, "sound_speed": 10.0}


class Swelling(ConstitutiveLaw):
    """A pressure of its own that grows with time: the chemistry of a grout, or a fault."""

    name = "swelling"
    api_version = 2
    citation = "none"
    uses_equation_of_state = False
    pressure: float = quantity("Pa", "pressure", ge=0)

    def update_stress(self, kinematics, state, dt, stress):
        stress[:, :3] = -self.pressure

    def wave_speed(self, density, sound_speed):
        return 10.0


class Declared(Swelling):
    """The same law, which declares that it adds energy."""

    name = "declared"
    passive = False


def scene(material=FLUID, gravity=(0.0, 0.0), velocity=(0.0, 0.0), faces=None, **scheme):
    """A block in the middle of its domain."""
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    found += [Registered("law", law, "tests", "1", law.name) for law in (Swelling, Declared)]
    case = {
        "space": "plane-strain",
        "until": 10.0,
        "gravity": list(gravity),
        "grid": {"cell_size": 0.1, "domain": {"x": [0, 2], "z": [0, 2]}, "faces": faces or {}},
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0.8, 0.8], "upper": [1.2, 1.2]},
                "material": material,
                "velocity": list(velocity),
            }
        ],
        "scheme": scheme,
    }
    return mpmkit.Simulation(mpmkit.parse_case(case, registry=Registry(found, [])))


def stopped(simulation, guard, steps=3 * CONTROL_INTERVAL):
    """The sentence of the stop, and the index of the particle."""

    def run():
        with np.errstate(all="ignore"), blaming_plugins(plugins_of(simulation.case)):
            for _ in range(steps):
                simulation.advance()
            simulation.check()

    with pytest.raises(GuardStop) as stop:
        run()
    error, p = stop.value, simulation.particles
    assert error.guard == guard
    assert error.exit_status == 3
    assert f"stopped at step {simulation.steps}, t = " in str(error)
    assert f"particle {error.particle} " in str(error)
    return str(error), int(np.flatnonzero(p.number == error.particle)[0])


@pytest.mark.parametrize("field", ["position", "velocity", "stress", "pressure"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_non_finite(field, value):
    simulation = scene()
    simulation.advance()
    getattr(simulation.particles, field)[5] = value
    said, where = stopped(simulation, "non-finite", steps=0)
    assert where == 5
    assert "probably the step is too long: reduce scheme.time_step.fraction, which is 0.5" in said


def test_particle_outside():
    said, where = stopped(scene(velocity=(3.0, 0.0)), "particle-outside", steps=1000)
    assert "left the grid at x = 2.0" in said
    assert "enlarge grid.domain or close that face, x_max; if the particle was thrown out" in said
    assert where >= 0


@pytest.mark.parametrize("face", ["slip", "stick", {"kind": "friction", "coefficient": 0.4}])
def test_the_sentence_for_a_closed_face_does_not_propose_to_close_it(face):
    simulation = scene(faces={"x_max": face})
    simulation.advance()
    simulation.particles.position[3, 0] = 2.3
    said, _ = stopped(simulation, "particle-outside", steps=1)
    assert "left the grid at x = 2.3" in said
    assert "through a face that is closed; probably the step is too long" in said
    assert "close that face" not in said


def test_the_sentence_for_torn_material_does_not_blame_the_step():
    """A shorter step cannot repair material with boxes longer than a cell."""
    simulation = scene()
    simulation.advance()
    p = simulation.particles
    p.box[:16, 0] = 0.06  # of the half of the particles; a cell is 0.1 m
    p.volume_ratio[3] = 11.0
    said, _ = stopped(simulation, "volume-ratio", steps=0)
    assert "the material is torn: 25 % of its volume is in boxes longer than a cell" in said
    assert "a shorter step does not cure this, but smaller cells or scheme.splitting may" in said
    assert "probably the step is too long" not in said


@pytest.mark.parametrize("ratio", [-1.0, 0.0, 0.09, 11.0, np.nan])
def test_volume_ratio_out_of_range(ratio):
    simulation = scene()
    simulation.advance()
    simulation.particles.volume_ratio[9] = ratio
    said, where = stopped(simulation, "volume-ratio", steps=0)
    assert where == 9
    assert "has a volume ratio of " in said
    assert "reduce scheme.time_step.fraction" in said


def test_created_energy():
    """A block at rest without gravity has no energy to move, but this one flies apart."""
    material = {"law": "swelling", "density": 1000.0, "pressure": 1e2}
    said, where = stopped(scene(material), "energy")
    assert where >= 0
    assert "J of energy were created" in said
    assert "is the fastest" in said


def test_an_oscillation_of_the_energy_is_no_energy_created():
    """A body of few cells that flies into its mirror images at a third of its wave speed: K + U goes up by a
    quarter and down again, as that of an explicit step does for short waves."""
    case = {
        "space": "3d",
        "until": 1e4,
        "gravity": [0.0, 0.0, 0.0],
        "grid": {
            "cell_size": 1.0,
            "domain": {"x": [0, 2], "y": [0, 2], "z": [0, 4]},
            "faces": {
                "x_min": "symmetry",
                "x_max": "symmetry",
                "y_min": "periodic",
                "y_max": "periodic",
                "z_max": "symmetry",
            },
        },
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0, 0, 2], "upper": [2, 2, 4]},
                "material": {"law": "neo-hookean", "density": 100, "youngs_modulus": 1, "poisson_ratio": 0},
                "velocity": [-1 / 30, -1 / 30, -1 / 30],
            }
        ],
    }
    simulation = mpmkit.Simulation(mpmkit.parse_case(case))
    for _ in range(3):
        simulation.advance()
    simulation.check()
    assert simulation.guards.balance.excess > CREATED
    for _ in range(4 * CONTROL_INTERVAL):
        simulation.advance()
    simulation.check()
    assert simulation.guards.balance.excess < 0


def test_a_law_that_declares_its_work_is_not_stopped():
    simulation = scene({"law": "declared", "density": 1000.0, "pressure": 1e2})
    for _ in range(3 * CONTROL_INTERVAL):
        simulation.advance()
    simulation.check()
    assert simulation.measures(simulation.particles)["kinetic_energy"] > 0


def test_energy_of_a_step_beyond_the_limit():
    """At 0.9 of dx/c, beyond the stable 0.7, noise grows: all numbers are finite, and wrong."""
    simulation = scene(velocity=(0.1, 0.0), order="musl", volumetric="own")
    simulation.particles.velocity[::3] *= -1
    simulation.fraction = 0.9
    simulation.choose_time_step()
    said, _ = stopped(simulation, "energy", steps=400)
    assert "J of energy were created: motion and stored energy are " in said
    assert "reduce scheme.time_step.fraction" in said


@pytest.mark.parametrize("gravity", [(0.0, -9.81), (3.0, -4.0)])
@pytest.mark.parametrize("faces", [{}, {"x_min": "periodic", "x_max": "periodic"}], ids=["open", "periodic"])
def test_work_of_gravity_is_not_created_energy(gravity, faces):
    """Falling freely, along a periodic axis as well: what is created is no more than that of one step."""
    simulation = scene(gravity=gravity, faces=faces)
    while simulation.time < 0.2:
        simulation.advance()
    simulation.check()
    balance = simulation.guards.balance
    assert balance.held == pytest.approx(0.5 * 160 * 0.2**2 * np.dot(gravity, gravity), rel=0.1)
    assert -0.05 * balance.held < balance.created < 0.02 * balance.held
    assert balance.excess < CREATED / 10


def test_a_thrown_block_that_rises_and_falls_is_in_balance():
    simulation = scene(gravity=(0.0, -9.81), velocity=(0.0, 2.0))
    most = 0.0
    while simulation.time < 0.45:
        simulation.advance()
        most = max(most, abs(simulation.guards.balance.excess))
    assert most < CREATED / 10


def test_step_collapse():
    """Particles so fast that a run of a minute would take a week."""
    simulation = scene(velocity=(0.1, 0.0))
    simulation.advance()
    simulation.particles.velocity[3] = [0.0, 1e6]
    with pytest.raises(GuardStop) as stop:
        simulation.choose_time_step()
    assert stop.value.guard == "step-collapse"
    assert stop.value.particle == simulation.particles.number[3]
    assert "is the fastest, 1e+06 m/s, and the step has fallen to " in str(stop.value)
    assert "the advective limit sets it" in str(stop.value)


def test_a_step_too_short_to_change_the_time():
    simulation = scene()
    simulation.time = 1e17
    with pytest.raises(GuardStop, match="the step has fallen to") as stop:
        simulation.choose_time_step()
    assert stop.value.guard == "step-collapse"


def test_mass_drift_of_a_particle():
    simulation = scene()
    simulation.advance()
    simulation.particles.mass[7] *= 1 + 1e-6
    said, where = stopped(simulation, "mass-drift", steps=0)
    assert where == 7
    assert "--no-plugins" in said


def test_mass_that_does_not_reach_the_nodes():
    simulation = scene()
    simulation.advance()
    simulation.operations.window.nodes[:, 0] = 0.0
    said, _ = stopped(simulation, "mass-drift", steps=0)
    assert "the nodes have 0 kg; order 'usl' may not map all mass" in said


def test_mass_that_weights_lose_is_the_shape_functions_fault():
    simulation = scene()
    simulation.advance()
    simulation.operations.weight[4] *= 0.99
    simulation.operations.map_to_grid()
    number = simulation.particles.number[4]
    said = rf"the plug-in 'cpgimp' \(shape.*gave particle {number} weights that sum to 0\.9801 and not to 1"
    with pytest.raises(GuardStop, match=said), blaming_plugins(plugins_of(simulation.case)):
        simulation.check()


def test_a_limit_that_is_ignored_is_the_likely_cause():
    simulation = scene({**FLUID, "viscosity": 1e5}, time_step={"ignore": ["viscous"]})
    simulation.advance()
    simulation.particles.velocity[0] = np.nan
    said, _ = stopped(simulation, "non-finite", steps=0)
    assert "probably because the time step of " in said
    assert "exceeds the viscous limit" in said
    assert "remove that limit from it" in said


def test_a_known_failure_of_the_schemes_is_the_likely_cause():
    simulation = scene(shape="linear")
    simulation.advance()
    simulation.particles.velocity[0] = np.nan
    said, _ = stopped(simulation, "non-finite", steps=0)
    assert "probably because order 'usl' with shape 'linear'" in said


def test_guards_count_from_the_state_in_which_a_simulation_begins():
    """A state that is set from outside is not energy created."""
    simulation = scene()
    simulation.particles.velocity[:] = [1.0, 0.0]
    for _ in range(2 * CONTROL_INTERVAL):
        simulation.advance()
    simulation.check()
    assert abs(simulation.guards.balance.excess) < 1e-6
