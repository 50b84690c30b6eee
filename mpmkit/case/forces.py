"""The forces of a case: their names, their consistency with space and faces, and their columns."""

from __future__ import annotations

from itertools import product

import numpy as np

from ..contracts import BodyForce
from ..output.variables import Variable
from ..registry.audit import forces
from ..registry.blame import blaming_plugins
from .allowed import shown
from .model import Case
from .walls import NAME

TIMES = 33
"""Times in a run at which the symmetry of a force is checked, beside the bound of it at rest."""
ROUNDING = 1e-9
"""Part of the largest acceleration that counts as none."""


def force_columns(case: Case) -> list[Variable]:
    """Work and power of each force that is not constant."""
    if not case.varying_forces:
        return []
    of_forces = {"dimension": "force", "labels": tuple(case.varying_forces)}
    return [
        Variable("force_work", "J", "work of the force on the material so far", **of_forces),  # type: ignore[arg-type]
        Variable("force_power", "W", "power of the force", **of_forces),  # type: ignore[arg-type]
    ]


def check_forces(case: Case) -> None:
    """Raise ValueError with one sentence for the first force that the space cannot have, and for two
    gravities.

    Raises:
        PluginStop: a force is at fault.
    """
    for name, force in case.forces.items():
        if not NAME.fullmatch(name):
            raise ValueError(f"forces has the name {shown(name)}; it must be of letters, digits, '_' and '-'")
        with blaming_plugins([("body_force", force)]):
            problem = force.problem(case.space_)
        if problem is not None:
            raise ValueError(f"forces.{name}: {problem}")
        if force.is_gravity and any(case.gravity or ()):
            raise ValueError(
                f"gravity is {case.gravity}, and forces.{name} of the kind '{force.name}' stands for gravity "
                "too; leave out gravity"
            )
    with blaming_plugins([("body_force", force) for force in case.forces.values()]):
        gravity = case.gravity_vector
    if case.space_.radial and gravity[0] != 0:
        raise ValueError(f"gravity is {gravity.tolist()}; along r it must be 0 in an axisymmetric scene")


def check_symmetry_of_forces(case: Case) -> None:
    """Raise ValueError for the first force that planes of symmetry, periodic faces or the axis do not allow.

    Raises:
        PluginStop: a force is at fault.
    """
    for name, force in case.varying_forces.items():
        with blaming_plugins([("body_force", force)]):
            for face in case.space_.faces:
                mirror = case.grid.faces.get(face) == "symmetry"
                if (mirror or (case.space_.radial and face == "r_min")) and _crosses(force, face, case):
                    _refuse(name, face, case)
            for axis in case.space_.axes:
                if case.grid.faces.get(f"{axis}_min") == "periodic" and not _repeats(force, axis, case):
                    raise ValueError(
                        f"forces.{name} is not the same at {axis}_min and {axis}_max, which are periodic"
                    )
            _ = case.largest_forces  # known from here on


def _refuse(name: str, face: str, case: Case) -> None:
    if case.space_.radial and face == "r_min":
        raise ValueError(
            f"forces.{name} has a part along r on the axis of symmetry; in an axisymmetric scene a force "
            "must act along the axis there: take the space 3d"
        )
    raise ValueError(
        f"forces.{name} accelerates material across {face}, a plane of symmetry, so that the scene is not "
        f"symmetric: model the whole body, or let grid.faces.{face} be 'slip' if it is a wall"
    )


def _face(face: str, case: Case) -> tuple[int, np.ndarray, np.ndarray]:
    """Axis, and lower and upper corner, m, of a face."""
    lower, upper = (corner.copy() for corner in case.domain_bounds)
    axis = case.space_.axes.index(face[0])
    lower[axis] = upper[axis] = (lower if face.endswith("min") else upper)[axis]
    return axis, lower, upper


def _samples(force: BodyForce, face: str, case: Case) -> tuple[np.ndarray, int]:
    """Accelerations, m/s², (times, places, dim), on a face for material that moves along it; the axis."""
    axis, lower, upper = _face(face, case)
    parts = np.array(list(product((0.0, 0.5, 1.0), repeat=len(lower))))
    places, speeds = lower + parts * (upper - lower), 2 * parts - 1
    speeds[:, axis] = 0.0
    times = np.linspace(0.0, case.end, TIMES)
    return np.array([forces.acceleration(force, places, speeds, t) for t in times]), axis


def _crosses(force: BodyForce, face: str, case: Case) -> bool:
    """Whether it accelerates material at a face across it."""
    axis, lower, upper = _face(face, case)
    bound = forces.largest(force, lower, upper, 0.0, case.end)
    found, _ = _samples(force, face, case)
    most = max(float(np.abs(found).max()), float(bound.max()))
    return bool(max(bound[axis], np.abs(found[..., axis]).max()) > ROUNDING * most)


def _repeats(force: BodyForce, axis: str, case: Case) -> bool:
    """Whether it is the same on both faces of an axis."""
    low, high = (_samples(force, f"{axis}_{side}", case)[0] for side in ("min", "max"))
    return bool(np.abs(low - high).max() <= ROUNDING * max(np.abs(low).max(), np.abs(high).max()))
