"""What every body shape must be: a signed distance, in bounds that hold it, with the volume that it says."""

from __future__ import annotations

import numpy as np

from ..contracts import BodyShape
from ..contracts.body_volume import size_between
from ..errors import PluginFault
from ..registry.audit.body_shapes import problem_of_shape, size_of, volume_of
from ..spaces import SPACES, Space
from .violation import Violation, require, require_all, require_close, require_same

N = 2000
"""Points."""
AROUND = 0.3
"""How far from its bounds points are, in its largest extent."""
NEAR = 0.05
"""How near to the surface a distance must be the distance, in the largest extent."""
ON_IT, MOST = 2e-3, 0.8
"""By how much, in the largest extent, a point led to the surface may miss it, and the part that must not: a
corner outside may be rounded off by the distance."""
VOLUME = 2e-3
"""Relative difference of a volume and that which the distance encloses."""


def at_home(shape: BodyShape) -> list[Space]:
    """The spaces that can hold a shape."""
    return [space for space in SPACES.values() if shape.problem(space) is None]


def home(shape: BodyShape) -> None:
    """At least one space can hold it, in bounds; of the others it says why not, in a sentence."""
    try:
        said = {name: problem_of_shape(shape, space) for name, space in SPACES.items()}
    except PluginFault as fault:
        raise Violation(str(fault)) from None
    require(None in said.values(), f"no space can hold it: {'; '.join(str(why) for why in said.values())}")
    for name, why in said.items():
        require(why is None or bool(why.strip()), f"it does not say why the space {name} cannot hold it")


def _extent(shape: BodyShape, space: Space) -> float:
    lower, upper = shape.bounds(space)
    return float((upper - lower).max())


def points(shape: BodyShape, space: Space) -> np.ndarray:
    """Points in and around it, m, (N, dim); r ≥ 0 in axisymmetric scenes."""
    lower, upper = shape.bounds(space)
    margin = AROUND * _extent(shape, space)
    x = np.random.default_rng(0).uniform(lower - margin, upper + margin, (N, space.dim))
    if space.radial:
        x[:, 0] = np.abs(x[:, 0])
    return x


def distances(shape: BodyShape, space: Space) -> None:
    """Finite distances of points that are only read, each for itself, above 0 outside of the bounds."""
    x = points(shape, space)
    found, _ = shape.solid(space).distance(x)
    require_same(x, points(shape, space), lambda *at: f"coordinate {at[1]} of point {at[0]}, changed,")
    order = np.random.default_rng(1).permutation(N)
    again = shape.signed_distance(x[order], space)
    require_same(again, found[order], lambda *at: f"the distance of point {at[0]}, in another order,")
    lower, upper = shape.bounds(space)
    outside = ((x < lower) | (x > upper)).any(axis=1)
    require_all(
        ~outside | (found >= 0),
        lambda p: f"a point outside of its bounds has the distance {found[p]:.4g} m, which is below 0",
    )


def never_too_far(shape: BodyShape, space: Space) -> None:
    """Between two points the distance changes by no more than they are apart."""
    x = points(shape, space)
    found = shape.signed_distance(x, space)
    apart = np.linalg.norm(x[1:] - x[:-1], axis=1)
    change, rounding = np.abs(np.diff(found)), 1e-9 * _extent(shape, space)
    require_all(
        change <= apart + rounding,
        lambda p: f"the distance changes by {change[p]:.4g} m between points {apart[p]:.4g} m apart",
        change - apart,
    )


def leads_to_the_surface(shape: BodyShape, space: Space) -> None:
    """Near the surface it is the distance: that far along its gradient, the distance is 0."""
    extent, solid = _extent(shape, space), shape.solid(space)
    x = points(shape, space)
    found, gradient = solid.distance(x)
    near = np.abs(found) < NEAR * extent
    there, _ = solid.distance(x[near] - found[near, None] * gradient[near])
    reached = float((np.abs(there) <= ON_IT * extent).mean()) if near.any() else 0.0
    require(
        reached >= MOST,
        f"{1 - reached:.0%} of the points near the surface do not come to it along the gradient of the "
        "distance, which is too short or too long there",
    )


def contains(shape: BodyShape, space: Space) -> None:
    """What is inside is where the distance is below 0."""
    x = points(shape, space)
    found, inside = shape.signed_distance(x, space), shape.contains(x, space)
    clear = np.abs(found) > 2 * shape.tolerance * _extent(shape, space)
    require_all(
        ~clear | (inside == (found < 0)),
        lambda p: f"a point at {found[p]:.4g} m is said to be {'inside' if inside[p] else 'outside'}",
    )


def volume(shape: BodyShape, space: Space) -> None:
    """Its volume is that which the distance encloses, and that of its parts together."""
    lower, upper = shape.bounds(space)
    solid, whole = shape.solid(space), volume_of(shape, space)
    enclosed = size_between(solid.distance, lower, upper, space, around=space.radial)
    require_close(whole, enclosed, VOLUME * enclosed, lambda: "its volume", "m³")
    size = size_between(solid.distance, lower, upper, space)
    require_close(size_of(shape, space), size, VOLUME * size, lambda: "its size")
    cut = lower + 0.37 * (upper - lower)
    for axis in range(space.dim):
        low, high = lower.copy(), upper.copy()
        low[axis] = high[axis] = cut[axis]
        parts = shape.part(lower, high, space) + shape.part(low, upper, space)
        require_close(
            parts, whole, VOLUME * whole, lambda a=axis: f"the volume of parts along axis {a}", "m³"
        )
