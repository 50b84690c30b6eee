"""Roussel's thixotropic concrete as a plug-in of mpmkit: a whole law, with a state, in plain NumPy."""

import math
from collections.abc import Mapping

import numpy as np

from mpmkit.contracts import ConstitutiveLaw, Kinematics, StateVariable, hookimpl, quantity

STIFFNESS = 0.05
"""Least G over ρ c²: raises the wave speed, and with it the number of steps, by 3 %."""
YIELD_STRAIN = 0.003
"""Largest tau0 / G."""


class Thixotropic(ConstitutiveLaw):
    """tau = (1 + λ) tau0 + mu_p γ̇ beyond the yield stress,  dλ/dt = 1/T - α λ γ̇.

    At rest the yield stress grows by A_thix = tau0 / T. Elastic below it, G = max(0.05 ρ c², tau0/0.003): s
    is turned with the material (Jaumann), strained, and drawn back to the flow curve, backward Euler in τ, λ:

        τ + G Δt γ̇ = τ*,    λ = (λ_old + Δt/T) / (1 + α γ̇ Δt).
    """

    name = "thixotropic"
    api_version = 1
    citation = "Roussel, Cem. Concr. Res. 36 (2006) 1797-1806"
    state = {"structure": StateVariable("1", "state of flocculation λ")}

    yield_stress: float = quantity("Pa", "yield stress tau0 without structure", ge=0)
    plastic_viscosity: float = quantity("Pa s", "plastic viscosity mu_p", ge=0)
    flocculation_time: float = quantity("s", "time T in which the yield stress grows by tau0 at rest", gt=0)
    breakdown: float = quantity("1", "α, the inverse of the strain that breaks the structure", ge=0)

    def update_stress(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], dt: float, stress: np.ndarray
    ) -> None:
        L, G = kinematics.velocity_gradient, self.shear_modulus(kinematics.density, kinematics.sound_speed)
        structure = state["structure"]
        s = turned(tensor(stress), L, dt) + 2 * G * dt * deviator(L)
        trial = np.sqrt(np.einsum("pij,pij->p", s, s) / 2)

        excess = np.maximum(trial - (1 + structure) * self.yield_stress, 0.0)
        rate = excess / (self.plastic_viscosity + G * dt)
        structure += dt / self.flocculation_time
        structure /= 1 + self.breakdown * rate * dt

        kept = 1 - G * dt * rate / np.maximum(trial, np.finfo(float).tiny)
        stress[:] = voigt(kept[:, None, None] * s)

    def shear_modulus(self, density: float, sound_speed: float | None) -> float:
        assert sound_speed is not None  # the law uses an equation of state
        return max(STIFFNESS * density * sound_speed**2, self.yield_stress / YIELD_STRAIN)

    def wave_speed(self, density: float, sound_speed: float | None) -> float:
        G, c = self.shear_modulus(density, sound_speed), super().wave_speed(density, sound_speed)
        return math.sqrt(c**2 + 4 * G / (3 * density))

    def strain_energy(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], stress: np.ndarray
    ) -> np.ndarray:
        s, G = tensor(stress), self.shear_modulus(kinematics.density, kinematics.sound_speed)
        return kinematics.volume_ratio * np.einsum("pij,pij->p", s, s) / (4 * G)


def tensor(voigt: np.ndarray) -> np.ndarray:
    """xx, yy, zz, yz, xz, xy to 3 × 3."""
    return voigt[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


def voigt(tensor: np.ndarray) -> np.ndarray:
    return tensor[:, [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]]


def deviator(L: np.ndarray) -> np.ndarray:
    """D - tr(D)/3 I."""
    D = (L + L.transpose(0, 2, 1)) / 2
    return D - np.trace(D, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)


def turned(s: np.ndarray, L: np.ndarray, dt: float) -> np.ndarray:
    """R s Rᵀ with the rotation R = (I - W Δt/2)⁻¹ (I + W Δt/2) of the spin W (Hughes & Winget 1980)."""
    half = dt / 4 * (L - L.transpose(0, 2, 1))
    R = np.linalg.solve(np.eye(3) - half, np.eye(3) + half)
    return R @ s @ R.transpose(0, 2, 1)


@hookimpl
def mpmkit_laws():
    return [Thixotropic]
