"""Tensor algebra for laws, in NumPy, on all particles at once.

Tensors are ``(n, 3, 3)`` in every space. Their axes 0, 1, 2 are the axes of the grid, and after them the axis
that is out of the plane. A law writes its stress as six components, ``(n, 6)``, Pa:

    component       0   1   2   3   4   5
    of the tensor   00  11  22  12  02  01
    3d              xx  yy  zz  yz  xz  xy
    plane-strain    xx  zz  yy  -   -   xz      y is out of the plane; - is zero
    axisymmetric    rr  zz  θθ  -   -   rz

Tension is positive. A shear component is that of the tensor, without a factor of 2.
"""

from __future__ import annotations

import numpy as np

from ..kernels.tensors import shear_rate

__all__ = [
    "deviator",
    "from_voigt",
    "rate_of_deformation",
    "rotated",
    "rotation",
    "second_invariant",
    "shear_rate",
    "shear_stress",
    "spin",
    "to_voigt",
    "transposed",
]

ROWS, COLUMNS = [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]
"""Where the six components stand in the tensor."""


def from_voigt(components: np.ndarray) -> np.ndarray:
    """The symmetric tensors, ``(n, 3, 3)``, of components 00, 11, 22, 12, 02, 01, ``(n, 6)``."""
    return components[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


def to_voigt(tensor: np.ndarray) -> np.ndarray:
    """The components 00, 11, 22, 12, 02, 01, ``(n, 6)``, of symmetric tensors, ``(n, 3, 3)``."""
    return tensor[:, ROWS, COLUMNS]


def transposed(tensor: np.ndarray) -> np.ndarray:
    """Aᵀ, ``(n, 3, 3)``."""
    return tensor.transpose(0, 2, 1)


def deviator(tensor: np.ndarray) -> np.ndarray:
    """A - tr(A)/3 I, ``(n, 3, 3)``."""
    return tensor - np.trace(tensor, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)


def rate_of_deformation(velocity_gradient: np.ndarray) -> np.ndarray:
    """D = (L + Lᵀ)/2, 1/s, ``(n, 3, 3)``."""
    return (velocity_gradient + transposed(velocity_gradient)) / 2


def spin(velocity_gradient: np.ndarray) -> np.ndarray:
    """W = (L - Lᵀ)/2, 1/s, ``(n, 3, 3)``."""
    return (velocity_gradient - transposed(velocity_gradient)) / 2


def second_invariant(tensor: np.ndarray) -> np.ndarray:
    """J2 = A′:A′/2 of the deviator A′, in the square of the tensor's unit, ``(n,)``."""
    part = deviator(tensor)
    return np.einsum("pij,pij->p", part, part) / 2


def shear_stress(stress: np.ndarray) -> np.ndarray:
    """τ = √(s:s/2) of the deviatoric stress s, Pa, ``(n,)``: in simple shear, the shear stress itself."""
    return np.sqrt(second_invariant(stress))


def rotation(velocity_gradient: np.ndarray, dt: float) -> np.ndarray:
    """R = (I - Δt W/2)⁻¹ (I + Δt W/2), ``(n, 3, 3)``: how the material turns in a step of Δt, s.

    It is orthogonal for any step (Hughes & Winget, Int. J. Numer. Meth. Eng. 15 (1980) 1862-1867).
    """
    half = dt / 2 * spin(velocity_gradient)
    return np.linalg.solve(np.eye(3) - half, np.eye(3) + half)


def rotated(tensor: np.ndarray, velocity_gradient: np.ndarray, dt: float) -> np.ndarray:
    """R A Rᵀ, ``(n, 3, 3)``: the tensor, turned with the material by a step of Δt, s.

    It integrates dA/dt = W A - A W, so that Jaumann's rate of the tensor is zero.
    """
    R = rotation(velocity_gradient, dt)
    return R @ tensor @ transposed(R)
