"""Correct laws in plain NumPy; mutants are derived from them."""

import math

import numpy as np

from mpmkit.contracts import ConstitutiveLaw, ElastoviscoplasticLaw, StateVariable

PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))


def voigt(tensors):
    return np.stack([tensors[:, i, j] for i, j in PAIRS], axis=1)


def matrix(stress):
    return stress[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


def transposed(tensors):
    return tensors.transpose(0, 2, 1)


def deviator(tensors):
    return tensors - np.trace(tensors, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)


class Sound:
    """The common descriptor."""

    name, citation, api_version = "mutant", "none", 2


class Oil(Sound, ConstitutiveLaw):
    """A Newtonian fluid of 5 Pa s."""

    def update_stress(self, kinematics, state, dt, stress):
        stress[:] = self.stress_of(kinematics.velocity_gradient)

    def stress_of(self, L):
        return voigt(5.0 * deviator(L + transposed(L)))

    def largest_viscosity(self, largest_shear_rate):
        return 5.0


class Plastic(Sound, ElastoviscoplasticLaw):
    """A Bingham fluid, 20 Pa and 5 Pa s."""

    def flow_curve(self, shear_rate):
        return 20.0 + 5.0 * shear_rate


class Spring(Sound, ConstitutiveLaw):
    """An elastic material of 1 kPa with an objective stress rate."""

    modulus: float = 1e3

    def update_stress(self, kinematics, state, dt, stress):
        L = kinematics.velocity_gradient
        half = dt / 4 * (L - transposed(L))
        turn = np.linalg.solve(np.eye(3) - half, np.eye(3) + half)
        s = self.turned(turn, matrix(stress)) + self.modulus * dt * deviator(L + transposed(L))
        stress[:] = voigt(s)

    def turned(self, turn, s):
        return turn @ s @ transposed(turn)

    def wave_speed(self, density, sound_speed):
        return math.sqrt(sound_speed**2 + 4 * self.modulus / (3 * density))

    def strain_energy(self, kinematics, state, stress):
        return np.einsum("pij,pij->p", matrix(stress), matrix(stress)) / (4 * self.modulus)


class Ageing(Sound, ConstitutiveLaw):
    """A fluid whose viscosity grows by 5 Pa s per unit of strain, with a declared state variable."""

    state = {"strain": StateVariable("1", "shear strain that it has seen")}

    def update_stress(self, kinematics, state, dt, stress):
        D = deviator(kinematics.velocity_gradient + transposed(kinematics.velocity_gradient)) / 2
        self.remember(state, dt * np.sqrt(2 * np.einsum("pij,pij->p", D, D)))
        stress[:] = voigt(10.0 * (1 + self.strain(state, len(D)))[:, None, None] * D)

    def remember(self, state, strain):
        state["strain"] += strain

    def strain(self, state, n):
        return state["strain"]

    def largest_viscosity(self, largest_shear_rate):
        return 100.0


class NeoHooke(Sound, ConstitutiveLaw):
    """Neo-Hookean, G/2 (tr(FᵀF) - 3) - G ln J + lambda/2 (ln J)², both moduli 1 kPa."""

    uses_equation_of_state = False
    needs_deformation_gradient = True

    def update_stress(self, kinematics, state, dt, stress):
        J = kinematics.volume_ratio[:, None, None]
        B = self.left(kinematics.deformation_gradient)
        stress[:] = voigt(1e3 / J * (B - np.eye(3) + np.log(J) * np.eye(3)))

    def left(self, F):
        return F @ transposed(F)

    def wave_speed(self, density, sound_speed):
        return math.sqrt(3e3 / density)

    def strain_energy(self, kinematics, state, stress):
        F, log_J = kinematics.deformation_gradient, np.log(kinematics.volume_ratio)
        return 500.0 * (np.einsum("pij,pij->p", F, F) - 3) - 1e3 * log_J + 500.0 * log_J**2
