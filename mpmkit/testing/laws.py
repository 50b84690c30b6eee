"""What the stress of every law must be: in shear, of the right sign, seen alike by all, finite."""

from __future__ import annotations

from itertools import permutations

import numpy as np

from ..contracts import REST_SHEAR_RATE
from .law_subject import LawSubject
from .specimens import plane, random_gradients, random_rotations, simple_shear
from .violation import require, require_all, require_close, require_same


def resists_shear(subject: LawSubject) -> None:
    """Shear stress on each plane along the motion, odd in the rate, and no less at a higher one.

    A law that yields on normal components alone has none. One with state variables may thin as it flows.
    """
    rates = np.array([0.1, 1.0, 5.0])
    for along, across in permutations(range(3), 2):
        name = f"{plane(along, across)} of v_{'xyz'[along]} growing along {'xyz'[across]}"
        shear = subject.respond(simple_shear(rates, along, across))[:, along, across]
        back = subject.respond(simple_shear(-rates, along, across))[:, along, across]
        require_all(
            shear > 0,
            lambda i, shear=shear, name=name: (
                f"{name} at {rates[i]:g} /s is {shear[i]:.6g} Pa; it must resist, with more than zero"
            ),
        )
        if not subject.law.state:
            require_all(
                np.diff(shear) >= 0,
                lambda i, shear=shear, name=name: (
                    f"{name} falls from {shear[i]:.6g} Pa at {rates[i]:g} /s to {shear[i + 1]:.6g} Pa at "
                    f"{rates[i + 1]:g} /s"
                ),
            )
        require_close(back, -shear, 1e-9 * shear, lambda i, n=name: f"{n} at {-rates[i]:g} /s", "Pa")


def flow_curve(subject: LawSubject) -> None:
    """Steady simple shear gives the flow curve. Exists where there is one to compare with."""
    curve = subject.curve
    assert curve is not None
    rel = subject.rel or (1e-3 if subject.remembers or subject.law.state else 1e-6)
    rates = np.array([0.5, 5.0])
    steps = 2000 if subject.remembers or subject.law.state else 1
    found = [subject.respond(simple_shear(np.array([r])), subject.strain / r, steps)[0, 0, 2] for r in rates]
    expected = curve(rates) * np.ones(2)
    require_close(
        found, expected, rel * np.abs(expected), lambda i: f"steady shear stress at {rates[i]:g} /s", "Pa"
    )


def dissipation(subject: LawSubject) -> None:
    """∫ J sigma:D dt ≥ the strain energy ≥ 0, along a path that turns back and sideways.

    The spring of a law that relaxes is that of a nearly incompressible material, and is tried without change
    of volume.
    """
    isochoric = subject.remembers and subject.law.uses_equation_of_state
    L = random_gradients(200, isochoric=isochoric)
    L *= np.minimum(1.0, 2.0 / np.linalg.norm(L, axis=(1, 2)))[:, None, None]
    specimens, peak = subject.specimens(len(L)), np.zeros(len(L))
    for part in (L, -L, random_gradients(200, 5, isochoric) * 0.05):
        specimens.drive(part, 0.2, 200)
        peak = np.maximum(peak, np.abs(specimens.work))
        stored, work = specimens.strain_energy(), specimens.work
        slack = 1e-4 * peak + 1e-12  # of the quadrature over time, and of rounding
        require_all(
            stored >= -slack,
            lambda p, e=stored: f"the strain energy of a particle is {e[p]:.6g} J/m³",
            -stored,
        )
        require_all(
            work >= stored - slack,
            lambda p, work=work, stored=stored: (
                f"deforming a particle took {work[p]:.6g} J/m³ of work but {stored[p]:.6g} J/m³ are stored: "
                "energy out of nothing"
            ),
            (stored - work) / (peak + 1e-300),
        )


def objectivity(subject: LawSubject) -> None:
    """A turned observer sees a turned stress: R L Rᵀ, and with it R F Rᵀ, gives R sigma Rᵀ."""
    L, R = random_gradients(200), random_rotations(200)
    Rt = R.transpose(0, 2, 1)
    expected = R @ subject.respond(L) @ Rt
    scale = np.abs(expected).max(axis=(1, 2), keepdims=True)
    require_close(
        subject.respond(R @ L @ Rt),
        expected,
        1e-9 * scale + 1e-12,
        lambda p, i, j: f"{plane(i, j)} for an observer turned by a random rotation",
        "Pa",
    )


def turning(subject: LawSubject) -> None:
    """What stress is left when the motion stops turns with the body, by 1 rad in 200 steps."""
    n, steps = 50, 200
    W = random_gradients(n, 6)
    W = (W - W.transpose(0, 2, 1)) / 2
    W *= np.sqrt(2) / np.linalg.norm(W, axis=(1, 2), keepdims=True)  # 1 rad/s
    R = np.eye(3) + np.sin(1.0) * W + (1 - np.cos(1.0)) * W @ W
    L = random_gradients(n, 7, isochoric=subject.law.uses_equation_of_state)
    turned, held = subject.specimens(n), subject.specimens(n)
    for specimens in (turned, held):
        specimens.drive(L / np.linalg.norm(L, axis=(1, 2), keepdims=True), 1e-3, 10)
    scale = max(float(np.abs(held.stress).max()), subject.scale())
    require_close(
        turned.drive(W, 1.0, steps),
        R @ held.rest(1.0, steps) @ R.transpose(0, 2, 1),
        1e-4 * scale,
        lambda p, i, j: f"{plane(i, j)} of a body that was strained by 0.001 and then turned by 1 rad",
        "Pa",
    )


def rest(subject: LawSubject) -> None:
    """At rest from the beginning: no stress, and a finite energy."""
    specimens = subject.specimens(3)
    if not subject.remembers:
        specimens.voigt[:] = np.nan  # every component is to be written
    stress = specimens.rest(0.1, 3)
    require_close(stress, 0.0, 0.0, lambda p, i, j: f"{plane(i, j)} of a body at rest", "Pa")
    energy = specimens.strain_energy()
    require(bool(np.isfinite(energy).all()), f"the strain energy of a body at rest is {energy[0]:g} J/m³")


def extreme_rates(subject: LawSubject) -> None:
    """Finite from 1e-300 /s to 1e6 /s."""
    rates = np.array([0.0, 1e-300, 1e-30, REST_SHEAR_RATE, 1e-6, 1.0, 1e3, 1e6])
    stress = subject.respond(simple_shear(rates), 1e-6, 1)
    require_all(
        np.isfinite(stress),
        lambda p, i, j: f"{plane(i, j)} in simple shear at {rates[p]:g} /s is {stress[p, i, j]}",
    )
    shear = np.abs(stress[:, 0, 2])
    require_all(
        np.diff(shear) >= 0,
        lambda i: (
            f"stress xz falls from {shear[i]:.6g} Pa at {rates[i]:g} /s to {shear[i + 1]:.6g} Pa at "
            f"{rates[i + 1]:g} /s"
        ),
    )


def batch_order(subject: LawSubject) -> None:
    """Particles do not know each other: in another order, or alone, each gets the same stress to the bit."""
    L = random_gradients(300)  # more than one chunk of the kernels
    order = np.random.default_rng(2).permutation(300)
    stress = subject.respond(L)
    require_same(
        subject.respond(L[order]),
        stress[order],
        lambda p, i, j: f"{plane(i, j)} of particle {order[p]} of 300, handed over in another order,",
    )
    for one in (0, 7, 299):
        require_same(
            subject.respond(L[one : one + 1])[0],
            stress[one],
            lambda i, j, one=one: f"{plane(i, j)} of particle {one} of 300, handed over alone,",
        )


def swelling(subject: LawSubject) -> None:
    """Change of volume leaves no mean stress to a law whose pressure an equation of state gives.

    A law without one resists it by itself. Seen when the motion has stopped, since a viscosity may resist.
    """
    specimens = subject.specimens(1)
    specimens.drive(0.1 * np.eye(3)[None], 0.1, 10)
    mean = float(np.trace(specimens.rest(1e-6)[0])) / 3
    if subject.law.uses_equation_of_state:
        bulk = subject.density * subject.sound_speed**2
        require(
            abs(mean) <= 1e-9 * bulk,
            f"the mean stress of a body swollen by 3 % is {mean:.6g} Pa; it is the equation of state's, and "
            "must be zero here",
        )
    else:
        require(mean > 0, f"the mean stress of a body swollen by 3 % is {mean:.6g} Pa; it must be tension")
