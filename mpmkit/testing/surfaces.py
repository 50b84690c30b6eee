"""What every surface must be: a distance with its gradient, and a motion that its velocity tells."""

from __future__ import annotations

import numpy as np

from ..contracts import Surface
from ..registry import audit
from ..registry.audit import AuditedSurface
from ..spaces import SPACES, Space
from .violation import require, require_all, require_close, require_same

TIMES = (0.0, 0.0371, 0.1931, 0.5713, 1.317, 4.771)
"""s; a motion that begins or ends at one of them to the digit is not meant."""
N = 1000
"""Points."""
STEP = 1e-6
"""Of differences in space, in sizes of the scene, and in time, s."""
SMOOTH = 1e-3
"""By how much the normals around a point may differ, so that it is not where two points are nearest."""


def at_home(surface: Surface) -> list[Space]:
    """The spaces that can hold a surface."""
    return [space for space in SPACES.values() if surface.problem(space) is None]


def problem(surface: Surface) -> None:
    """At least one space can hold it; of the others it says why not, in a sentence."""
    said = {name: audit.problem(surface, space) for name, space in SPACES.items()}
    require(None in said.values(), f"no space can hold it: {'; '.join(str(why) for why in said.values())}")
    for name, why in said.items():
        require(why is None or bool(why.strip()), f"it does not say why the space {name} cannot hold it")


def points(space: Space, size: float, seed: int = 0) -> np.ndarray:
    """Points all over a scene, m, (N, dim); r ≥ 0 in axisymmetric ones."""
    x = np.random.default_rng(seed).uniform(-size, size, (N, space.dim))
    if space.radial:
        x[:, 0] = np.abs(x[:, 0])
    return x


def arrays(surface: Surface, space: Space, size: float) -> None:
    """Finite arrays of the right shapes, normals of length 1, and points that are only read."""
    placed = audit.placed(surface, space)
    require(placed.thickness > 0, "its thickness is not above 0")
    for time in TIMES:
        x = points(space, size)
        placed.distance(x, time)
        placed.velocity(x, time)
        placed.present(time)
        require_same(x, points(space, size), lambda *at: f"coordinate {at[1]} of point {at[0]}, changed,")


def batch_order(surface: Surface, space: Space, size: float) -> None:
    """Points do not know each other, nor what was asked before: in another order, each gets the same."""
    x, order = points(space, size), np.random.default_rng(1).permutation(N)
    placed = audit.placed(surface, space)
    for time in reversed(TIMES):
        whole, part = _all(placed, x, time), _all(audit.placed(surface, space), x[order], time)
        for name, found, expected in zip(("distance", "normal", "velocity"), part, whole, strict=True):
            require_close(
                found,
                expected[order],
                1e-12 * max(1.0, float(np.abs(expected).max())),
                lambda *at, n=name: f"the {n} of a point that is handed over in another order",
            )


def lipschitz(surface: Surface, space: Space, size: float) -> None:
    """|d(x) - d(y)| ≤ |x - y|: no distance changes faster than the place does."""
    placed, x, y = audit.placed(surface, space), points(space, size), points(space, size, seed=2)
    y[::2] = x[::2] + 0.01 * (y[::2] - x[::2])
    apart = np.linalg.norm(x - y, axis=1)
    for time in TIMES:
        change = np.abs(placed.distance(x, time)[0] - placed.distance(y, time)[0])
        require_all(
            change <= apart * (1 + 1e-9) + 1e-12 * size,
            lambda p, t=time, c=change: (
                f"the distance changes by {c[p]:.6g} m from {_at(x[p], t)} to a point {apart[p]:.6g} m away; "
                "it may change by no more"
            ),
            change - apart,
        )


def normals(surface: Surface, space: Space, size: float) -> None:
    """The normal is the gradient of the distance, by central differences, away from ridges."""
    placed, x, h = audit.placed(surface, space), points(space, size), STEP * size
    for time in TIMES:
        normal = placed.distance(x, time)[1]
        slope, ridge = np.empty_like(normal), np.zeros(N, dtype=bool)
        for axis in range(space.dim):
            step = h * np.eye(space.dim)[axis]
            (ahead, n_ahead), (behind, n_behind) = (
                placed.distance(x + step, time),
                placed.distance(x - step, time),
            )
            slope[:, axis] = (ahead - behind) / (2 * h)
            ridge |= (np.abs(n_ahead - normal) + np.abs(n_behind - normal)).max(axis=1) > SMOOTH
        require(
            ridge.mean() < 0.2,
            f"its normals jump everywhere: at {ridge.mean():.0%} of the points, t = {time:g} s",
        )
        require_close(
            np.where(ridge[:, None], slope, normal),
            slope,
            2e-3,
            lambda p, a, t=time: (
                f"component {a} of the normal at {_at(x[p], t)}, against the slope of the distance,"
            ),
        )


def fastest(surface: Surface, space: Space, size: float) -> None:
    """No velocity of the wall is above the fastest that it says, for a time and for times around it."""
    placed, x = audit.placed(surface, space), points(space, size)
    for time in TIMES:
        speed = np.linalg.norm(placed.velocity(x, time), axis=1)
        for begin, end in ((time, time), (max(0.0, time - 0.1), time + 0.1), (0.0, 10.0)):
            bound = placed.fastest(begin, end)
            require_all(
                speed <= bound * (1 + 1e-9) + 1e-12,
                lambda p, t=time, b=bound, s=speed, span=(begin, end): (
                    f"the wall moves at {s[p]:.6g} m/s at {_at(x[p], t)}, but its fastest from "
                    f"{span[0]:g} to {span[1]:g} s is {b:.6g} m/s"
                ),
                speed,
            )


def moves_as_it_says(surface: Surface, space: Space, size: float) -> None:
    """A point that goes with the wall keeps its distance: d(x + v dt, t + dt) = d(x, t)."""
    placed, x = audit.placed(surface, space), points(space, size)
    for time in TIMES:
        distance, normal = placed.distance(x, time)
        velocity = placed.velocity(x, time)
        later, turned = placed.distance(x + STEP * velocity, time + STEP)
        ridge = np.abs(turned - normal).max(axis=1) > SMOOTH
        speed = float(np.linalg.norm(velocity, axis=1).max())
        require_close(
            np.where(ridge, 0.0, (later - distance) / STEP),
            0.0,
            1e-3 * speed + 1e-8 * size,
            lambda p, t=time: (
                f"the speed at which a point that goes with the wall leaves it, at {_at(x[p], t)},"
            ),
            "m/s",
        )


def _all(placed: AuditedSurface, x: np.ndarray, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return (*placed.distance(x, time), placed.velocity(x, time))


def _at(x: np.ndarray, time: float) -> str:
    return f"({', '.join(f'{c:.4g}' for c in x)}) m, t = {time:g} s"
