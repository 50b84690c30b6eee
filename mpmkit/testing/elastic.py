"""What a law must be whose whole stress is a function of F: hyperelastic."""

from __future__ import annotations

import numpy as np

from ..contracts import Kinematics
from ..contracts.tensors import from_voigt
from .law_subject import LawSubject
from .specimens import plane, random_rotations
from .violation import require_close


def deformations(n: int, size: float, seed: int = 3) -> np.ndarray:
    """F with components within ``size`` of the identity's."""
    return np.eye(3) + size * np.random.default_rng(seed).uniform(-1, 1, (n, 3, 3))


def kinematics(subject: LawSubject, F: np.ndarray) -> Kinematics:
    """At rest in a deformed state."""
    F = np.ascontiguousarray(F)
    return Kinematics(np.zeros_like(F), np.linalg.det(F), np.zeros(len(F)), subject.density, F)


def energy(subject: LawSubject, F: np.ndarray) -> np.ndarray:
    """W, J/m³ of initial volume."""
    return np.broadcast_to(
        subject.law.strain_energy(kinematics(subject, F), {}, np.full((len(F), 6), np.nan)), len(F)
    )


def stress(subject: LawSubject, F: np.ndarray) -> np.ndarray:
    """sigma, Pa, ``(n, 3, 3)``."""
    voigt = np.full((len(F), 6), np.nan)
    subject.law.update_stress(kinematics(subject, F), {}, 1e-3, voigt)
    return from_voigt(voigt)


def energy_gives_the_stress(subject: LawSubject) -> None:
    """sigma = 1/J dW/dF Fᵀ, by central differences."""
    F, h = deformations(50, 0.25), 1e-5
    P = np.empty_like(F)
    for i in range(3):
        for j in range(3):
            step = np.zeros((3, 3))
            step[i, j] = h
            P[:, i, j] = (energy(subject, F + step) - energy(subject, F - step)) / (2 * h)
    sigma = P @ F.transpose(0, 2, 1) / np.linalg.det(F)[:, None, None]
    scale = np.abs(sigma).max(axis=(1, 2), keepdims=True)
    require_close(
        stress(subject, F), sigma, 1e-6 * scale, lambda p, i, j: f"{plane(i, j)} against 1/J dW/dF Fᵀ", "Pa"
    )


def turned_bodies_hold_no_stress(subject: LawSubject) -> None:
    """F = R: neither stress nor energy."""
    R, scale = random_rotations(50), subject.scale()
    require_close(
        stress(subject, R), 0.0, 1e-9 * scale, lambda p, i, j: f"{plane(i, j)} of a body only turned", "Pa"
    )
    require_close(
        energy(subject, R), 0.0, 1e-9 * scale, lambda p: "the strain energy of a body only turned", "J/m³"
    )


def frame_indifference(subject: LawSubject) -> None:
    """R F gives R sigma Rᵀ and the same energy."""
    F, R = deformations(100, 0.25), random_rotations(100)
    expected = R @ stress(subject, F) @ R.transpose(0, 2, 1)
    scale = np.abs(expected).max(axis=(1, 2), keepdims=True)
    require_close(
        stress(subject, R @ F),
        expected,
        1e-9 * scale,
        lambda p, i, j: f"{plane(i, j)} of a deformed body that is turned",
        "Pa",
    )
    W = energy(subject, F)
    require_close(
        energy(subject, R @ F), W, 1e-9 * np.abs(W), lambda p: "the strain energy of a turned body", "J/m³"
    )
