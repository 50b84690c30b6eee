"""The short contract of a material with an exact yield stress: its flow curve."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping

import numpy as np

from . import maxwell
from .base import quantity
from .generalised_newtonian import REST_SHEAR_RATE
from .law import ConstitutiveLaw, Kinematics


class ElastoviscoplasticLaw(ConstitutiveLaw):
    """Elastic up to the yield stress, and a fluid with the flow curve tau = f(γ̇) beyond it.

    No regularisation: below the yield stress nothing flows, and the material comes to rest. In series with
    the flow is an elastic spring, see ``contracts.maxwell``; it leaves steady flow as it is, and its strain,
    tau0/G, is what the material yields by before it flows.
    """

    shear_modulus: float | None = quantity(
        "Pa",
        "elastic shear modulus G below yield; unless told 0.05 ρ c², which hardly shortens the step",
        gt=0,
        default=None,
    )

    @abstractmethod
    def flow_curve(self, shear_rate: np.ndarray) -> np.ndarray:
        """Shear stress, Pa, of steady shear at rates ``(n,)``, 1/s, above zero; rising, tau0 at rest."""

    def relaxed_stress(self, trial: np.ndarray, stiffness: float) -> np.ndarray:
        """tau, ``(n,)``, Pa, of f(γ̇) + stiffness γ̇ = trial, or ``trial`` where that is below yield.

        For any flow curve; a law may have a faster solution of its own.
        """
        return maxwell.solve(self.flow_curve, trial, stiffness, REST_SHEAR_RATE)

    def update_stress(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], dt: float, stress: np.ndarray
    ) -> None:
        maxwell.relax(kinematics, self._modulus(kinematics), dt, stress, self.relaxed_stress)

    def wave_speed(self, density: float, sound_speed: float | None) -> float:
        speed = super().wave_speed(density, sound_speed)
        return maxwell.wave_speed(maxwell.shear_modulus(self.shear_modulus, density, speed), density, speed)

    def remarks(self, density: float, sound_speed: float | None) -> list[str]:
        modulus = maxwell.shear_modulus(self.shear_modulus, density, sound_speed)
        strain = self._yield_stress() / modulus
        percent = f"{100 * strain:.3g} %"
        return [f"law '{self.name}' is elastic up to a strain of tau0/G = {percent}, G = {modulus:.4g} Pa"]

    def yield_point(self, state: Mapping[str, np.ndarray]) -> np.ndarray | float:
        return self._yield_stress()

    def _yield_stress(self) -> float:
        """f at rest, Pa."""
        return float(np.ravel(self.flow_curve(np.array([REST_SHEAR_RATE])))[0])

    def strain_energy(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], stress: np.ndarray
    ) -> np.ndarray:
        return maxwell.strain_energy(self._modulus(kinematics), kinematics, stress)

    def _modulus(self, kinematics: Kinematics) -> float:
        return maxwell.shear_modulus(self.shear_modulus, kinematics.density, kinematics.sound_speed)
