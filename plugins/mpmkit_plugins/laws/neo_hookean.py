"""Neo-Hooke's solid: the elastic law that verifies the method itself."""

from collections.abc import Mapping

import numpy as np
from numba import prange

from mpmkit.contracts import ConstitutiveLaw, Kinematics, hookimpl, quantity
from mpmkit.kernels.compile import CHUNK, chunk_count, kernel


class NeoHookean(ConstitutiveLaw):
    """sigma = (G (F Fᵀ - I) + lambda ln J I) / J, with Lamé's G and lambda of E and nu.

    Its energy per initial volume is G/2 (tr(FᵀF) - 3) - G ln J + lambda/2 (ln J)².
    """

    name = "neo-hookean"
    api_version = 2
    citation = "Wallstedt & Guilkey, J. Comput. Phys. 227 (2008) 9628-9642"
    uses_equation_of_state = False
    needs_deformation_gradient = True

    youngs_modulus: float = quantity("Pa", "Young's modulus E", gt=0)
    poisson_ratio: float = quantity("1", "Poisson's ratio nu", ge=0, lt=0.5)

    @property
    def shear_modulus(self) -> float:
        return self.youngs_modulus / (2 * (1 + self.poisson_ratio))

    @property
    def lame(self) -> float:
        nu = self.poisson_ratio
        return self.youngs_modulus * nu / ((1 + nu) * (1 - 2 * nu))

    def update_stress(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], dt: float, stress: np.ndarray
    ) -> None:
        _cauchy_stress(
            kinematics.deformation_gradient, kinematics.volume_ratio, self.shear_modulus, self.lame, stress
        )

    def wave_speed(self, density: float, sound_speed: float | None) -> float:
        return float(np.sqrt((self.lame + 2 * self.shear_modulus) / density))

    def present_wave_speed(self, kinematics: Kinematics, state: Mapping[str, np.ndarray]) -> float:
        """√((G (λ_b + 1) + λ (1 - ln J))/ρ0), the largest one.

        A plane wave along n sees ρ0 c² = G n·b n + G + λ (1 - ln J) with b = F Fᵀ; λ_b, the largest
        eigenvalue of b, is bound by the largest sum of absolute values in a row.
        """
        F = kinematics.deformation_gradient
        assert F is not None  # the law asks for it
        stiffest = _largest_wave_modulus(F, kinematics.volume_ratio, self.shear_modulus, self.lame)
        return float(np.sqrt(stiffest / kinematics.density))

    def strain_energy(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], stress: np.ndarray
    ) -> np.ndarray:
        F, log_J = kinematics.deformation_gradient, np.log(kinematics.volume_ratio)
        assert F is not None  # the law asks for it
        G, lame = self.shear_modulus, self.lame
        return G / 2 * (np.einsum("pij,pij->p", F, F) - 3) - G * log_J + lame / 2 * log_J**2


@kernel()
def _cauchy_stress(F, J, G, lame, stress):
    n = len(F)
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            a = G / J[p]
            isotropic = (lame * np.log(J[p]) - G) / J[p]
            for i in range(3):
                squared = F[p, i, 0] ** 2 + F[p, i, 1] ** 2 + F[p, i, 2] ** 2
                stress[p, i] = a * squared + isotropic
            for k, (i, j) in enumerate(((1, 2), (0, 2), (0, 1))):
                stress[p, 3 + k] = a * (
                    F[p, i, 0] * F[p, j, 0] + F[p, i, 1] * F[p, j, 1] + F[p, i, 2] * F[p, j, 2]
                )


@kernel()
def _largest_wave_modulus(F, J, G, lame):
    n = len(F)
    largest = np.zeros(chunk_count(n))
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            stretch = 0.0
            for i in range(3):
                row = 0.0
                for j in range(3):
                    row += abs(F[p, i, 0] * F[p, j, 0] + F[p, i, 1] * F[p, j, 1] + F[p, i, 2] * F[p, j, 2])
                stretch = max(stretch, row)
            largest[chunk] = max(largest[chunk], G * (stretch + 1.0) + lame * (1.0 - np.log(J[p])))
    return largest.max()


@hookimpl
def mpmkit_laws():
    return [NeoHookean]
