"""Body forces: the accelerations and the numbers that they return."""

from __future__ import annotations

import numpy as np

from ...contracts import BodyForce
from ...errors import PluginFault
from .returned import require_array, require_number


def mean_acceleration(force: BodyForce, x: np.ndarray, v: np.ndarray, t0: float, t1: float) -> np.ndarray:
    """Mean acceleration over a step, m/s², ``(n, dim)``.

    Raises:
        PluginFault: it is not an array of this shape, or not finite although places and velocities are.
    """
    found = force.mean_acceleration(_read_only(x), _read_only(v), t0, t1)
    require_array(force, "mean_acceleration", found, x.shape)
    if not np.isfinite(found.sum()) and np.isfinite(x.sum() + v.sum()) and not np.isfinite(found).all():
        raise PluginFault(force, f"gave an acceleration that is not finite at t = {t0:.6g} s")
    return found


def acceleration(force: BodyForce, x: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
    """Acceleration at a time, m/s², ``(n, dim)``; raises as ``mean_acceleration``."""
    found = force.acceleration(_read_only(x), _read_only(v), t)
    require_array(force, "acceleration", found, x.shape)
    if not np.isfinite(found).all():
        raise PluginFault(force, f"gave an acceleration that is not finite at t = {t:.6g} s")
    return found


def largest(force: BodyForce, lower: np.ndarray, upper: np.ndarray, t0: float, t1: float) -> np.ndarray:
    """Upper bound of each component, m/s², ``(dim,)``.

    Raises:
        PluginFault: it is not an array of this shape, or below 0, or not finite.
    """
    found = force.largest(_read_only(lower), _read_only(upper), t0, t1)
    require_array(force, "largest", found, lower.shape)
    if not (np.isfinite(found).all() and (found >= 0).all()):
        raise PluginFault(force, f"gave {found.tolist()} as largest; it must be finite and at least 0")
    return found


def settles(force: BodyForce) -> float:
    """Time, s, from which on the force is constant; raises PluginFault if it is not a number."""
    found = require_number(force, "settles", force.settles())
    if np.isnan(found):
        raise PluginFault(force, "gave nan as settles; it must be a time, or infinite")
    return found


def shortest_period(force: BodyForce) -> float:
    """Shortest period, s; raises PluginFault if it is not above 0."""
    found = require_number(force, "shortest_period", force.shortest_period())
    if not found > 0:
        raise PluginFault(force, f"gave {found:g} as shortest_period; it must be above 0")
    return found


def _read_only(array: np.ndarray) -> np.ndarray:
    view = array.view()
    view.flags.writeable = False
    return view
