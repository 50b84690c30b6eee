"""Laws with an exact yield stress, and viscous laws in their relaxed form: flow curve and elastic part."""

from __future__ import annotations

import numpy as np
import pytest
from test_laws import LAWS, RATES, make

from mpmkit.contracts import REST_SHEAR_RATE, ElastoviscoplasticLaw, maxwell
from mpmkit.testing.specimens import DENSITY, SOUND_SPEED, Specimens, simple_shear

TAU0, K, N = 188.91, 45.65, 1.33
EVP = {name: law for name, law in LAWS.items() if issubclass(law, ElastoviscoplasticLaw)}
MODULUS = maxwell.STIFFNESS * DENSITY * SOUND_SPEED**2


def steady_shear(law, rates, strain=2.0, steps=2000):
    """Shear stress after a strain of 2, at which it is steady."""
    rates = np.asarray(rates, dtype=float)
    found = []
    for rate in rates:
        specimens = Specimens(law, 1)
        found.append(specimens.drive(simple_shear(np.array([rate]), 0, 2), strain / rate, steps)[0, 0, 2])
    return np.array(found)


@pytest.mark.parametrize("name", EVP)
def test_there_is_a_flow_curve(name):
    law = make(EVP[name])
    curve = law.flow_curve(RATES)
    assert np.all(np.diff(curve) >= 0)
    assert law.flow_curve(np.array([REST_SHEAR_RATE]))[0] == pytest.approx(law.yield_stress, rel=1e-6)


def test_simple_shear_of_the_concrete():
    """The spring turns with the material: its normal stress of tau²/G takes (tau/G)² of the shear stress."""
    law = make(LAWS["herschel-bulkley-evp"], shear_modulus=1e7)
    assert steady_shear(law, [1.0, 5.0]) == pytest.approx([234.56, 577.12], rel=1e-4)


def test_uniaxial_flow_of_the_concrete():
    """sigma = √3 (tau0 + k (√3 e)^n); nothing turns, so that the steady stress is exact."""
    law = make(LAWS["herschel-bulkley-evp"])
    for rate, expected in ((0.1, 334.88), (1.0, 491.37), (5.0, 1723.30)):
        L = np.diag([rate / 2, rate / 2, -rate])[None]
        stress = Specimens(law, 1).drive(L, 2.0 / rate, 2000)[0]
        assert stress[0, 0] - stress[2, 2] == pytest.approx(expected, rel=1e-5)
        exact = np.sqrt(3) * (TAU0 + K * (np.sqrt(3) * rate) ** N)
        assert stress[0, 0] - stress[2, 2] == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("n", [0.01, 0.1, 3.0, 10.0])
def test_extreme_indices_are_finite_and_between_yield_and_trial(n):
    law = make(LAWS["herschel-bulkley-evp"], flow_index=n)
    trial = TAU0 * (1 + np.geomspace(1e-12, 1e6, 200))
    found = law.relaxed_stress(trial, 5.0)
    assert np.all(np.isfinite(found))
    assert np.all((found >= TAU0 * (1 - 1e-12)) & (found <= trial * (1 + 1e-12)))


@pytest.mark.parametrize("n", [0.5, 1.0, 1.33])
@pytest.mark.parametrize("stiffness", [1e-3, 1.0, 1e3])
def test_newton_and_the_general_solution_agree(n, stiffness):
    law = make(LAWS["herschel-bulkley-evp"], flow_index=n)
    trial = TAU0 * np.concatenate([[0.0, 0.5, 1.0], 1 + np.geomspace(1e-9, 1e4, 200)])
    general = maxwell.solve(law.flow_curve, trial, stiffness, REST_SHEAR_RATE)
    found = law.relaxed_stress(trial, stiffness)
    assert found == pytest.approx(general, rel=1e-10)
    rate = (trial - found) / stiffness
    flows = trial > TAU0 * (1 + 1e-6)
    assert found[flows] == pytest.approx(law.flow_curve(rate[flows]), rel=1e-6)
    assert np.array_equal(found[:3], trial[:3])


def test_with_index_1_it_is_bingham():
    hb = make(LAWS["herschel-bulkley-evp"], flow_index=1.0)
    bingham = make(LAWS["bingham-evp"], plastic_viscosity=hb.consistency)
    trial = np.linspace(0.0, 5000.0, 300)
    assert hb.relaxed_stress(trial, 7.0) == pytest.approx(bingham.relaxed_stress(trial, 7.0), rel=1e-12)


def test_without_yield_stress_it_is_the_power_law():
    law = make(LAWS["herschel-bulkley-evp"], yield_stress=0.0, shear_modulus=1e7)
    assert steady_shear(law, [0.5, 5.0]) == pytest.approx(K * np.array([0.5, 5.0]) ** N, rel=1e-4)


@pytest.mark.parametrize("name", EVP)
def test_below_yield_it_is_elastic(name):
    """Shear to 0.9 of the yield strain and back: Hooke's law on the way, and no stress at the end."""
    law = make(EVP[name], shear_modulus=MODULUS)
    strain = 0.9 * law.yield_stress / MODULUS
    specimens = Specimens(law, 1)
    there = specimens.drive(simple_shear(np.array([1.0]), 0, 2), strain, 10)
    assert there[0, 0, 2] == pytest.approx(MODULUS * strain, rel=1e-3)
    back = specimens.drive(simple_shear(np.array([-1.0]), 0, 2), strain, 10)
    assert np.abs(back).max() < 1e-3 * law.yield_stress


@pytest.mark.parametrize("name", EVP)
def test_it_comes_to_rest(name):
    """When the strain is held after flow, the stress falls to the yield stress and stays there."""
    law = make(EVP[name])
    specimens = Specimens(law, 1)
    specimens.drive(simple_shear(np.array([5.0]), 0, 2), 0.5, 500)
    still = np.zeros((1, 3, 3))
    shear = [np.abs(specimens.drive(still, 0.1, 200)[0, 0, 2]) for _ in range(2)]
    assert shear == pytest.approx([law.yield_stress] * 2, rel=2e-3)


@pytest.mark.parametrize("name", EVP)
def test_the_step_has_little_influence(name):
    """Backward Euler is stable for any step, and a step ten times as long changes the result little."""
    law = make(EVP[name])
    fine, coarse = (
        Specimens(law, 1).drive(simple_shear(np.array([2.0]), 0, 2), 0.2, steps)[0, 0, 2]
        for steps in (2000, 20)
    )
    assert coarse == pytest.approx(fine, rel=1e-3)


@pytest.mark.parametrize("name", ["newtonian", "bingham", "herschel-bulkley"])
def test_relaxed_form_has_the_flow_curve_of_the_explicit_one(name):
    explicit = make(LAWS[name])
    relaxed = make(LAWS[name], form="relaxed")
    rates = np.array([0.5, 5.0])
    expected = explicit.apparent_viscosity(rates) * rates
    found = steady_shear(relaxed, rates, strain=4.0)
    assert found == pytest.approx(expected, rel=1e-3)
    assert relaxed.largest_viscosity(10.0) == 0


def test_relaxed_form_costs_a_delay_below_yield():
    """At a tenth of the yield stress mu = tau0 m, and the stress follows with the time constant tau0 m/G."""
    m = 10.0
    law = make(LAWS["bingham"], form="relaxed", regularisation=m)
    delay = law.yield_stress * m / MODULUS
    rate = 0.01 / m
    specimens = Specimens(law, 1)
    after = specimens.drive(simple_shear(np.array([rate]), 0, 2), delay, 400)[0, 0, 2]
    steady = law.apparent_viscosity(np.array([rate]))[0] * rate
    assert after / steady == pytest.approx(1 - np.exp(-1.0), rel=0.02)


def test_general_solution_of_a_curve_beyond_any_number():
    """f = 50 + e^γ̇ overflows at the rate that the spring alone would have."""
    trial = np.array([10.0, 60.0, 500.0, 1e5])
    found = maxwell.solve(lambda rate: 50.0 + np.exp(rate) - 1.0, trial, 1e-3, REST_SHEAR_RATE)
    rate = np.log(found[1:] - 49.0)
    assert found[0] == 10.0
    assert found[1:] + 1e-3 * rate == pytest.approx(trial[1:], rel=1e-9)


@pytest.mark.parametrize("stiffness", [1e-6, 1e-2, 1.0, 1e4])
@pytest.mark.parametrize("of_rate", [False, True])
def test_general_solution_of_a_curve_in_single_precision(stiffness, of_rate):
    """A curve in single precision gives the stress to single precision."""

    def curve(rate):
        return 188.91 + 45.65 * rate**0.4

    def single(rate):
        return curve(rate.astype(np.float32) if of_rate else rate).astype(np.float32)

    trial = np.geomspace(1.0, 1e6, 500)
    exact = maxwell.solve(curve, trial, stiffness, REST_SHEAR_RATE)
    np.testing.assert_allclose(maxwell.solve(single, trial, stiffness, REST_SHEAR_RATE), exact, rtol=2e-6)
    whole = maxwell.solve(curve, trial.astype(np.float32), stiffness, REST_SHEAR_RATE)
    np.testing.assert_allclose(whole, exact, rtol=2e-6)


def test_general_solution_of_a_curve_that_falls_is_refused():
    with pytest.raises(ArithmeticError, match="rise"):
        maxwell.solve(
            lambda rate: np.where(rate < 1.0, 50.0, 500.0), np.array([200.0]), 1e-3, REST_SHEAR_RATE
        )


def test_perfect_plasticity_by_a_scalar():
    class Plastic(ElastoviscoplasticLaw):
        name, citation, api_version = "plastic", "none", 2

        def flow_curve(self, shear_rate):
            return 50.0

    law = Plastic()
    assert "strain" in law.remarks(DENSITY, SOUND_SPEED)[0]
    assert law.relaxed_stress(np.array([10.0, 80.0]), 7.0) == pytest.approx([10.0, 50.0])
