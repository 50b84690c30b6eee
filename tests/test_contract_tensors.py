"""Tensor algebra for laws, and the short contract of a law with a state, against closed forms."""

import numpy as np
import pytest

from mpmkit.contracts import ElastoviscoplasticLawWithState, StateVariable, tensors
from mpmkit.testing.specimens import Specimens, simple_shear


def some(n=50, seed=0):
    return np.random.default_rng(seed).standard_normal((n, 3, 3))


def test_order_of_the_components():
    six = np.arange(1.0, 7.0)[None]
    assert tensors.from_voigt(six)[0].tolist() == [[1, 6, 5], [6, 2, 4], [5, 4, 3]]
    np.testing.assert_array_equal(tensors.to_voigt(tensors.from_voigt(six)), six)


def test_rate_spin_and_deviator():
    L = some()
    np.testing.assert_allclose(tensors.rate_of_deformation(L) + tensors.spin(L), L, atol=1e-15)
    np.testing.assert_array_equal(tensors.spin(L), -tensors.transposed(tensors.spin(L)))
    np.testing.assert_allclose(np.trace(tensors.deviator(L), axis1=1, axis2=2), 0, atol=1e-15)
    # γ̇ = √(2 D′:D′) = 2 √J2(D)
    np.testing.assert_allclose(
        tensors.shear_rate(L),
        2 * np.sqrt(tensors.second_invariant(tensors.rate_of_deformation(L))),
        rtol=1e-13,
    )


@pytest.mark.parametrize(("along", "across"), [(0, 1), (1, 2), (0, 2)])
def test_simple_shear(along, across):
    L = simple_shear(np.array([3.0]), along, across)
    assert tensors.shear_rate(L) == pytest.approx(3.0)
    stress = np.zeros((1, 3, 3))
    stress[0, along, across] = stress[0, across, along] = -7.0
    stress += 100.0 * np.eye(3)  # a pressure changes nothing
    assert tensors.shear_stress(stress) == pytest.approx(7.0)


def test_uniaxial_stress():
    """J2 = σ²/3."""
    assert tensors.second_invariant(np.diag([6.0, 0.0, 0.0])[None]) == pytest.approx(12.0)


def test_a_tensor_turns_with_the_material():
    """By 1 rad in 100 steps about the axis 2; the rotation is orthogonal, whatever the step."""
    turning = np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]])
    A = np.diag([1.0, 2.0, 3.0])[None]
    turned = A
    for _ in range(100):
        turned = tensors.rotated(turned, turning + 5.0 * np.eye(3), 0.01)
    c, s = np.cos(1.0), np.sin(1.0)
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    np.testing.assert_allclose(turned[0], R @ A[0] @ R.T, atol=2e-5)
    R = tensors.rotation(some(), 7.0)
    np.testing.assert_allclose(R @ tensors.transposed(R), np.tile(np.eye(3), (50, 1, 1)), atol=1e-13)


# --- A law with a state -------------------------------------------------------------------------------------


class Hardening(ElastoviscoplasticLawWithState):
    """tau = tau0 + H ε + mu γ̇ with the plastic strain ε, dε/dt = γ̇: linear hardening, a Bingham fluid."""

    name = "hardening"
    citation = "none"
    api_version = 2
    state = {"strain": StateVariable("1", "plastic shear strain ε", initial="initial_strain")}
    initial_strain: float = 0.0
    shear_modulus: float = 1e5

    def flow_curve_at(self, shear_rate, state):
        return 20.0 + 100.0 * state["strain"] + 5.0 * shear_rate

    def update_state(self, state, shear_rate, dt):
        state["strain"] += shear_rate * dt


def shear(law, rates, time, steps=2000):
    specimens = Specimens(law, len(rates))
    L = simple_shear(np.asarray(rates))
    stress = specimens.drive(L, time, steps)[:, 0, 2]
    return stress, specimens


def test_hardening_in_simple_shear():
    """tau = tau0 + H ε + mu γ̇, and what is not plastic strain is elastic, ε + tau/G = γ."""
    rates = np.array([0.5, 1.0])
    stress, specimens = shear(Hardening(), rates, 0.5)
    ε = specimens.state["strain"]
    np.testing.assert_allclose(stress, 20.0 + 100.0 * ε + 5.0 * rates, rtol=1e-3)
    np.testing.assert_allclose(ε + stress / 1e5, 0.5 * rates, rtol=1e-3)


def test_below_the_yield_stress_the_state_does_not_flow():
    """It yields at tau0 + H ε0, of the strain that a case may begin with: 70 Pa here, not 20."""
    law = Hardening(initial_strain=0.5)
    stress, specimens = shear(law, [1.0], 6e-4, 10)
    assert stress[0] == pytest.approx(60.0, rel=1e-6)
    assert specimens.state["strain"][0] == 0.5
    np.testing.assert_allclose(law.flow_curve(np.array([1e-12, 2.0])), [70.0, 80.0])


def test_each_particle_flows_in_its_own_state():
    """Of two particles at one rate, the one that yields has the flow curve of its own state."""
    specimens = Specimens(Hardening(), 3)
    specimens.state["strain"][:] = [10.0, 0.0, 0.3]
    stress = specimens.drive(simple_shear(np.ones(3)), 1e-2, 100)[:, 0, 2]
    ε = specimens.state["strain"]
    assert ε[0] == 10.0
    assert stress[0] == pytest.approx(1e3, rel=1e-3)
    np.testing.assert_allclose(stress[1:], 20.0 + 100.0 * ε[1:] + 5.0, rtol=1e-3)
