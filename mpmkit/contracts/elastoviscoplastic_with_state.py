"""The short contract of a material with an exact yield stress and a state: two equations."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping

import numpy as np

from . import maxwell
from .base import one_each
from .elastoviscoplastic import ElastoviscoplasticLaw
from .law import Kinematics, initial_state
from .scale import REST_SHEAR_RATE

State = Mapping[str, np.ndarray]
"""The state variables of some particles by name, each ``(n, *shape)``."""


class ElastoviscoplasticLawWithState(ElastoviscoplasticLaw):
    """As ``ElastoviscoplasticLaw``, tau = f(γ̇, λ), with a state λ that the flow changes: dλ/dt = g(λ, γ̇).

    For a thixotropic, an ageing or a hardening material. In a step of Δt, the stress is found with the state
    at the beginning of the step,

        f(γ̇, λ) + G Δt γ̇ = τ*,

    and the plastic shear rate γ̇ (zero below the yield stress) then gives the state at the end of the step.
    """

    @abstractmethod
    def flow_curve_at(self, shear_rate: np.ndarray, state: State) -> np.ndarray:
        """Shear stress, Pa, of steady shear at rates ``(n,)``, 1/s, above zero, of particles in these states.

        Rising with the rate; at rest it is the yield stress.
        """

    @abstractmethod
    def update_state(self, state: State, shear_rate: np.ndarray, dt: float) -> None:
        """Write the state at the end of a step of ``dt``, s, into its arrays; shear rates ``(n,)``, 1/s."""

    def relaxed_stress_at(self, trial: np.ndarray, stiffness: float, state: State) -> np.ndarray:
        """tau, ``(n,)``, Pa, of f(γ̇, λ) + stiffness γ̇ = trial, or ``trial`` where that is below yield.

        For any flow curve; a law may have a faster solution of its own. ``stiffness`` is G Δt, Pa s.
        """
        return maxwell.solve(self.flow_curve_at, trial, stiffness, REST_SHEAR_RATE, state)

    def flow_curve(self, shear_rate: np.ndarray) -> np.ndarray:
        """The flow curve of the material as it is at the start."""
        return self.flow_curve_at(shear_rate, initial_state(self, len(shear_rate)))

    def yield_point(self, state: State) -> np.ndarray:
        count = len(next(iter(state.values())))
        return self.flow_curve_at(np.full(count, REST_SHEAR_RATE), state)

    def update_stress(self, kinematics: Kinematics, state: State, dt: float, stress: np.ndarray) -> None:
        def flow(trial: np.ndarray, stiffness: float) -> np.ndarray:
            tau = one_each(self.relaxed_stress_at(trial, stiffness, state), trial, "relaxed_stress_at")
            self.update_state(state, (trial - tau) / stiffness, dt)
            return tau

        modulus = self._modulus(kinematics.density, kinematics.sound_speed)
        maxwell.relax(kinematics, modulus, dt, stress, flow)
