"""What every body force must do: an acceleration for each place, and bounds, means and times that fit it."""

from __future__ import annotations

import numpy as np

from ..contracts import BodyForce
from ..registry.audit import forces as audit
from ..spaces import SPACES, Space
from .surfaces import TIMES, N, points
from .violation import require, require_all, require_close, require_same

SPAN = 5.0
"""s, the run of the kit."""
PARTS = 2_000
"""Parts of a time in which the acceleration is integrated."""
ROUNDING = 1e-9


def at_home(force: BodyForce) -> list[Space]:
    """The spaces that can have it."""
    return [space for space in SPACES.values() if force.problem(space) is None]


def home(force: BodyForce) -> None:
    """At least one space can have it; of the others it says why not, in a sentence."""
    said = [force.problem(space) for space in SPACES.values()]
    require(None in said, f"no space can have it: {'; '.join(map(str, said))}")
    for why in said:
        require(why is None or bool(why.strip()), "its problem is an empty text; it must be a sentence")


def flow(space: Space, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Places, m, and velocities, m/s, all over a scene, (N, dim)."""
    x = points(space, size)
    v = np.random.default_rng(3).standard_normal(x.shape)
    return x, v


def arrays(force: BodyForce, space: Space, size: float) -> None:
    """Finite arrays of the right shape, from places and velocities that are only read."""
    x, v = flow(space, size)
    for time in TIMES:
        given = x.copy(), v.copy()
        force.acceleration(*given, time)
        for found, expected, what in ((given[0], x, "place"), (given[1], v, "velocity")):
            require_same(found, expected, lambda *at, w=what: f"coordinate {at[1]} of {w} {at[0]}, changed,")
        audit.acceleration(force, x, v, time)
        audit.mean_acceleration(force, x, v, time, time + 1e-3)
    require(
        any(audit.acceleration(force, x, v, t).any() for t in np.linspace(0, SPAN, 1001)),
        f"it accelerates nothing within {size:g} m of the origin in {SPAN:g} s",
    )


def batch_order(force: BodyForce, space: Space, size: float) -> None:
    """Places do not know each other, nor what was asked before: in another order, each gets the same."""
    (x, v), order = flow(space, size), np.random.default_rng(1).permutation(N)
    for time in reversed(TIMES):
        whole = audit.acceleration(force, x, v, time)
        for index, how in ((order, "in another order"), (np.array([N - 1]), "alone")):
            found = audit.acceleration(force, x[index], v[index], time)
            scale = max(1.0, float(np.abs(whole).max()))
            require_close(
                found,
                whole[index],
                1e-12 * scale,
                lambda *at, h=how: f"component {at[1]} of the acceleration of place {at[0]}, asked for {h},",
                "m/s²",
            )


def declares(force: BodyForce, space: Space, size: float) -> None:
    """It is uniform, constant, and independent of the velocity, if it says so."""
    x, v = flow(space, size)
    rest = np.zeros_like(v)
    require(force.uniform or not force.constant, "it is constant, but not uniform; constant ones are both")
    first = audit.acceleration(force, x, rest, 0.0)
    for time in TIMES:
        found, moving = (audit.acceleration(force, x, speed, time) for speed in (rest, v))
        scale = ROUNDING * max(1.0, float(np.abs(found).max()))
        if force.uniform:
            away = lambda p, a: f"component {a} at place {p}, of a uniform force,"  # noqa: E731
            require_close(found, np.broadcast_to(found[0], found.shape), scale, away, "m/s²")
        if force.constant:
            later = lambda p, a, t=time: f"component {a} at t = {t:g} s, of a constant force,"  # noqa: E731
            require_close(found, first, scale, later, "m/s²")
        if not force.of_velocity:
            faster = lambda p, a: f"component {a} for another velocity, without of_velocity,"  # noqa: E731
            require_close(moving, found, scale, faster, "m/s²")


def mean(force: BodyForce, space: Space, size: float) -> None:
    """The mean over a time is the integral of the acceleration over this time."""
    x, v = (array[:2] for array in flow(space, size))
    rest = np.zeros_like(v)
    for begin, end in ((0.0371, 0.0373), (0.5, 0.55), (1.3, 1.31)):
        if end - begin > audit.shortest_period(force) / 10:
            end = begin + audit.shortest_period(force) / 10
        times = begin + (end - begin) * (np.arange(PARTS) + 0.5) / PARTS
        found = np.array([audit.acceleration(force, x, rest, t) for t in times])
        given = audit.mean_acceleration(force, x, rest, begin, end)
        largest = max(1.0, float(np.abs(found).max()))
        require_close(
            given,
            found.mean(axis=0),
            5e-3 * largest,
            lambda p, a, b=begin, e=end: f"component {a} of the mean from {b:g} s to {e:g} s at place {p}",
            "m/s²",
        )


def largest(force: BodyForce, space: Space, size: float) -> None:
    """No acceleration of material at rest in a box is above the bound."""
    x, _ = flow(space, size)
    upper = np.full(space.dim, size)
    lower = -upper
    lower[0] = 0.0 if space.radial else -size
    bound = audit.largest(force, lower, upper, 0.0, SPAN)
    allowed = bound * (1 + ROUNDING) + ROUNDING * max(1.0, float(bound.max()))
    for time in np.linspace(0, SPAN, 501):
        found = np.abs(audit.acceleration(force, x, np.zeros_like(x), time))
        require_all(
            found <= allowed,
            lambda p, a, f=found, t=time: (
                f"component {a} is {f[p, a]:.6g} m/s² at t = {t:g} s; by largest it is at most {bound[a]:.6g}"
            ),
            found - allowed,
        )


def settles(force: BodyForce, space: Space, size: float) -> None:
    """From the time on that it says, it does not change."""
    since = audit.settles(force)
    audit.shortest_period(force)
    if not since < np.inf:
        return
    x, v = flow(space, size)
    start = max(0.0, since)
    first = audit.acceleration(force, x, v, start + 1e-9)
    for time in start + np.array([0.1931, 0.5713, 1.317, 4.771]):
        require_same(
            audit.acceleration(force, x, v, time),
            first,
            lambda p, a, t=time: f"component {a} at place {p} at t = {t:g} s, after it has settled,",
        )
