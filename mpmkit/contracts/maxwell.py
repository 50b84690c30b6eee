"""An elastic spring in series with a flow curve: stress that no step can overshoot.

    ds/dt (Jaumann) = 2 G (D′ - Dᵖ),   Dᵖ = γ̇ s / (2 τ),   τ = √(s:s/2) = f(γ̇)

Backward Euler in the flow leaves one scalar equation a particle, f(γ̇) + G Δt γ̇ = τ*, with τ* the shear
stress of the elastic trial. In steady flow the spring does not matter, τ = f(γ̇) exactly; below a yield stress
the material is elastic and rests. The viscosity that a step sees is Δτ/Δγ̇ ≤ G Δt, so that the only limit on
the step is that of the elastic wave, √(c² + 4 G / 3ρ). The spring adds a strain of τ/G, and a delay of μ/G
before a viscosity μ acts.

After Saramito, J. Non-Newtonian Fluid Mech. 158 (2009) 154-161, integrated as Simo & Hughes, Computational
Inelasticity (1998), ch. 2.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from ..kernels.elastic import elastic_trial, shrink, stored
from .base import one_each
from .law import ConstitutiveLaw, Kinematics
from .scale import Scale

STIFFNESS = 0.05
"""Least G over ρ c² where a case does not give G: it raises the wave speed, and with it the number of steps,
by 3 %."""
YIELD_STRAIN = 0.003
"""Largest τ0/G where a case does not give G; above it, a body vibrates elastically before it flows."""
FLOW_STRAIN = 0.01
"""Largest elastic strain, by the viscous stress that the scene can drive, where a case does not give G.

The relaxation time μ/G is then at most a hundredth of the time that the flow takes: √(h/g), or μ/(ρ g h)
where the flow creeps. As the stress is at most ρ g h, G needs to be no more than 100 ρ g h, which is ρ c²/2
for a sound speed of 10 √(2 g h) and costs 29 % more steps than the sound alone."""
SOFT = 0.02
"""Elastic strain at yield above which results are not to be trusted."""
LATE = 0.02
"""Part of a run above which the time μ/G, in which a viscosity comes to be felt, is not to be trusted."""
DEAR = 1.05
"""Times the steps above which a remark says what the spring costs."""

CLOSE = 1e-13
"""Part of τ* by which f(γ̇) + G Δt γ̇ may miss it."""

Curve = Callable[..., np.ndarray]
"""Shear stress, Pa, of steady shear at rates ``(m,)``, 1/s; and of the state, where a law has one."""


def shear_modulus(
    given: float | None,
    density: float,
    sound_speed: float | None,
    yield_stress: float = 0.0,
    flow_stress: float = 0.0,
) -> float:
    """G, Pa: the given one, or else the largest of 0.05 ρ c², τ0/0.003, and the flow stress over 0.01.

    Args:
        given: G of the case, Pa, or None.
        density: ρ, kg/m³.
        sound_speed: c, m/s.
        yield_stress: τ0, Pa.
        flow_stress: viscous stress that the scene can drive, Pa.
    """
    if given is not None:
        return given
    assert sound_speed is not None
    return max(STIFFNESS * density * sound_speed**2, yield_stress / YIELD_STRAIN, flow_stress / FLOW_STRAIN)


def wave_speed(modulus: float, density: float, sound_speed: float) -> float:
    """√(c² + 4 G / 3ρ), m/s."""
    return math.sqrt(sound_speed**2 + 4 * modulus / (3 * density))


def cost(law: ConstitutiveLaw, density: float, sound_speed: float | None) -> str:
    """End of a sentence on the cost of the spring; empty if the cost is small."""
    times = law.wave_speed(density, sound_speed) / sound_speed if sound_speed else 1.0
    return f", which makes the steps {times:.2g} times as many" if times > DEAR else ""


def warnings_of_delay(
    law: ConstitutiveLaw,
    modulus: float | None,
    density: float,
    sound_speed: float | None,
    scale: Scale,
    viscous_stress: Curve,
    until: float,
) -> list[str]:
    """Sentences if a viscosity μ acts too late: after μ/G of the spring, or μ/(ρ c²) of the sound.

    Args:
        law: whose name they have.
        modulus: G, Pa; None without a spring.
        density: ρ, kg/m³.
        sound_speed: c, m/s.
        scale: of the scene, which says how fast it may flow, and with it what μ is.
        viscous_stress: rising stress beyond the yield stress, Pa, at shear rates ``(m,)``, 1/s.
        until: time of the run, s.
    """
    rate, stress = scale.flow(viscous_stress, density)
    if sound_speed is None or not stress > 0:  # the stress is zero or NaN
        return []
    viscosity, allowed = stress / rate, LATE * until
    spring, sound = viscosity / (modulus or math.inf), viscosity / (density * sound_speed**2)
    share = f"{100 * LATE:g} %"
    enough = f"a sound_speed of {math.sqrt(viscosity / allowed / density):.3g} m/s makes it {share}"
    found = []
    if spring > allowed:
        given = "shear_modulus" in type(law).model_fields
        stiffer = (
            f"a shear_modulus of {viscosity / allowed:.2g} Pa makes it {share}"
            if given
            else "a larger sound_speed makes it less"
        )
        found.append(_too_late(law, viscosity, "G", spring, until, "a jelly", stiffer))
    if sound > allowed:
        found.append(_too_late(law, viscosity, "(rho c²)", sound, until, "a sponge", enough))
    return found


def _too_late(
    law: ConstitutiveLaw,
    viscosity: float,
    stiffness: str,
    delay: float,
    until: float,
    instead: str,
    remedy: str,
) -> str:
    return (
        f"law '{law.name}', with {viscosity:.3g} Pa s here, flows only after mu/{stiffness} = {delay:.2g} s, "
        f"{100 * delay / until:.2g} % of until; for a few times that long it behaves like {instead}, not "
        f"like a liquid, and its motion is wrong; {remedy}"
    )


def relax(
    kinematics: Kinematics,
    modulus: float,
    dt: float,
    stress: np.ndarray,
    relaxed: Callable[[np.ndarray, float], np.ndarray],
) -> None:
    """Update ``stress``, ``(n, 6)``, by a step; ``relaxed(trial, G Δt)`` is τ, ``(n,)``, of the trial's."""
    trial = np.empty(len(stress))
    elastic_trial(kinematics.velocity_gradient, dt, modulus, stress, trial)
    shrink(stress, trial, one_each(relaxed(trial, modulus * dt), trial, "relaxed_stress"))


def strain_energy(modulus: float, kinematics: Kinematics, stress: np.ndarray) -> np.ndarray:
    """J s:s / (4 G), J/m³ of initial volume."""
    energy = np.empty(len(stress))
    stored(stress, kinematics.volume_ratio, modulus, energy)
    return energy


def solve(
    flow_curve: Curve,
    trial: np.ndarray,
    stiffness: float,
    least_rate: float,
    state: Mapping[str, np.ndarray] | None = None,
) -> np.ndarray:
    """τ of f(γ̇) + G Δt γ̇ = τ* for any rising flow curve, by the Illinois rule on 0 <= γ̇ <= τ*/(G Δt).

    Every third step halves the bracket on a logarithmic scale instead, since a flow curve may turn anywhere.

    Args:
        flow_curve: f, from shear rates ``(m,)``, 1/s, all at least ``least_rate``, to Pa; its value there is
            the yield stress.
        trial: τ*, ``(n,)``, Pa. What either gives in single precision is solved to what it can tell apart.
        stiffness: G Δt, Pa s.
        least_rate: shear rate that stands for rest, 1/s.
        state: arrays ``(n, …)``; where it is given, f gets those of the same particles as a second argument.

    Raises:
        ArithmeticError: no rate is found; the curve does not rise.
    """
    result = trial.copy()
    low = np.full(len(trial), least_rate)
    at_rest = flow_curve(low) if state is None else flow_curve(low, state)
    close = _close(at_rest)
    if np.ndim(at_rest):  # a constant will do
        one_each(at_rest, low, "the flow curve")
    flows = np.flatnonzero(at_rest + stiffness * low < trial)
    if not len(flows):
        return result
    curve = flow_curve
    if state is not None:
        of_those = {name: array[flows] for name, array in state.items()}

        def curve(rate):
            return flow_curve(rate, of_those)

    target, low = trial[flows], low[flows]
    high = np.maximum(target / stiffness, least_rate)
    with np.errstate(over="ignore"):  # a curve may be beyond any number at the rate of the spring alone
        for _ in range(200):
            beyond = ~np.isfinite(curve(high) + stiffness * high)
            if not beyond.any():
                break
            middle = np.sqrt(low * high)
            short = curve(middle) + stiffness * middle < target
            low = np.where(beyond & short, middle, low)
            high = np.where(beyond & ~short, middle, high)
    below = curve(low) + stiffness * low - target
    above = curve(high) + stiffness * high - target
    side = np.zeros(len(flows), dtype=np.int8)
    rate, open_ = low.copy(), np.ones(len(flows), dtype=bool)
    for step in range(300):
        # What has converged stays as it is, so that no particle depends on how long another one takes.
        tried = (low * above - high * below) / (above - below) if step % 3 else np.sqrt(low * high)
        rate = np.where(open_, tried, rate)
        rest = curve(rate) + stiffness * rate - target
        open_ &= np.abs(rest) > close * target
        if not open_.any():
            break
        up = rest > 0
        # A side that is kept twice counts half, so that the other one moves as well.
        below = np.where(up, np.where(side == 1, below / 2, below), rest)
        above = np.where(up, rest, np.where(side == -1, above / 2, above))
        high, low = np.where(up, rate, high), np.where(up, low, rate)
        side = np.where(up, 1, -1).astype(np.int8)
    else:
        raise ArithmeticError(f"no shear rate gives {target[open_][0]:.6g} Pa: the flow curve must rise")
    # Of two forms of τ, the second does not magnify the rounding of a curve that is not of double precision.
    result[flows] = target - stiffness * rate if close == CLOSE else curve(rate)
    return result


def _close(values: np.ndarray) -> float:
    """``CLOSE``, or what the numbers of a flow curve can tell apart if they are not doubles."""
    dtype = np.result_type(values)
    return max(CLOSE, 8 * float(np.finfo(dtype).eps)) if np.issubdtype(dtype, np.floating) else CLOSE
