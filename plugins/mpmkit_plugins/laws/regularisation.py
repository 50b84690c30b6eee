"""Papanastasiou's regularised yield stress, for the loops of the laws that have one."""

from mpmkit.kernels.compile import inline
from mpmkit.kernels.elementary import expm1


@inline()
def yield_viscosity(shear_rate, yield_stress, regularisation):
    """tau0 (1 - exp(-m γ̇)) / γ̇, which tends to tau0 m at rest."""
    return -yield_stress * expm1(-regularisation * shear_rate) / shear_rate
