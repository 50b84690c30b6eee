"""Kernels on particles alone: rates, volumes, deformation, domains, against plain NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from tensors import random_gradients, symmetric

from mpmkit.kernels import domains, tensors, volumes
from mpmkit.kernels.compile import CHUNK

pytestmark = pytest.mark.usefixtures("each_number_of_threads")
RELATIVE = 1e-13


def deviatoric_rate(L):
    D = (L + L.transpose(0, 2, 1)) / 2
    return D - np.trace(D, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)


def test_shear_rate():
    rng = np.random.default_rng(9)
    L = random_gradients(rng, 3 * CHUNK + 5)
    L[:7] = 0.0
    deviator = deviatoric_rate(L)
    expected = np.sqrt(2 * np.einsum("pij,pij->p", deviator, deviator))
    np.testing.assert_allclose(tensors.shear_rate(L), expected, rtol=RELATIVE)
    floored = tensors.shear_rate(L, 2.0)
    np.testing.assert_allclose(floored, np.maximum(expected, 2.0), rtol=RELATIVE)


def test_shear_rate_of_simple_shear_is_the_shear():
    L = np.zeros((1, 3, 3))
    L[0, 0, 2] = 5.0
    assert tensors.shear_rate(L)[0] == pytest.approx(5.0, rel=1e-15)


def test_viscous_stress():
    rng = np.random.default_rng(10)
    L, mu = random_gradients(rng, CHUNK + 17), rng.uniform(0, 3, CHUNK + 17)
    found = np.empty((len(L), 6))
    tensors.viscous_stress(L, mu, found)
    np.testing.assert_allclose(
        symmetric(found), 2 * mu[:, None, None] * deviatoric_rate(L), rtol=0, atol=1e-13
    )


def test_volumes_follow_the_rate():
    """J (1 + Δt tr L) and V = V0 J."""
    rng = np.random.default_rng(11)
    n, dt = CHUNK + 3, 0.01
    rate, J, initial = rng.normal(size=n), rng.uniform(0.5, 1.5, n), rng.uniform(1, 2, n)
    volume, start = np.full(n, np.nan), J.copy()
    volumes.stretch(rate, dt, initial, J, volume)
    np.testing.assert_allclose(J, start * (1 + dt * rate), rtol=RELATIVE)
    np.testing.assert_allclose(volume, initial * start * (1 + dt * rate), rtol=RELATIVE)


@pytest.mark.parametrize("part", [0.0, 0.25, 1.0])
def test_volume_ratios_are_drawn_to_their_mean(part):
    rng = np.random.default_rng(18)
    J, mean = rng.uniform(0.5, 1.5, (2, CHUNK + 3))
    expected = (1 - part) * J + part * mean
    volumes.draw(J, mean, part)
    np.testing.assert_allclose(J, expected, rtol=RELATIVE)


def test_deformation_and_determinant():
    rng = np.random.default_rng(12)
    n, dt = 2 * CHUNK + 1, 0.02
    L, F = random_gradients(rng, n), np.eye(3) + random_gradients(rng, n, 0.1)
    expected = (np.eye(3) + dt * L) @ F
    tensors.deform(L, dt, F)
    np.testing.assert_allclose(F, expected, rtol=0, atol=1e-14)
    found = np.empty(n)
    tensors.determinant(F, found)
    np.testing.assert_allclose(found, np.linalg.det(F), rtol=1e-12, atol=1e-13)


# --- Particle domains ---------------------------------------------------------------------------------------


def right_stretch(F):
    """U = √(FᵀF) through the eigenvectors of FᵀF."""
    values, vectors = np.linalg.eigh(F.transpose(0, 2, 1) @ F)
    return np.einsum("pik,pk,pjk->pij", vectors, np.sqrt(values), vectors)


def rotations(rng, n):
    q, r = np.linalg.qr(rng.normal(size=(n, 3, 3)))
    q = q * np.sign(np.einsum("pii->pi", r))[:, None, :]
    q[:, :, 0] *= np.linalg.det(q)[:, None]
    return q


def deformations(kind, rng, n):
    if kind == "moderate":
        return np.eye(3) + random_gradients(rng, n, 0.15)
    if kind == "tiny":
        return np.eye(3) + random_gradients(rng, n, 1e-9)
    if kind == "rotation":
        return rotations(rng, n)
    if kind == "two equal stretches":
        return rotations(rng, n) @ np.diag([2.0, 2.0, 0.5]) @ rotations(rng, n)
    if kind == "uniform":
        return rotations(rng, n) * 0.8
    if kind == "strong":  # a spread sheet: a hundredfold between the stretches
        Q = rotations(rng, n)
        return rotations(rng, n) @ Q @ np.diag([5.0, 4.0, 0.05]) @ Q.transpose(0, 2, 1)
    raise ValueError(kind)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(
    ("kind", "tolerance"),
    [
        ("moderate", 1e-10),
        ("tiny", 1e-12),
        ("rotation", 1e-12),
        ("two equal stretches", 1e-7),
        ("uniform", 1e-12),
        ("strong", 1e-8),
    ],
)
def test_domains_follow_the_right_stretch(dim, kind, tolerance):
    rng = np.random.default_rng(13)
    n = CHUNK + 40
    F = deformations(kind, rng, n)
    initial = rng.uniform(0.5, 1.0, (n, dim))
    found = np.empty((n, dim))
    domains.follow_stretch(F, initial, found)
    U = right_stretch(F)
    expected = initial * np.einsum("pii->pi", U)[:, :dim]
    np.testing.assert_allclose(found, expected, rtol=tolerance)


@pytest.mark.parametrize("dim", [2, 3])
def test_domains_follow_the_volume(dim):
    rng = np.random.default_rng(14)
    J, initial = rng.uniform(0.2, 3.0, CHUNK + 2), rng.uniform(0.5, 1.0, (CHUNK + 2, dim))
    found = np.empty_like(initial)
    domains.follow_volume(J, initial, found)
    np.testing.assert_allclose(found, initial * J[:, None] ** (1 / dim), rtol=RELATIVE)


@pytest.mark.parametrize("follows", [True, False])
def test_domains_follow_the_normal_strain(follows):
    """l exp(∫ D_ii dt) for a steady stretch; nothing for a spin or a simple shear."""
    L = np.zeros((3, 3, 3))
    L[0] = np.diag([0.5, -0.2, -0.3])
    L[1, 0, 1], L[1, 1, 0] = 0.7, -0.7
    L[2, 0, 2] = 4.0
    box, half_size, least = np.ones((3, 3)), np.full((3, 3), 7.0), np.full((3, 3), 0.8)
    for _ in range(100):
        domains.follow_strain(L, 1e-2, box, least if follows else least[:0], half_size)
    np.testing.assert_allclose(box[0], np.exp([0.5, -0.2, -0.3]), rtol=2e-3)
    assert (box[1:] == 1).all()
    # The shape function sees the boxes, none below the least; or something else altogether.
    np.testing.assert_array_equal(half_size, np.maximum(box, least) if follows else 7.0)


@pytest.mark.parametrize("dim", [2, 3])
def test_every_domain_follows_its_own_strain(dim):
    rng = np.random.default_rng(19)
    n, dt = 2 * CHUNK + 7, 0.02
    L, box, least = random_gradients(rng, n), rng.uniform(0.5, 1, (n, dim)), rng.uniform(0.5, 1, (n, dim))
    half_size, expected = np.empty((n, dim)), box * (1 + dt * np.einsum("pii->pi", L)[:, :dim])
    domains.follow_strain(L, dt, box, least, half_size)
    np.testing.assert_allclose(box, expected, rtol=RELATIVE)
    np.testing.assert_array_equal(half_size, np.maximum(box, least))


# --- Where particles are ------------------------------------------------------------------------------------
