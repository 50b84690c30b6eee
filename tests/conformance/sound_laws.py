"""Laws in plain NumPy with nothing wrong with them, for mutants to be made of."""

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
    """What every descriptor says."""

    name, citation, api_version = "mutant", "none", 2


class Oil(Sound, ConstitutiveLaw):
    """A Newtonian fluid of 5 Pa s, which has nothing wrong with it."""

    def update_stress(self, kinematics, state, dt, stress):
        stress[:] = self.stress_of(kinematics.velocity_gradient)

    def stress_of(self, L):
        return voigt(5.0 * deviator(L + transposed(L)))

    def largest_viscosity(self, largest_shear_rate):
        return 5.0


class Plastic(Sound, ElastoviscoplasticLaw):
    """Bingham's, 20 Pa and 5 Pa s, which has nothing wrong with it."""

    def flow_curve(self, shear_rate):
        return 20.0 + 5.0 * shear_rate


class Spring(Sound, ConstitutiveLaw):
    """Elastic, of 1 kPa, by a rate that turns with the material; nothing wrong with it."""

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
    """A fluid of 5 Pa s that stiffens by as much for every unit of strain, which it has declared."""

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
    """G/2 (tr(FᵀF) - 3) - G ln J + lambda/2 (ln J)², both 1 kPa; nothing wrong with it."""

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
