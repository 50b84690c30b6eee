"""Assumptions of a case, reported before a run: its floor, its walls, and the release of the material."""

from __future__ import annotations

from ..case.ending import ending
from ..case.faces import Face, Stick
from ..case.model import Case
from .lift import lift_start
from .wall_words import wall_sentences

FLOORS = {
    "slip": "free slip, so that it does not hold the material back",
    "symmetry": "a plane of symmetry, which acts like free slip",
    "stick": "stick, so that the material does not slide on it",
}
"""Kinds of faces as a floor, in words."""


def setting(case: Case) -> list[str]:
    """Sentences on the domain, the floor, the release of the material, the walls, and the end."""
    end = ending(case.until)
    return [
        *case.grid.extensions,
        *_floor_and_release(case),
        *wall_sentences(case),
        *_inflows(case),
        *([] if end is None else [end]),
    ]


def _floor_and_release(case: Case) -> list[str]:
    """A scene has a floor if gravity pulls towards a closed face of the vertical axis."""
    pull, axis = float(case.gravity_at_start[-1]), case.space_.axes[-1]
    if pull == 0:
        return []
    name = f"{axis}_{'min' if pull < 0 else 'max'}"
    face = case.grid.faces.get(name, "open")
    if face in ("open", "periodic"):
        return []
    said = [f"floor: {name} is {_in_words(face)}"]
    if not case.bodies or any(map(case.speed_at_start, case.bodies)):
        return said
    if case.walls:
        names = ", ".join(f"walls.{name}" for name in case.walls)
        lifted = lift_start(case)
        later = (
            f", and t500_from_lift from the start of the lift, t = {lifted:.4g} s"
            if lifted is not None and lifted > 0
            else ""
        )
        said.append(
            f"release: from t = 0 on the material is held by {names} alone; T500 counts from t = 0{later}"
        )
    else:
        said.append(
            "release: the material is free from t = 0 on, at once; a T500 measured in a laboratory also "
            "includes the time in which the cone is lifted"
        )
    return said


def _inflows(case: Case) -> list[str]:
    """What comes in by the end of the run, of each source."""
    said = []
    for name, one in case.sources.items():
        area, density = case.mouth_area(name), one.material.density
        mass = density * area * one.source.pushed(case.end, area, density)
        fastest = case.source_speed(name, 0.0, case.end)
        said.append(
            f"sources.{name}: {mass:.4g} kg of {one.material.law} come in by t = {case.end:g} s, through "
            f"{area:.4g} m², at up to {fastest:.4g} m/s"
        )
    return said


def _in_words(face: Face) -> str:
    if isinstance(face, str):
        return FLOORS[face]
    if isinstance(face, Stick):
        return FLOORS["stick"] + (", and releases it where it would have to pull" if face.releases else "")
    return f"friction, with the coefficient {face.coefficient:g}"
