"""The elastic predictor of laws that relax: stress turned with the material and strained elastically."""

from __future__ import annotations

import math

from numba import prange

from .compile import CHUNK, chunk_count, kernel


@kernel()
def elastic_trial(L, dt, shear_modulus, stress, shear_stress):
    """s ← R s Rᵀ + 2 G Δt D′ in place, ``(n, 6)``, and its shear stress √(s:s/2), ``(n,)``.

    R is the rotation of the step by the midpoint rule, R = (I - Δt W/2)⁻¹ (I + Δt W/2) with the spin
    W = (L - Lᵀ)/2: orthogonal for any step, so that the stress is objective (Hughes & Winget, Int. J. Numer.
    Meth. Eng. 15 (1980) 1862-1867).
    """
    n = len(L)
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            # Half the angle of the step as an axial vector, and R = I + f (A + A²) with A its cross product.
            a = 0.25 * dt * (L[p, 2, 1] - L[p, 1, 2])
            b = 0.25 * dt * (L[p, 0, 2] - L[p, 2, 0])
            c = 0.25 * dt * (L[p, 1, 0] - L[p, 0, 1])
            f = 2.0 / (1.0 + a * a + b * b + c * c)
            r00, r01, r02 = 1.0 - f * (b * b + c * c), f * (a * b - c), f * (a * c + b)
            r10, r11, r12 = f * (a * b + c), 1.0 - f * (a * a + c * c), f * (b * c - a)
            r20, r21, r22 = f * (a * c - b), f * (b * c + a), 1.0 - f * (a * a + b * b)
            xx, yy, zz = stress[p, 0], stress[p, 1], stress[p, 2]
            yz, xz, xy = stress[p, 3], stress[p, 4], stress[p, 5]
            t00, t01, t02 = (
                r00 * xx + r01 * xy + r02 * xz,
                r00 * xy + r01 * yy + r02 * yz,
                r00 * xz + r01 * yz + r02 * zz,
            )
            t10, t11, t12 = (
                r10 * xx + r11 * xy + r12 * xz,
                r10 * xy + r11 * yy + r12 * yz,
                r10 * xz + r11 * yz + r12 * zz,
            )
            t20, t21, t22 = (
                r20 * xx + r21 * xy + r22 * xz,
                r20 * xy + r21 * yy + r22 * yz,
                r20 * xz + r21 * yz + r22 * zz,
            )
            g = shear_modulus * dt
            mean = (L[p, 0, 0] + L[p, 1, 1] + L[p, 2, 2]) / 3
            xx = t00 * r00 + t01 * r01 + t02 * r02 + 2 * g * (L[p, 0, 0] - mean)
            yy = t10 * r10 + t11 * r11 + t12 * r12 + 2 * g * (L[p, 1, 1] - mean)
            zz = t20 * r20 + t21 * r21 + t22 * r22 + 2 * g * (L[p, 2, 2] - mean)
            yz = t10 * r20 + t11 * r21 + t12 * r22 + g * (L[p, 1, 2] + L[p, 2, 1])
            xz = t00 * r20 + t01 * r21 + t02 * r22 + g * (L[p, 0, 2] + L[p, 2, 0])
            xy = t00 * r10 + t01 * r11 + t02 * r12 + g * (L[p, 0, 1] + L[p, 1, 0])
            stress[p, 0], stress[p, 1], stress[p, 2] = xx, yy, zz
            stress[p, 3], stress[p, 4], stress[p, 5] = yz, xz, xy
            shear_stress[p] = math.sqrt(0.5 * (xx * xx + yy * yy + zz * zz) + yz * yz + xz * xz + xy * xy)


@kernel()
def shrink(stress, shear_stress, allowed):
    """s ← s τ/τ*, in place, ``(n, 6)``: radially from its shear stress τ* to the allowed τ, ``(n,)``, Pa."""
    n = len(stress)
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            if shear_stress[p] > 0.0:
                factor = allowed[p] / shear_stress[p]
                for k in range(6):
                    stress[p, k] *= factor


@kernel()
def stored(stress, volume_ratio, shear_modulus, energy):
    """J s:s / (4 G), J/m³ of initial volume, into ``energy (n,)``."""
    n = len(stress)
    for chunk in prange(chunk_count(n)):
        for p in range(chunk * CHUNK, min(n, (chunk + 1) * CHUNK)):
            xx, yy, zz = stress[p, 0], stress[p, 1], stress[p, 2]
            yz, xz, xy = stress[p, 3], stress[p, 4], stress[p, 5]
            squares = xx * xx + yy * yy + zz * zz + 2 * (yz * yz + xz * xz + xy * xy)
            energy[p] = volume_ratio[p] * squares / (4 * shear_modulus)
