"""Particles in homogeneous motion: a law is driven through its contract alone, without any grid."""

from __future__ import annotations

import numpy as np

from ..contracts import ConstitutiveLaw, Kinematics
from ..contracts.law import initial_state
from ..contracts.tensors import from_voigt

DENSITY, SOUND_SPEED = 2574.0, 20.0
"""kg/m³ and m/s, of a slump of fresh concrete."""
AXES = "xyz"


class Specimens:
    """Particles of one law, each in a motion of its own, at zero pressure.

    Attributes:
        F: ``(n, 3, 3)`` deformation gradients.
        voigt: ``(n, 6)`` stress as the law wrote it, Pa.
        state: the law's state variables.
        work: ``(n,)`` ∫ J sigma:L dt, J/m³ of initial volume.
    """

    def __init__(
        self, law: ConstitutiveLaw, n: int, density: float = DENSITY, sound_speed: float = SOUND_SPEED
    ) -> None:
        self.law = law
        self.density = density
        self.sound_speed = sound_speed if law.uses_equation_of_state else None
        self.F = np.tile(np.eye(3), (n, 1, 1))
        self.voigt = np.zeros((n, 6))
        self.state = initial_state(law, n)
        self.work = np.zeros(n)

    def kinematics(self, L: np.ndarray) -> Kinematics:
        """The kinematics of a law for velocity gradients ``(n, 3, 3)``, 1/s."""
        F = self.F if self.law.needs_deformation_gradient else None
        J = np.linalg.det(self.F)
        return Kinematics(np.array(L, order="C"), J, np.zeros(len(L)), self.density, F, self.sound_speed)

    def drive(self, L: np.ndarray, duration: float, steps: int = 1) -> np.ndarray:
        """Move at velocity gradients L, 1/s, for so many seconds; the stress at the end, ``(n, 3, 3)``."""
        dt = duration / steps
        A = dt * L
        increment = np.eye(3) + A + A @ A / 2 + A @ A @ A / 6 + A @ A @ A @ A / 24  # exp(dt L)
        before = self.power(L)
        for _ in range(steps):
            self.F = increment @ self.F
            self.law.update_stress(self.kinematics(L), self.state, dt, self.voigt)
            now = self.power(L)
            self.work += dt * (before + now) / 2
            before = now
        return self.stress

    def rest(self, duration: float, steps: int = 1) -> np.ndarray:
        """Hold them still."""
        return self.drive(np.zeros_like(self.F), duration, steps)

    def take(self, index: np.ndarray) -> Specimens:
        """A copy of some of them, which remembers what the law has declared and nothing else."""
        copy = Specimens(self.law.model_copy(), len(index), self.density)
        copy.sound_speed = self.sound_speed
        copy.F, copy.voigt, copy.work = self.F[index], self.voigt[index], self.work[index]
        copy.state = {name: array[index] for name, array in self.state.items()}
        return copy

    def power(self, L: np.ndarray) -> np.ndarray:
        """Power of the stress per initial volume, J sigma:L, W/m³."""
        return np.linalg.det(self.F) * np.einsum("pij,pij->p", self.stress, L)

    def strain_energy(self) -> np.ndarray:
        """What the law says is stored, ``(n,)``, J/m³ of initial volume."""
        still = self.kinematics(np.zeros_like(self.F))
        return np.broadcast_to(self.law.strain_energy(still, self.state, self.voigt), len(self.F))

    @property
    def stress(self) -> np.ndarray:
        return from_voigt(self.voigt)


def random_gradients(n: int, seed: int = 0, isochoric: bool = False) -> np.ndarray:
    """Velocity gradients, 1/s, over four decades of magnitude."""
    rng = np.random.default_rng(seed)
    L = rng.standard_normal((n, 3, 3)) * 10 ** rng.uniform(-3, 1, (n, 1, 1))
    if isochoric:
        L -= np.einsum("pii->p", L)[:, None, None] / 3 * np.eye(3)
    return L


def random_rotations(n: int, seed: int = 1) -> np.ndarray:
    """Proper rotations, ``(n, 3, 3)``."""
    Q, upper = np.linalg.qr(np.random.default_rng(seed).standard_normal((n, 3, 3)))
    Q = Q * np.sign(np.einsum("pii->pi", upper))[:, None, :]
    Q[:, :, 0] *= np.linalg.det(Q)[:, None]
    return Q


def simple_shear(rates: np.ndarray, along: int = 0, across: int = 2) -> np.ndarray:
    """v along one axis that grows across another at these rates, 1/s; default: x over z."""
    L = np.zeros((len(rates), 3, 3))
    L[:, along, across] = rates
    return L


def plane(along: int, across: int) -> str:
    """Names a shear stress: ``"stress xz"``."""
    return f"stress {AXES[min(along, across)]}{AXES[max(along, across)]}"
