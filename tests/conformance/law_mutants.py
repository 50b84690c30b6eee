"""Laws with one fault each."""

import numpy as np
from sound_laws import Ageing, NeoHooke, Oil, Plastic, Sound, Spring, deviator, transposed, voigt

from mpmkit.contracts import ConstitutiveLaw, GeneralisedNewtonianLaw


class NormalComponentsOnly(Plastic):
    """Fault: yield and flow use the normal components only. Two published codes have this fault."""

    def update_stress(self, kinematics, state, dt, stress):
        super().update_stress(kinematics, state, dt, stress)
        stress[:, 3:] = 0.0


class TwiceTheStress(Oil):
    def stress_of(self, L):
        return 2 * super().stress_of(L)

    def largest_viscosity(self, largest_shear_rate):
        return 10.0


class TwiceTheFlow(Plastic):
    """Fault: the return mapping belongs to another flow curve."""

    def relaxed_stress(self, trial, stiffness):
        return np.minimum(trial, 20.0) + 10.0 / (10.0 + stiffness) * np.maximum(trial - 20.0, 0.0)


class WrongSign(Oil):
    def stress_of(self, L):
        return -super().stress_of(L)


class WrongSignOfOneShear(Oil):
    """Fault: a wrong sign in the shear stress of one plane."""

    def stress_of(self, L):
        return super().stress_of(L) * np.array([1, 1, 1, 1, 1, -1])


class GradientNotTransposed(Oil):
    """Fault: 2 mu L instead of mu (L + Lᵀ)."""

    def stress_of(self, L):
        return voigt(10.0 * deviator(L))


class ShearStressesInAnotherOrder(Oil):
    """Fault: shear components in the order xy, yz, xz instead of yz, xz, xy."""

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
    """Fault: uses D instead of its deviator, and so resists a change of volume."""

    def update_stress(self, kinematics, state, dt, stress):
        L = kinematics.velocity_gradient
        stress[:] += voigt(self.modulus * dt * (L + transposed(L)))


class SlowWave(Spring):
    """Fault: ten times as stiff as its wave speed says."""

    modulus: float = 1e7

    def wave_speed(self, density, sound_speed):
        return sound_speed


class ThinnerThanItIs(Oil):
    def largest_viscosity(self, largest_shear_rate):
        return 2.5


class EnergyOfNothing(Oil):
    """Fault: a fluid with an elastic energy."""

    def strain_energy(self, kinematics, state, stress):
        return 1.0


class NothingAtRest(Oil):
    """Fault: 0/0 at rest."""

    def stress_of(self, L):
        D = deviator(L + transposed(L)) / 2
        rate = np.sqrt(2 * np.einsum("pij,pij->p", D, D))[:, None, None]
        with np.errstate(invalid="ignore"):
            return voigt(10.0 * rate * D / rate)


class Overflows(Oil):
    """Fault: overflows at 1e6 /s."""

    def stress_of(self, L):
        with np.errstate(over="ignore", invalid="ignore"):
            return super().stress_of(L) * np.exp(np.abs(L).max(axis=(1, 2)) / 1e3)[:, None]


class KnowsTheOthers(Oil):
    """Fault: the viscosity of a particle depends on the rates of all particles."""

    def stress_of(self, L):
        return super().stress_of(L) * (1 + 1e-3 * np.mean(np.abs(L)))


HIDDEN = np.zeros(1000)


class HiddenState(Ageing):
    """Fault: keeps a memory of its own by the index of a particle, which changes."""

    def remember(self, state, strain):
        HIDDEN[: len(strain)] += strain

    def strain(self, state, n):
        return HIDDEN[:n]


class UndeclaredState(Ageing):
    """Fault: adds a state variable that it has not declared."""

    def remember(self, state, strain):
        super().remember(state, strain)
        state["rate"] = strain


class ChangesTheKinematics(Oil):
    def update_stress(self, kinematics, state, dt, stress):
        super().update_stress(kinematics, state, dt, stress)
        kinematics.velocity_gradient[:] = 0.0


class RightForLeft(NeoHooke):
    """Fault: FᵀF instead of F Fᵀ."""

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
    """Fault: the flow curve has half of the yield stress of the law."""

    def apparent_viscosity(self, shear_rate):
        return -10.0 * np.expm1(-1e3 * shear_rate) / shear_rate + 5.0


class NewStress(Oil):
    """Fault: assigns a new array to the name of its stress instead of writing in place."""

    def update_stress(self, kinematics, state, dt, stress):
        stress = self.stress_of(kinematics.velocity_gradient)  # noqa: F841


class ReturnsItsStress(Oil):
    def update_stress(self, kinematics, state, dt, stress):
        return self.stress_of(kinematics.velocity_gradient)


class ReplacesItsState(Ageing):
    def remember(self, state, strain):
        state["strain"] = state["strain"] + strain
