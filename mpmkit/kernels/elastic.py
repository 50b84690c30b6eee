"""The elastic predictor of laws that relax: the stress rotates with the material and grows elastically."""

from __future__ import annotations

import math

from numba import prange

from .compile import CHUNK, chunk_count, inline, kernel
from .elementary import fused


@inline()
def dot(a, b, c, x, y, z):
    """a x + b y + c z."""
    return fused(a, x, fused(b, y, c * z))


@kernel()
def elastic_trial(L, dt, shear_modulus, stress, shear_stress):
    """s ← R s Rᵀ + 2 G Δt D′ in place, ``(n, 6)``, and its shear stress √(s:s/2), ``(n,)``.

    R is the rotation of the step by the midpoint rule, R = (I - Δt W/2)⁻¹ (I + Δt W/2) with the spin
    W = (L - Lᵀ)/2: orthogonal for any step, so that the stress is objective (Hughes & Winget, Int. J. Numer.
    Meth. Eng. 15 (1980) 1862-1867).
    """
    n, gradients, stresses = len(L), L.reshape(-1), stress.reshape(-1)
    for chunk in prange(chunk_count(n)):
        begin, end = chunk * CHUNK, min(n, (chunk + 1) * CHUNK)
        # Flat parts: the compiler then sees that no two entries overlap, and takes several particles at once.
        L_, s = gradients[9 * begin : 9 * end], stresses[6 * begin : 6 * end]
        found = shear_stress[begin:end]
        for p in range(len(found)):
            k, i = 9 * p, 6 * p
            # Half the angle of the step as an axial vector, and R = I + f (A + A²) with A its cross product.
            a = 0.25 * dt * (L_[k + 7] - L_[k + 5])
            b = 0.25 * dt * (L_[k + 2] - L_[k + 6])
            c = 0.25 * dt * (L_[k + 3] - L_[k + 1])
            f = 2.0 / (1.0 + a * a + b * b + c * c)
            r00, r01, r02 = 1.0 - f * (b * b + c * c), f * (a * b - c), f * (a * c + b)
            r10, r11, r12 = f * (a * b + c), 1.0 - f * (a * a + c * c), f * (b * c - a)
            r20, r21, r22 = f * (a * c - b), f * (b * c + a), 1.0 - f * (a * a + b * b)
            xx, yy, zz = s[i], s[i + 1], s[i + 2]
            yz, xz, xy = s[i + 3], s[i + 4], s[i + 5]
            t00, t01, t02 = (
                dot(r00, r01, r02, xx, xy, xz),
                dot(r00, r01, r02, xy, yy, yz),
                dot(r00, r01, r02, xz, yz, zz),
            )
            t10, t11, t12 = (
                dot(r10, r11, r12, xx, xy, xz),
                dot(r10, r11, r12, xy, yy, yz),
                dot(r10, r11, r12, xz, yz, zz),
            )
            t20, t21, t22 = (
                dot(r20, r21, r22, xx, xy, xz),
                dot(r20, r21, r22, xy, yy, yz),
                dot(r20, r21, r22, xz, yz, zz),
            )
            g = shear_modulus * dt
            mean = (L_[k] + L_[k + 4] + L_[k + 8]) / 3
            xx = fused(2 * g, L_[k] - mean, dot(t00, t01, t02, r00, r01, r02))
            yy = fused(2 * g, L_[k + 4] - mean, dot(t10, t11, t12, r10, r11, r12))
            zz = fused(2 * g, L_[k + 8] - mean, dot(t20, t21, t22, r20, r21, r22))
            yz = fused(g, L_[k + 5] + L_[k + 7], dot(t10, t11, t12, r20, r21, r22))
            xz = fused(g, L_[k + 2] + L_[k + 6], dot(t00, t01, t02, r20, r21, r22))
            xy = fused(g, L_[k + 1] + L_[k + 3], dot(t00, t01, t02, r10, r11, r12))
            s[i], s[i + 1], s[i + 2] = xx, yy, zz
            s[i + 3], s[i + 4], s[i + 5] = yz, xz, xy
            found[p] = math.sqrt(fused(0.5, dot(xx, yy, zz, xx, yy, zz), dot(yz, xz, xy, yz, xz, xy)))


@kernel()
def shrink(stress, shear_stress, allowed):
    """s ← s τ/τ*, in place, ``(n, 6)``: radial return from the shear stress τ* to the allowed τ, Pa."""
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
