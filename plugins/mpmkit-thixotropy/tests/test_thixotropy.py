import numpy as np
import pytest
from mpmkit_thixotropy import Thixotropic

from mpmkit.contracts import Kinematics
from mpmkit.contracts.law import initial_state
from mpmkit.testing import law_tests

TAU0, MU, T, ALPHA, G = 50.0, 20.0, 100.0, 0.5, 192e3
GIVEN = {"yield_stress": TAU0, "plastic_viscosity": MU, "flocculation_time": T, "breakdown": ALPHA}
LAW = Thixotropic(**GIVEN, shear_modulus=G)


def steady(rate):
    """λ = 1/(T α γ̇), and with it the stress."""
    return TAU0 * (1 + 1 / (T * ALPHA * rate)) + MU * rate


test_thixotropic = law_tests(LAW, flow_curve=steady, strain=60.0)  # the structure adapts in a strain of 1/α


def drive(rate, duration, steps, structure=0.0, stress=None):
    """Structure and stress of one particle after simple shear in xz."""
    gradient = np.zeros((1, 3, 3))
    gradient[0, 0, 2] = rate
    state = {"structure": np.full(1, structure)}
    stress = np.zeros((1, 6)) if stress is None else stress
    for _ in range(steps):
        kinematics = Kinematics(gradient, np.ones(1), np.zeros(1), 2400.0, sound_speed=40.0)
        LAW.update_stress(kinematics, state, duration / steps, stress)
    return state["structure"][0], stress


@pytest.mark.parametrize("duration", [1.0, 50.0, 600.0])
def test_structure_at_rest_grows_with_time(duration):
    """λ = λ0 + t/T, so that the yield stress grows by A_thix = tau0/T."""
    structure, stress = drive(0.0, duration, 7, structure=0.3)
    assert structure == pytest.approx(0.3 + duration / T, rel=1e-12)
    assert np.all(stress == 0)


@pytest.mark.parametrize("rate", [0.1, 1.0, 10.0])
def test_structure_in_steady_shear(rate):
    """λ = 1/(T α γ̇): of the flow's own rate, which in steady shear is the whole."""
    structure, stress = drive(rate, 60.0 / rate, 6000)
    assert structure == pytest.approx(1 / (T * ALPHA * rate), rel=2e-3)
    assert stress[0, 4] == pytest.approx(steady(rate), rel=2e-3)


def test_structure_breaks_down_exponentially():
    """From λ0 at γ̇: λ = λ_s + (λ0 - λ_s) exp(-α γ̇ t), once the spring has been strained."""
    rate, stressed = 5.0, drive(5.0, 0.2, 2000, structure=4.0)
    structure, _ = drive(rate, 0.4, 4000, *stressed)
    settled = 1 / (T * ALPHA * rate)
    expected = settled + (stressed[0] - settled) * np.exp(-ALPHA * rate * 0.4)
    assert structure == pytest.approx(expected, rel=1e-2)


def test_rest_makes_it_harder_to_start_again():
    """After 100 s at rest, tau0 has doubled: a stress that flowed before is now borne elastically."""
    fresh, rested = 0.0, 100.0 / T
    strain = 1.5 * TAU0 / G
    for structure, flows in ((fresh, True), (rested, False)):
        _, stress = drive(strain / 1e-4, 1e-4, 50, structure=structure)
        _, held = drive(0.0, 10.0, 1000, structure=structure, stress=stress)
        assert (held[0, 4] < 1.2 * TAU0) == flows


def test_a_case_may_start_with_structure():
    """Concrete that has stood for 30 s: λ = 0.3, so that it yields at 1.3 tau0 at first."""
    rested = Thixotropic(**GIVEN, initial_structure=30.0 / T)
    (before,) = rested.flow_curve(np.array([1e-12]))
    assert before == pytest.approx(1.3 * TAU0)
    assert initial_state(rested, 3)["structure"].tolist() == [0.3] * 3
