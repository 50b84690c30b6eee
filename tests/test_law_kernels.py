"""Kernels that laws are made of, against plain NumPy written as the equations are."""

from __future__ import annotations

import numpy as np
import pytest
from tensors import random_gradients, symmetric

from mpmkit.contracts import Kinematics
from mpmkit.kernels import elastic
from mpmkit.kernels.compile import CHUNK
from mpmkit.registry import installed

pytestmark = pytest.mark.usefixtures("each_number_of_threads")
N = CHUNK + 19
LAWS = installed().of_kind("law")


def test_elastic_trial():
    """R s Rᵀ + 2 G Δt D′, R = (I - Δt W/2)⁻¹ (I + Δt W/2), a particle at a time; and √(s:s/2)."""
    rng = np.random.default_rng(20)
    L, stress, shear = random_gradients(rng, N), rng.normal(size=(N, 6)), np.empty(N)
    dt, G = 0.3, 2.0
    expected = []
    for l, s in zip(L, symmetric(stress), strict=True):
        D, W = (l + l.T) / 2, (l - l.T) / 2
        R = np.linalg.solve(np.eye(3) - dt * W / 2, np.eye(3) + dt * W / 2)
        expected.append(R @ s @ R.T + 2 * G * dt * (D - np.trace(D) / 3 * np.eye(3)))
    elastic.elastic_trial(L, dt, G, stress, shear)
    np.testing.assert_allclose(symmetric(stress), expected, rtol=0, atol=1e-13)
    norms = [np.sqrt(np.sum(s * s) / 2) for s in expected]
    np.testing.assert_allclose(shear, norms, rtol=1e-13)


def test_shrink():
    """s τ/τ*, and nothing where there is no stress to shrink."""
    rng = np.random.default_rng(21)
    stress, shear, allowed = rng.normal(size=(N, 6)), rng.uniform(1, 2, N), rng.uniform(0, 1, N)
    shear[::7] = 0.0
    expected = np.where(
        shear[:, None] > 0, stress * allowed[:, None] / np.where(shear > 0, shear, 1.0)[:, None], stress
    )
    elastic.shrink(stress, shear, allowed)
    np.testing.assert_allclose(stress, expected, rtol=1e-14)


@pytest.mark.parametrize("n", [0.5, 1.0, 1.33])
def test_viscosity_of_regularised_laws(n):
    """tau0 (1 - exp(-m γ̇)) / γ̇ + k γ̇^(n-1), the power law kept below γ̇ = 1/m where n < 1."""
    rate = np.geomspace(1e-12, 1e4, N)
    m, tau0, k = 100.0, 50.0, 3.0
    law = LAWS["herschel-bulkley"](yield_stress=tau0, consistency=k, flow_index=n, regularisation=m)
    power = k * (np.maximum(rate, 1 / m) if n < 1 else rate) ** (n - 1)
    np.testing.assert_allclose(
        law.apparent_viscosity(rate), tau0 * -np.expm1(-m * rate) / rate + power, rtol=1e-13
    )
    bingham = LAWS["bingham"](yield_stress=tau0, plastic_viscosity=k, regularisation=m)
    np.testing.assert_allclose(
        bingham.apparent_viscosity(rate), tau0 * -np.expm1(-m * rate) / rate + k, rtol=1e-13
    )


@pytest.mark.parametrize("n", [0.3, 1.0, 1.33])
def test_return_mapping_solves_its_equation(n):
    """τ = τ0 + k γ̇^n with γ̇ = (τ* - τ) / (G Δt), and τ* below yield."""
    trial, stiffness = np.geomspace(1, 1e5, N), 0.02
    law = LAWS["herschel-bulkley-evp"](yield_stress=50.0, consistency=3.0, flow_index=n)
    stress = law.relaxed_stress(trial, stiffness)
    flows = trial > 50.0
    np.testing.assert_array_equal(stress[~flows], trial[~flows])
    rate = (trial - stress)[flows] / stiffness
    resolved = (
        rate * stiffness > 1e-6 * trial[flows]
    )  # the difference of two numbers that are nearly equal is rounding
    assert resolved.sum() > N / 3
    np.testing.assert_allclose(stress[flows][resolved], (50.0 + 3.0 * rate**n)[resolved], rtol=1e-8)


def test_cauchy_stress_of_neo_hooke():
    """(G (F Fᵀ - I) + λ ln J I) / J."""
    F = np.eye(3) + 0.2 * random_gradients(np.random.default_rng(22), N)
    F = F[np.linalg.det(F) > 0.1]
    J, E, nu = np.linalg.det(F), 100.0, 0.3
    G, lame = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    kinematics = Kinematics(np.zeros_like(F), J, np.zeros_like(J), 1.0, deformation_gradient=F)
    stress = np.full((len(F), 6), np.nan)
    LAWS["neo-hookean"](youngs_modulus=E, poisson_ratio=nu).update_stress(kinematics, {}, 0.1, stress)
    identity = np.eye(3)
    expected = [
        (G * (f @ f.T - identity) + lame * np.log(j) * identity) / j for f, j in zip(F, J, strict=True)
    ]
    np.testing.assert_allclose(symmetric(stress), expected, rtol=1e-12, atol=1e-10)


def test_linear_equation_of_state():
    """ρ0 c² (1/J - 1), and its energy is minus the integral of p over J from 1."""
    J = np.linspace(0.5, 2, N)
    eos = installed().of_kind("equation_of_state")["linear"]()
    np.testing.assert_allclose(eos.pressure(J, 1000.0, 20.0), 1000 * 20**2 * (1 / J - 1), rtol=1e-13)
    slope = np.gradient(eos.energy(J, 1000.0, 20.0), J)
    # A central difference of a 270th is off by a 10,000th.
    np.testing.assert_allclose(-slope[1:-1], eos.pressure(J, 1000.0, 20.0)[1:-1], rtol=1e-4, atol=5.0)
