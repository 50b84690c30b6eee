"""What every diagnostic and every particle field must do: measure what it declares, and change nothing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from ..case.diagnostics import columns_of
from ..contracts import Diagnostic, ParticleField
from ..registry.audit import require_array, require_number
from ..solver.observation import Observation
from ..solver.simulation import Simulation
from ..spaces import SPACES, Space
from .scenes import block, shake, simulate
from .violation import require, require_all, require_close, require_same
from .volumetric import OIL

STEPS = 10
CLOSE = 1e-9
"""Part of a number that the order of particles may change, by rounding."""


@lru_cache
def in_motion(space: str) -> Simulation:
    """A block of oil on a floor, z_min, that has been shaken a while ago."""
    lower, upper, domain = block(space, corner=1)
    lower[-1], upper[-1] = 0, 4
    faces = {"z_min": "slip"}
    simulation = simulate(space, {}, [(lower, upper, OIL, None)], domain, faces)
    shake(simulation)
    for _ in range(STEPS):
        simulation.advance()
    return simulation


class Permuted:
    """The scene of an observation with its particles in another order."""

    def __init__(self, observed: Observation, order: np.ndarray) -> None:
        self._observed, self._order = observed, order

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._observed, name)
        return found[self._order] if isinstance(found, np.ndarray) else found

    def state(self, name: str) -> np.ndarray:
        return self._observed.state(name)[self._order]

    def wall_distance(self, name: str) -> np.ndarray:
        return self._observed.wall_distance(name)[self._order]


def at_home(diagnostic: Diagnostic) -> list[Space]:
    """The spaces in which it can be measured, with the faces of the grid as walls."""
    return [space for space in SPACES.values() if diagnostic.problem(space, space.faces) is None]


def home(diagnostic: Diagnostic) -> None:
    """At least one space can hold it; of the others it says why not, in a sentence."""
    said = [diagnostic.problem(space, space.faces) for space in SPACES.values()]
    require(None in said, f"no space can hold it: {'; '.join(map(str, said))}")
    for why in said:
        require(why is None or bool(why.strip()), "its problem is an empty text; it must be a sentence")


def declares(diagnostic: Diagnostic, space: Space) -> None:
    """Columns with names, units and descriptions, always the same."""
    columns = columns_of(diagnostic, space)
    require(bool(columns), "it has no columns")
    for column in columns:
        require(
            bool(column.unit and column.long_name), f"its column '{column.name}' has no unit or long_name"
        )
    require(columns == columns_of(diagnostic, space), "its columns are others when they are asked for again")


def numbers(diagnostic: Diagnostic, space: Space) -> None:
    """A number for each column, and for no other; no array of the scene is changed."""
    measured(diagnostic, space, Observation(in_motion(space.name)))


def measured(diagnostic: Diagnostic, space: Space, scene: Any) -> np.ndarray:
    """What it measures, in the order of its columns."""
    found = _called(diagnostic.measure, scene)
    names = [column.name for column in columns_of(diagnostic, space)]
    require(
        isinstance(found, Mapping) and set(found) == set(names),
        f"measure returned {found!r}; it must be a number for each of {', '.join(names)}",
    )
    values = np.array([require_number(diagnostic, name, found[name]) for name in names])
    require_all(~np.isinf(values), lambda i: f"{names[i]} is infinite")
    return values


def remembers_nothing(diagnostic: Diagnostic, space: Space) -> None:
    """The same scene gives the same numbers, to the bit, at every call."""
    scene = Observation(in_motion(space.name))
    first, again = (measured(diagnostic, space, scene) for _ in range(2))
    require_same(np.nan_to_num(again), np.nan_to_num(first), lambda i: f"column {i}, measured again,")


def particle_order(diagnostic: Diagnostic, space: Space) -> None:
    """In what order the particles lie makes no difference but rounding."""
    scene = Observation(in_motion(space.name))
    order = np.random.default_rng(1).permutation(len(scene.number))
    first, other = (measured(diagnostic, space, s) for s in (scene, Permuted(scene, order)))
    names = [column.name for column in columns_of(diagnostic, space)]
    for values in (first, other):
        values[np.isnan(values)] = 0.0
    scale = CLOSE * np.maximum(np.abs(first), 1e-6)
    require_close(other, first, scale, lambda i: f"{names[i]} of the particles in another order")


def _called(method: Callable[[Any], Any], scene: Any) -> Any:
    """What a method returns for a scene whose arrays it must not write to."""
    try:
        return method(scene)
    except ValueError as error:
        require("read-only" not in str(error), f"{method.__name__} writes to the scene, which it must not")
        raise


def values(field: ParticleField, scene: Any) -> np.ndarray:
    """The field, if it is one."""
    found = _called(field.values, scene)
    require_array(field, "values", found, (len(scene.number), *field.shape))
    require_all(~np.isinf(found), lambda p, *at: f"the field of particle {scene.number[p]} is infinite")
    return found


def arrays(space: str, field: ParticleField) -> None:
    """An array of numbers with an entry for each particle; no array of the scene is changed."""
    values(field, Observation(in_motion(space)))


def each_for_itself(space: str, field: ParticleField) -> None:
    """Particles do not know each other: in another order, each gets the same to the bit."""
    scene = Observation(in_motion(space))
    order = np.random.default_rng(1).permutation(len(scene.number))
    whole, other = values(field, scene), values(field, Permuted(scene, order))
    require_same(
        np.nan_to_num(other),
        np.nan_to_num(whole[order]),
        lambda p, *at: "the field of a particle that is handed over in another order",
    )
