"""Whether a law does as it says: its state variables, its wave speed, its viscosity."""

from __future__ import annotations

import numpy as np

from ..contracts.scale import Scale
from .law_subject import LawSubject
from .specimens import plane, random_gradients, simple_shear
from .violation import Violation, require, require_all, require_same


def writes_in_place(subject: LawSubject) -> None:
    """The law writes into the arrays that it is given. Without that, nothing else of it can be seen."""
    specimens, L = subject.specimens(4), random_gradients(4)
    specimens.voigt[:] = np.linspace(1.0, 2.0, 24).reshape(4, 6)
    stress, state = specimens.voigt.copy(), dict(specimens.state)
    returned = subject.law.update_stress(specimens.kinematics(L), specimens.state, 1e-3, specimens.voigt)
    require(
        returned is None,
        f"its update_stress returned a {type(returned).__name__}; it must write into the array 'stress', "
        "as stress[:] = … does, and return nothing",
    )
    for name, array in state.items():
        require(
            specimens.state.get(name) is array,
            f"its update_stress replaced the array of its state '{name}'; it must write into the one there, "
            f"as state['{name}'][:] = … does",
        )
    require(
        not np.array_equal(specimens.voigt, stress),
        "its update_stress left the array 'stress' as it was; it must write into it, as stress[:] = … does "
        "(stress = … only makes another array of that name)",
    )


def declared_state(subject: LawSubject) -> None:
    """All that a law remembers is its stress and its declared state, which the framework sorts and saves.

    Half way through a motion, some particles go on elsewhere, in another order, from what was declared; and
    the law has driven others in between. Both go on alike, to the bit.
    """
    n = 40
    first, second = random_gradients(n, 8), random_gradients(n, 9)
    specimens = subject.specimens(n)
    specimens.drive(first, 0.1, 10)
    order = np.random.default_rng(10).permutation(n)[: n // 2]
    elsewhere = specimens.take(order)
    subject.respond(random_gradients(n, 11))
    specimens.drive(second, 0.1, 10)
    elsewhere.drive(second[order], 0.1, 10)
    same = "of a particle that goes on from its stress, deformation and declared state alone"
    require_same(
        elsewhere.stress,
        specimens.stress[order],
        lambda p, i, j: f"{plane(i, j)} {same}",
    )
    undeclared = set(specimens.state) - set(subject.law.state)
    require(not undeclared, f"it adds {sorted(undeclared)} to its state, which it does not declare")
    for name, variable in subject.law.state.items():
        array = specimens.state[name]
        expected = (n, *variable.shape)
        require(
            array.shape == expected,
            f"its state '{name}' became of shape {array.shape}; it must stay {expected}",
        )
        require(bool(np.isfinite(array).all()), f"its state '{name}' is not finite after a motion of 0.2 s")
        require_same(elsewhere.state[name], array[order], lambda *at, n=name: f"state '{n}' {same}")


def leaves_the_kinematics_alone(subject: LawSubject) -> None:
    """The law reads the motion of the particles, and writes its stress and state alone."""
    specimens = subject.specimens(10)
    L = random_gradients(10)
    specimens.drive(L, 1e-3)
    kinematics = specimens.kinematics(L)
    names = ("velocity_gradient", "volume_ratio", "pressure", "deformation_gradient")
    arrays = {name: array for name in names if (array := getattr(kinematics, name)) is not None}
    before = {name: array.copy() for name, array in arrays.items()}
    subject.law.update_stress(kinematics, specimens.state, 1e-3, specimens.voigt)
    for name, array in arrays.items():
        require_same(
            array, before[name], lambda *at, name=name: f"kinematics.{name}, which it must not change,"
        )


def wave_speed(subject: LawSubject) -> None:
    """No wave is faster than the law says: rho c² ≥ the modulus that a small strain, then held, shows.

    Along an axis that is the law's own modulus and the bulk modulus of the equation of state, if it has one.
    """
    given = subject.given_sound_speed
    try:
        said = subject.wave_speed()
    except ValueError as error:
        raise Violation(str(error)) from None
    require(np.isfinite(said) and said > 0, f"its wave speed is {said} m/s; it must be finite and positive")
    bulk = 0.0 if given is None else subject.density * given**2
    strain, dt = 1e-7, 1e-9
    for along, across, name, own in ((0, 0, "compressive", bulk), (0, 2, "shear", 0.0)):
        specimens = subject.specimens(1)
        specimens.drive(simple_shear(np.array([strain / dt]), along, across), dt)
        modulus = specimens.rest(dt)[0, along, across] / strain + own
        fastest = np.sqrt(max(modulus, 0.0) / subject.density)
        require(
            said >= fastest * (1 - 1e-3),
            f"its wave speed is {said:.6g} m/s, but a {name} wave, of modulus {modulus:.4g} Pa, runs at "
            f"{fastest:.6g} m/s: an explicit step would be too long",
        )


def largest_viscosity(subject: LawSubject) -> None:
    """No viscosity is larger than the law says: the stress over the rate that a stop at once takes away.

    What an elastic wave may add within a step, rho c² Δt, is not counted. The law is sampled by itself, so
    that a maximum between two samples may be higher by a thousandth.
    """
    dt = 1e-9
    for fastest in (1.0, 37.0, 1e4):
        rates = np.geomspace(1e-9, fastest, 500)
        said = subject.law.largest_viscosity(fastest)
        require(np.isfinite(said) and said >= 0, f"its largest viscosity up to {fastest:g} /s is {said} Pa s")
        specimens = subject.specimens(len(rates))
        moving = specimens.drive(simple_shear(rates), dt)[:, 0, 2]
        viscosity = (moving - specimens.rest(dt)[:, 0, 2]) / rates
        allowed = said * (1 + 1e-3) + subject.density * subject.wave_speed() ** 2 * dt
        require_all(
            viscosity <= allowed,
            lambda i, mu=viscosity, r=rates, said=said, fastest=fastest: (
                f"its viscosity at {r[i]:.3g} /s is {mu[i]:.6g} Pa s, but it says that it is {said:.6g} Pa s "
                f"at most, up to {fastest:g} /s: an explicit step would be too long"
            ),
            viscosity - allowed,
        )


def remarks(subject: LawSubject) -> None:
    """Sentences that name the law, without a number that is not finite; and so the warnings of a scene of
    1 m in which 1 J/kg moves for 1 ms."""
    given = subject.density, subject.given_sound_speed
    for what, sentences in (
        ("remark", subject.law.remarks(*given)),
        ("warning", subject.law.warnings(*given, Scale(energy=1.0, length=1.0), 1e-3)),
    ):
        for sentence in sentences:
            require(subject.law.name in sentence, f"a {what} does not name the law: {sentence!r}")
            require("nan" not in sentence.split(), f"a {what} has a number that is not finite: {sentence!r}")
