"""The short contract of a viscous fluid: its apparent viscosity."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Literal

import numpy as np
from pydantic import Field

from ..kernels.tensors import shear_rate, viscous_stress
from . import maxwell
from .base import one_each
from .law import ConstitutiveLaw, Kinematics

REST_SHEAR_RATE = 1e-12
"""Shear rate, 1/s, that stands for rest, so that a law written as in the paper divides by no zero."""


class GeneralisedNewtonianLaw(ConstitutiveLaw):
    """A fluid given by its apparent viscosity alone: sigma = -p I + 2 mu(γ̇) (D - tr(D)/3 I).

    This is eq. 6 of Ferreira et al. with the tensor that the printed equation lost, and
    γ̇ = √(2 D':D') with the deviatoric rate of deformation D'.

    In its ``relaxed`` form the stress follows this through an elastic spring (``contracts.maxwell``). It is
    then stable at the acoustic step however viscous the fluid, and the same in steady flow; but a change of
    stress where the viscosity is mu takes mu/G to come through, so that a regularised fluid below its yield
    stress, where mu is about tau0 m, is elastic for tau0 m/G seconds before it creeps.
    """

    form: Literal["explicit", "relaxed"] = Field(
        default="explicit",
        description="explicit: the viscous stress of the present rate, which limits the step; relaxed: "
        "through an elastic spring of modulus 0.05 ρ c², without that limit",
    )

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
            maxwell.relax(kinematics, self._modulus(kinematics), dt, stress, self._relaxed)
            return
        rate = shear_rate(kinematics.velocity_gradient, REST_SHEAR_RATE)
        viscosity = one_each(self.apparent_viscosity(rate), rate, "apparent_viscosity")
        viscous_stress(kinematics.velocity_gradient, viscosity, stress)

    def largest_viscosity(self, largest_shear_rate: float) -> float:
        if self.form == "relaxed":
            return 0.0
        rates = np.geomspace(REST_SHEAR_RATE, max(largest_shear_rate, 1.0), 400)
        return float(np.max(self.apparent_viscosity(rates)))

    def wave_speed(self, density: float, sound_speed: float | None) -> float:
        speed = super().wave_speed(density, sound_speed)
        if self.form == "explicit":
            return speed
        return maxwell.wave_speed(maxwell.shear_modulus(None, density, speed), density, speed)

    def remarks(self, density: float, sound_speed: float | None) -> list[str]:
        if self.form == "explicit":
            return []
        modulus = maxwell.shear_modulus(None, density, sound_speed)
        at_rest = self.viscosity_at(REST_SHEAR_RATE)
        return [
            f"law '{self.name}', relaxed, follows a change of stress within mu/G, at rest "
            f"{at_rest / modulus:.3g} s, G = {modulus:.4g} Pa"
        ]

    def strain_energy(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], stress: np.ndarray
    ) -> np.ndarray | float:
        if self.form == "explicit":
            return 0.0
        return maxwell.strain_energy(self._modulus(kinematics), kinematics, stress)

    def _modulus(self, kinematics: Kinematics) -> float:
        return maxwell.shear_modulus(None, kinematics.density, kinematics.sound_speed)

    def _relaxed(self, trial: np.ndarray, stiffness: float) -> np.ndarray:
        return maxwell.solve(
            lambda rate: self.apparent_viscosity(rate) * rate, trial, stiffness, REST_SHEAR_RATE
        )
