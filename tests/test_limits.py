"""Limits of the time step: of a strained solid, and of a viscosity in slow flow."""

import numpy as np
import pytest

import mpmkit
from mpmkit.case import parse_case
from mpmkit.contracts import Kinematics
from mpmkit.errors import GuardStop
from mpmkit.registry import installed
from mpmkit.solver.energies import kinetic_energy, strain_energy
from mpmkit.solver.simulation import Simulation

DENSITY = 1000.0


def rubber():
    return installed().of_kind("law")["neo-hookean"](youngs_modulus=1e5, poisson_ratio=0.3)


def moving(F):
    """What the law gets of particles at rest with deformation gradients F."""
    F = np.array(F, dtype=float)
    n = len(F)
    return Kinematics(
        velocity_gradient=np.zeros((n, 3, 3)), volume_ratio=np.linalg.det(F), pressure=np.zeros(n),
        density=DENSITY, deformation_gradient=F,
    )  # fmt: skip


@pytest.mark.parametrize("stretch", [0.3, 0.6, 1.0, 1.8])
def test_the_wave_speed_of_a_strained_solid_is_its_tangent(stretch):
    """ρ c² = dσ11/dε along the wave, of a bar stretched along it and held across, by central differences."""
    law, h = rubber(), 1e-6
    F = np.array([np.diag([stretch * (1 + e), 1.0, 1.0]) for e in (-h, h)])
    stress = np.zeros((2, 6))
    law.update_stress(moving(F), {}, 1.0, stress)
    # Of the same material: P = σ across the unchanged section, and lengths are the present ones.
    tangent = (stress[1, 0] - stress[0, 0]) / (2 * h)
    along = np.sqrt(tangent * stretch / DENSITY)  # ρ = ρ0/J
    said = law.present_wave_speed(moving([np.diag([stretch, 1.0, 1.0])]), {})
    across = np.sqrt((law.shear_modulus * 2 + law.lame * (1 - np.log(stretch))) / DENSITY)
    assert said == pytest.approx(max(along, across), rel=1e-6)
    assert law.present_wave_speed(moving([np.eye(3)]), {}) == pytest.approx(law.wave_speed(DENSITY, None))


def thrown(speed=6.0, **scheme):
    """A block of rubber thrown at its mirror image, at half the speed of its sound by default.

    A wall would take the energy of half a cell from it at the moment of touch, and hide what the order makes.
    """
    return parse_case(
            {
                "space": "plane-strain", "until": 0.3, "gravity": [0, 0],
                "grid": {
                    "cell_size": 0.05, "domain": {"x": [-2, 3], "z": [0, 4]}, "faces": {"z_min": "symmetry"},
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0.3, 0.1], "upper": [0.7, 0.5]},
                        "material": {
                            "law": "neo-hookean", "density": DENSITY, "youngs_modulus": 1e5,
                            "poisson_ratio": 0.3,
                        },
                        "velocity": [0, -speed],
                    }
                ],
                "scheme": scheme,
                "output": {"report": False},
            }
    )  # fmt: skip


def impact(**scheme):
    return Simulation(thrown(**scheme))


def rebound(simulation):
    """K + U at the end over that at the start."""
    p = simulation.particles
    first = kinetic_energy(p)
    while simulation.time < 0.3:
        simulation.advance(0.3 - simulation.time)
    simulation.check()
    return (kinetic_energy(p) + strain_energy(p)) / first


@pytest.mark.parametrize(("order", "fraction"), [("usf", 0.5), ("usf", 1.0), ("musl", 1.0)])
def test_a_hard_impact_that_gains_energy_is_stopped(order, fraction):
    """A former fault (42): 1.20 times the energy at the end (usf), 1.34 (musl), without a message."""
    simulation = impact(order=order, velocity="flip", time_step={"fraction": fraction})
    with pytest.raises(
        GuardStop, match=r"J of energy were created.*reduce scheme\.time_step\.fraction"
    ) as stop:
        rebound(simulation)
    assert stop.value.guard == "energy"


@pytest.mark.parametrize(
    "scheme",
    [
        {},
        {"order": "usl", "velocity": "flip"},
        {"order": "musl", "velocity": "flip", "time_step": {"fraction": 0.1}},
    ],
    ids=["default", "usl", "musl"],
)
def test_a_hard_impact_in_steps_that_fit_goes_on(scheme):
    assert rebound(impact(**scheme)) <= 1.02


def test_energy_created_in_slow_motion_is_a_warning_and_no_stop(caplog):
    """USF with FLIP creates a few per cent at a tenth of the wave speed. Such a run gets a warning and is not
    stopped."""
    mpmkit.run(thrown(speed=1.2, order="usf", velocity="flip"))
    assert "% of energy was created" in caplog.text


def test_the_step_is_that_of_the_strained_solid():
    simulation = impact(order="musl", velocity="flip")
    first, shortest = simulation.limits.acoustic, np.inf
    while simulation.time < 0.1:
        simulation.advance()
        shortest = min(shortest, simulation.limits.acoustic)
    p, (group,) = simulation.particles, simulation.particles.groups
    assert shortest < 0.85 * first
    assert first == pytest.approx(0.05 / group.wave_speed)
    assert simulation.limits.acoustic <= 1.1 * 0.05 / group.law.present_wave_speed(p.kinematics(group), {})


def thickening(slower):
    """A slump of a fluid that thickens, k γ̇³, in a unit of time that is so much longer."""
    return parse_case(
        {
            "space": "plane-strain", "until": 0.1 * slower, "gravity": [0, -9.81 / slower**2],
            "grid": {
                "cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 0.6]},
                "faces": {"z_min": "slip", "x_min": "symmetry"},
            },
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [0, 0], "upper": [0.4, 0.4]},
                    "material": {
                        "law": "herschel-bulkley", "density": DENSITY, "sound_speed": {"factor": 10},
                        "yield_stress": 0.0, "consistency": 100.0 * slower, "flow_index": 3.0,
                    },
                }
            ],
            "scheme": {"order": "musl"},
            "output": {"report": False},
        }
    )  # fmt: skip


def test_a_flow_in_slow_time_takes_as_many_steps():
    """The number of steps does not depend on the unit of time. A former fault (77): every scene assumed a
    rate of 1 /s, so a shear-thickening fluid that flows for months got the viscosity of that rate."""
    steps = []
    for slower in (1.0, 1e3, 1e6):
        case = thickening(slower)
        simulation = Simulation(case)
        while case.until - simulation.time > 1e-9 * case.until:
            simulation.advance(case.until - simulation.time)
        assert simulation.limited_by == "viscous"
        steps.append(simulation.steps)
    assert max(steps) - min(steps) <= 1


def test_the_largest_viscosity_is_that_of_the_rates_below():
    law = installed().of_kind("law")["herschel-bulkley"](yield_stress=0.0, consistency=2.0, flow_index=3.0)
    for rate in (1e-6, 0.3, 1.0, 40.0):
        assert law.largest_viscosity(rate) == pytest.approx(2.0 * rate**2, rel=1e-12)
