"""Laws with one fault each."""

import numpy as np
from sound_laws import Ageing, NeoHooke, Oil, Plastic, Sound, Spring, deviator, transposed, voigt

from mpmkit.contracts import ConstitutiveLaw, GeneralisedNewtonianLaw


class NormalComponentsOnly(Plastic):
    """Yield, and flow with it, on the normal components alone: two published codes have it so."""

    def update_stress(self, kinematics, state, dt, stress):
        super().update_stress(kinematics, state, dt, stress)
        stress[:, 3:] = 0.0


class TwiceTheStress(Oil):
    def stress_of(self, L):
        return 2 * super().stress_of(L)

    def largest_viscosity(self, largest_shear_rate):
        return 10.0


class TwiceTheFlow(Plastic):
    """A return mapping that is not that of its own flow curve."""

    def relaxed_stress(self, trial, stiffness):
        return np.minimum(trial, 20.0) + 10.0 / (10.0 + stiffness) * np.maximum(trial - 20.0, 0.0)


class WrongSign(Oil):
    def stress_of(self, L):
        return -super().stress_of(L)


class WrongSignOfOneShear(Oil):
    """A sign that shows in the shear stress of one plane only."""

    def stress_of(self, L):
        return super().stress_of(L) * np.array([1, 1, 1, 1, 1, -1])


class GradientNotTransposed(Oil):
    """2 mu L for mu (L + Lᵀ)."""

    def stress_of(self, L):
        return voigt(10.0 * deviator(L))


class ShearStressesInAnotherOrder(Oil):
    """xy, yz, xz for yz, xz, xy."""

    def stress_of(self, L):
        return super().stress_of(L)[:, [0, 1, 2, 5, 3, 4]]


class TurnNotTransposed(Spring):
    def turned(self, turn, s):
        return turn @ s @ turn


class TurnedBackwards(Spring):
    def turned(self, turn, s):
        return transposed(turn) @ s @ turn


class NotTurned(Spring):
    def turned(self, turn, s):
        return s


class WholeTensor(Spring):
    """Without the deviator it resists a change of volume, as the equation of state does already."""

    def update_stress(self, kinematics, state, dt, stress):
        L = kinematics.velocity_gradient
        stress[:] += voigt(self.modulus * dt * (L + transposed(L)))


class SlowWave(Spring):
    """Ten times as stiff as it says."""

    modulus: float = 1e7

    def wave_speed(self, density, sound_speed):
        return sound_speed


class ThinnerThanItIs(Oil):
    def largest_viscosity(self, largest_shear_rate):
        return 2.5


class EnergyOfNothing(Oil):
    """Energy that it does not have."""

    def strain_energy(self, kinematics, state, stress):
        return 1.0


class NothingAtRest(Oil):
    """0/0 where nothing moves."""

    def stress_of(self, L):
        D = deviator(L + transposed(L)) / 2
        rate = np.sqrt(2 * np.einsum("pij,pij->p", D, D))[:, None, None]
        with np.errstate(invalid="ignore"):
            return voigt(10.0 * rate * D / rate)


class Overflows(Oil):
    """Beyond any number at 1e6 /s."""

    def stress_of(self, L):
        with np.errstate(over="ignore", invalid="ignore"):
            return super().stress_of(L) * np.exp(np.abs(L).max(axis=(1, 2)) / 1e3)[:, None]


class KnowsTheOthers(Oil):
    """The viscosity of one particle depends on the rates of all."""

    def stress_of(self, L):
        return super().stress_of(L) * (1 + 1e-3 * np.mean(np.abs(L)))


HIDDEN = np.zeros(1000)


class HiddenState(Ageing):
    """A memory of its own, by the place that a particle has in its arrays."""

    def remember(self, state, strain):
        HIDDEN[: len(strain)] += strain

    def strain(self, state, n):
        return HIDDEN[:n]


class UndeclaredState(Ageing):
    """Adds what it has not declared."""

    def remember(self, state, strain):
        super().remember(state, strain)
        state["rate"] = strain


class ChangesTheKinematics(Oil):
    def update_stress(self, kinematics, state, dt, stress):
        super().update_stress(kinematics, state, dt, stress)
        kinematics.velocity_gradient[:] = 0.0


class RightForLeft(NeoHooke):
    """FᵀF for F Fᵀ."""

    def left(self, F):
        return transposed(F) @ F


class HalfTheEnergy(NeoHooke):
    def strain_energy(self, kinematics, state, stress):
        return super().strain_energy(kinematics, state, stress) / 2


class NoWaveSpeed(NeoHooke):
    def wave_speed(self, density, sound_speed):
        return ConstitutiveLaw.wave_speed(self, density, sound_speed)


class RemarkOfNobody(Oil):
    def remarks(self, density, sound_speed):
        return ["it is thick"]


class NoCitation(Oil):
    citation = None


class FlowCurveOff(Sound, GeneralisedNewtonianLaw):
    """tau0 (1 - exp(-m γ̇)) + 5 γ̇ with half the yield stress."""

    def apparent_viscosity(self, shear_rate):
        return -10.0 * np.expm1(-1e3 * shear_rate) / shear_rate + 5.0


class NewStress(Oil):
    """Gives the name of its stress to another array."""

    def update_stress(self, kinematics, state, dt, stress):
        stress = self.stress_of(kinematics.velocity_gradient)  # noqa: F841


class ReturnsItsStress(Oil):
    def update_stress(self, kinematics, state, dt, stress):
        return self.stress_of(kinematics.velocity_gradient)


class ReplacesItsState(Ageing):
    def remember(self, state, strain):
        state["strain"] = state["strain"] + strain
