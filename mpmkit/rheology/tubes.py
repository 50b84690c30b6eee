"""Steady flow of a Bingham fluid in a tube: Buckingham & Reiner."""

from __future__ import annotations

HALVINGS = 100


def tube_gradient(radius: float, speed: float, yield_stress: float, viscosity: float) -> float:
    """Pressure per length, Pa/m, that moves a Bingham fluid through a tube.

        U = G R²/(8 μ) (1 - 4/3 φ + φ⁴/3),    φ = 2 τ0/(G R) ≤ 1

    Args:
        radius: R, m.
        speed: mean speed U, m/s.
        yield_stress, viscosity: τ0, Pa, and μ, Pa s.
    """

    def mean_speed(gradient: float) -> float:
        part = 2 * yield_stress / (gradient * radius)
        return gradient * radius**2 / (8 * viscosity) * (1 - 4 / 3 * part + part**4 / 3)

    newtonian = 8 * viscosity * speed / radius**2
    low, high = 2 * yield_stress / radius, newtonian + 8 / 3 * yield_stress / radius
    for _ in range(HALVINGS):
        gradient = (low + high) / 2
        low, high = (low, gradient) if mean_speed(gradient) > speed else (gradient, high)
    return high
