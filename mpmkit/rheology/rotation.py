"""Torque of a cylinder that turns in a cup of Bingham fluid."""

from __future__ import annotations

import math


def cylinder_torque(
    radius: float, height: float, rate: float, yield_stress: float, viscosity: float
) -> float:
    """M, N m, on the side of a cylinder that turns slowly; the fluid is sheared up to the radius β R.

    Reiner & Riwlin, for a cup that is wider than β R, where the shear stress is τ0: M = 2π β² R² h τ0, with

        β² - 1 - 2 ln β = 2 μ Ω/τ0

    Ω → 0 gives the start of flow, 2π R² h τ0; the ends of a vane add 2R/(3h) of it (Dzuy & Boger 1983). The
    material between the blades of a vane turns with them, so that the vane acts as a cylinder.

    Args:
        radius, height: R and h, m.
        rate: Ω, rad/s.
        yield_stress: τ0, Pa.
        viscosity: μ, Pa s.
    """
    low, high = 1.0, 2.0 + math.sqrt(2 * viscosity * rate / yield_stress) * 2
    for _ in range(80):
        beta = (low + high) / 2
        beyond = beta**2 - 1 - 2 * math.log(beta) > 2 * viscosity * rate / yield_stress
        low, high = (low, beta) if beyond else (beta, high)
    return 2 * math.pi * (low * radius) ** 2 * height * yield_stress


def coaxial_torque(
    inner: float, outer: float, height: float, rate: float, yield_stress: float, viscosity: float
) -> float:
    """M, N m, on the side of a cylinder that turns in a coaxial cup; exact (Reiner & Riwlin).

        M = 4π h [μ Ω + τ0 ln(R_s/R_i)]/(R_i⁻² - R_s⁻²)

    where R_s = R_o if the fluid is sheared up to the cup, M/(2π R_o² h) ≥ τ0; else R_s is the radius at which
    the shear stress has fallen to τ0, and the torque is that in a wide cup.

    Args:
        inner, outer: R_i and R_o, m.
        height: h, m.
        rate: Ω, rad/s.
        yield_stress, viscosity: τ0, Pa, and μ, Pa s.
    """
    wide = cylinder_torque(inner, height, rate, yield_stress, viscosity)
    if wide < 2 * math.pi * outer**2 * height * yield_stress:
        return wide
    drive = viscosity * rate + yield_stress * math.log(outer / inner)
    return 4 * math.pi * height * drive / (inner**-2 - outer**-2)
