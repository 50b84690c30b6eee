"""The short contract of a material with an exact yield stress: its flow curve."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping

import numpy as np

from . import maxwell
from .base import quantity
from .law import ConstitutiveLaw, Kinematics
from .scale import REST_SHEAR_RATE, Scale


class ElastoviscoplasticLaw(ConstitutiveLaw):
    """Elastic up to the yield stress, and a fluid with the flow curve tau = f(γ̇) beyond it.

    No regularisation: below the yield stress nothing flows, and the material comes to rest. An elastic spring
    acts in series with the flow, see ``contracts.maxwell``. It does not change steady flow. The material
    yields at a strain of tau0/G.
    """

    shear_modulus: float | None = quantity(
        "Pa",
        "elastic shear modulus G below yield; default: the largest of 0.05 ρ c², tau0/0.003, and 100 times "
        "the viscous stress that the scene can drive",
        gt=0,
        default=None,
    )

    @abstractmethod
    def flow_curve(self, shear_rate: np.ndarray) -> np.ndarray:
        """Shear stress, Pa, of steady shear at rates ``(n,)``, 1/s, above 0; it must rise; tau0 at rest."""

    def relaxed_stress(self, trial: np.ndarray, stiffness: float) -> np.ndarray:
        """tau, ``(n,)``, Pa, of f(γ̇) + stiffness γ̇ = trial, or ``trial`` where that is below yield.

        For any flow curve; a law may have a faster solution of its own.
        """
        return maxwell.solve(self.flow_curve, trial, stiffness, REST_SHEAR_RATE)

    def update_stress(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], dt: float, stress: np.ndarray
    ) -> None:
        modulus = self._modulus(kinematics.density, kinematics.sound_speed)
        maxwell.relax(kinematics, modulus, dt, stress, self.relaxed_stress)

    def in_scene(self, density: float, sound_speed: float | None, scale: Scale) -> ConstitutiveLaw:
        """The law with its G, which is constant during the run, also if the sound speed follows the flow."""
        _, flow_stress = scale.flow(self._viscous_stress, density)
        modulus = maxwell.shear_modulus(
            self.shear_modulus, density, sound_speed, self._yield_stress, flow_stress
        )
        return self.model_copy(update={"shear_modulus": modulus})

    def wave_speed(self, density: float, sound_speed: float | None) -> float:
        speed = super().wave_speed(density, sound_speed)
        return maxwell.wave_speed(self._modulus(density, speed), density, speed)

    def remarks(self, density: float, sound_speed: float | None) -> list[str]:
        modulus = self._modulus(density, sound_speed)
        strain = f"{100 * self._yield_stress / modulus:.3g} %"
        cost = maxwell.cost(self, density, sound_speed)
        return [
            f"law '{self.name}' is elastic up to a strain of tau0/G = {strain}, G = {modulus:.4g} Pa{cost}"
        ]

    def warnings(self, density: float, sound_speed: float | None, scale: Scale, until: float) -> list[str]:
        modulus = self._modulus(density, sound_speed)
        found = maxwell.warnings_of_delay(
            self, modulus, density, sound_speed, scale, self._viscous_stress, until
        )
        strain = self._yield_stress / modulus
        if strain > maxwell.SOFT:
            found.append(
                f"law '{self.name}' is elastic up to a strain of tau0/G = {100 * strain:.3g} %: it vibrates "
                f"elastically before it flows; shear_modulus must be at least "
                f"{self._yield_stress / maxwell.SOFT:.3g} Pa, or be left out"
            )
        return found

    def yield_point(self, state: Mapping[str, np.ndarray]) -> np.ndarray | float:
        return self._yield_stress

    def strain_energy(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], stress: np.ndarray
    ) -> np.ndarray:
        modulus = self._modulus(kinematics.density, kinematics.sound_speed)
        return maxwell.strain_energy(modulus, kinematics, stress)

    def _modulus(self, density: float, sound_speed: float | None) -> float:
        if self.shear_modulus is not None:
            return self.shear_modulus
        return maxwell.shear_modulus(None, density, sound_speed, self._yield_stress)

    @property
    def _yield_stress(self) -> float:
        return float(np.ravel(self.flow_curve(np.array([REST_SHEAR_RATE])))[0])

    def _viscous_stress(self, shear_rate: np.ndarray) -> np.ndarray:
        return self.flow_curve(shear_rate) - self._yield_stress
