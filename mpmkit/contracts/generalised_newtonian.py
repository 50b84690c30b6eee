"""The short contract of a viscous fluid: its apparent viscosity."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Literal

import numpy as np
from pydantic import Field, PrivateAttr

from ..kernels.tensors import shear_rate, viscous_stress
from . import maxwell
from .base import one_each
from .law import ConstitutiveLaw, Kinematics
from .scale import REST_SHEAR_RATE, Scale


class GeneralisedNewtonianLaw(ConstitutiveLaw):
    """A fluid given by its apparent viscosity alone: sigma = -p I + 2 mu(γ̇) (D - tr(D)/3 I).

    This is eq. 6 of Ferreira et al., which is printed without the tensor I after tr(D), and
    γ̇ = √(2 D':D') with the deviatoric rate of deformation D'.

    In the ``relaxed`` form an elastic spring acts in series (``contracts.maxwell``). The acoustic step is
    then stable for any viscosity, and steady flow is the same. But the stress follows a change with a delay
    of mu/G. A regularised fluid below its yield stress, where mu is about tau0 m, is elastic for tau0 m/G
    seconds before it creeps.
    """

    form: Literal["explicit", "relaxed"] = Field(
        default="explicit",
        description="explicit: the viscous stress of the present rate, which limits the step; relaxed: "
        "through an elastic spring, without that limit; its modulus is the larger of 0.05 ρ c² and 100 times "
        "the stress that the scene can drive",
    )
    _shear_modulus: float | None = PrivateAttr(default=None)
    """G of the relaxed form, Pa, once the law is in a scene."""

    @abstractmethod
    def apparent_viscosity(self, shear_rate: np.ndarray) -> np.ndarray:
        """Viscosity, Pa s, at shear rates ``(n,)``, 1/s, all of them at least ``REST_SHEAR_RATE``."""

    def viscosity_at(self, shear_rate: float) -> float:
        """Viscosity, Pa s, at one shear rate, 1/s, of at least ``REST_SHEAR_RATE``."""
        return float(np.ravel(self.apparent_viscosity(np.array([shear_rate])))[0])

    def update_stress(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], dt: float, stress: np.ndarray
    ) -> None:
        if self.form == "relaxed":
            modulus = self._modulus(kinematics.density, kinematics.sound_speed)
            maxwell.relax(kinematics, modulus, dt, stress, self._relaxed)
            return
        rate = shear_rate(kinematics.velocity_gradient, REST_SHEAR_RATE)
        viscosity = one_each(self.apparent_viscosity(rate), rate, "apparent_viscosity")
        viscous_stress(kinematics.velocity_gradient, viscosity, stress)

    def largest_viscosity(self, largest_shear_rate: float) -> float:
        if self.form == "relaxed":
            return 0.0
        rates = np.geomspace(REST_SHEAR_RATE, max(largest_shear_rate, 1.0), 400)
        rates = np.append(rates[rates < largest_shear_rate], max(largest_shear_rate, REST_SHEAR_RATE))
        return float(np.max(self.apparent_viscosity(rates)))

    def wave_speed(self, density: float, sound_speed: float | None) -> float:
        speed = super().wave_speed(density, sound_speed)
        if self.form == "explicit":
            return speed
        return maxwell.wave_speed(self._modulus(density, speed), density, speed)

    def in_scene(self, density: float, sound_speed: float | None, scale: Scale) -> ConstitutiveLaw:
        """In the relaxed form, the law with its G, which is constant during the run."""
        if self.form == "explicit":
            return self
        _, flow_stress = scale.flow(self._shear_stress, density)
        law = self.model_copy()
        law._shear_modulus = maxwell.shear_modulus(None, density, sound_speed, flow_stress=flow_stress)
        return law

    def remarks(self, density: float, sound_speed: float | None) -> list[str]:
        if self.form == "explicit":
            return []
        modulus = self._modulus(density, sound_speed)
        at_rest = self.viscosity_at(REST_SHEAR_RATE)
        return [
            f"law '{self.name}', relaxed, follows a change of stress with a delay of mu/G, at rest "
            f"{at_rest / modulus:.3g} s, G = {modulus:.4g} Pa{maxwell.cost(self, density, sound_speed)}"
        ]

    def warnings(self, density: float, sound_speed: float | None, scale: Scale, until: float) -> list[str]:
        modulus = None if self.form == "explicit" else self._modulus(density, sound_speed)
        return maxwell.warnings_of_delay(
            self, modulus, density, sound_speed, scale, self._shear_stress, until
        )

    def strain_energy(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], stress: np.ndarray
    ) -> np.ndarray | float:
        if self.form == "explicit":
            return 0.0
        modulus = self._modulus(kinematics.density, kinematics.sound_speed)
        return maxwell.strain_energy(modulus, kinematics, stress)

    def _modulus(self, density: float, sound_speed: float | None) -> float:
        return maxwell.shear_modulus(self._shear_modulus, density, sound_speed)

    def _shear_stress(self, shear_rate: np.ndarray) -> np.ndarray:
        return self.apparent_viscosity(shear_rate) * shear_rate

    def _relaxed(self, trial: np.ndarray, stiffness: float) -> np.ndarray:
        return maxwell.solve(self._shear_stress, trial, stiffness, REST_SHEAR_RATE)
