"""The sources of a case: their consistency with the scene, and the columns that they add to its history."""

from __future__ import annotations

import math

import numpy as np

from ..contracts import Mouth
from ..geometry.section import Section, section
from ..output.variables import Variable
from ..registry import audit
from ..registry.blame import blaming_plugins
from .allowed import shown
from .model import Case
from .walls import NAME
from .whole_cells import WHOLE

FASTEST = 0.5
"""Largest speed of a column over the sound speed of its material."""
TIMES = 2000
"""Times of a run at which the place of a mouth is checked."""
THINNEST = 0.5
"""Least width of a mouth, in spacings of the particles."""
ROUNDING = 0.25
"""How deep in a wall a particle at the mouth may be, relative to its half-width along the normal."""


def source_columns(case: Case) -> list[Variable]:
    """Mass brought in by all sources, and mass and rate of each."""
    if not case.sources:
        return []
    of_sources = {"dimension": "source", "labels": tuple(case.sources)}
    return [
        Variable("mass_in", "kg", "mass that has come in through all sources"),
        Variable("source_mass", "kg", "mass that has come in through the source", **of_sources),  # type: ignore[arg-type]
        Variable("source_rate", "kg/s", "rate at which mass comes in", **of_sources),  # type: ignore[arg-type]
    ]


def section_of(case: Case, name: str) -> Section:
    """The particles across the mouth of a source, at the start."""
    one = case.sources[name]
    spacing = case.grid.cell_size / np.array(one.particles_along_axes(case.space_.dim), dtype=float)
    return section(case.mouths[name], case.space_, spacing, case.domain_bounds)


def row_length(case: Case, name: str) -> float:
    """Length h of a row of the column of a source, m.

    About the spacing of the particles; if the source ends, a whole number of rows comes in.
    """
    one, area, density = case.sources[name], case.mouth_area(name), case.sources[name].material.density
    spacing = case.grid.cell_size / one.particles_along_axes(case.space_.dim)[case.mouths[name].axis]
    _, ends = one.source.spell(area, density)
    if math.isinf(ends):
        return spacing
    length = one.source.pushed(ends, area, density)
    return length / max(1, round(length / spacing))


def check_mouths(case: Case) -> None:
    """Raise ValueError with one sentence for the first source whose section does not fit into the scene.

    Raises:
        PluginStop: a source is at fault.
    """
    for name, one in case.sources.items():
        if not NAME.fullmatch(name):
            raise ValueError(
                f"sources has the name {shown(name)}; it must be of letters, digits, '_' and '-'"
            )
        where = f"sources.{name}"
        if not one.material.constitutive_law.uses_equation_of_state:
            raise ValueError(
                f"{where}.material.law is '{one.material.law}', a solid; a source brings in fluids only"
            )
        with blaming_plugins([("source", one.source)]):
            problem = one.source.problem(case.space_, case.domain_bounds)
            if problem is not None:
                raise ValueError(f"{where}: {problem}")
            _check_section(where, name, case)


def _check_section(where: str, name: str, case: Case) -> None:
    mouth, (lower, upper), cell = case.mouths[name], case.domain_bounds, case.grid.cell_size
    centre, half, axes = np.array(mouth.centre), np.array(mouth.half_width), case.space_.axes
    spacing = cell / np.array(case.sources[name].particles_along_axes(case.space_.dim))
    for a, axis in enumerate(axes):
        low, high = centre[a] - half[a], centre[a] + half[a]
        cut = [case.grid.faces.get(f"{axis}_{side}") == "symmetry" for side in ("min", "max")]
        cut[0] |= case.space_.radial and a == 0
        below = low < lower[a] - WHOLE * cell and not (cut[0] and a != mouth.axis)
        above = high > upper[a] + WHOLE * cell and not (cut[1] and a != mouth.axis)
        if below or above:
            raise ValueError(
                f"{where}: its section reaches {axis} = {low if below else high:.9g} m, outside the grid, "
                f"whose domain along {axis} is [{lower[a]:.9g}, {upper[a]:.9g}] m"
            )
        inside = min(high, upper[a]) - max(low, lower[a])
        if a != mouth.axis and inside < THINNEST * spacing[a]:
            raise ValueError(
                f"{where}: its section is {inside:.4g} m wide along {axis}; it must be at least "
                f"{THINNEST * spacing[a]:.4g} m, half the spacing of its particles"
            )
    axis, place = axes[mouth.axis], centre[mouth.axis]
    ahead = (upper if mouth.sign > 0 else lower)[mouth.axis]
    if (ahead - place) * mouth.sign < cell:
        raise ValueError(
            f"{where}: its section at {axis} = {place:.9g} m has less than a cell before it; material comes "
            f"in {'along' if mouth.sign > 0 else 'against'} {axis}, and the domain ends at {ahead:.9g} m"
        )
    side, end = ("min", lower) if mouth.sign > 0 else ("max", upper)
    face = case.grid.faces.get(f"{axis}_{side}", "open")
    if abs(place - end[mouth.axis]) < cell and face != "open":
        raise ValueError(
            f"{where}: its section is at the face {axis}_{side}, which is {shown(face)}; the face must be "
            "'open', or the section at least a cell inside the domain"
        )


def check_inflows(case: Case) -> None:
    """Raise ValueError with one sentence for the first source whose column does not fit into the scene.

    Raises:
        PluginStop: a plug-in is at fault.
    """
    for name, one in case.sources.items():
        where = f"sources.{name}"
        with blaming_plugins([("source", one.source)]):
            fastest, sound = case.source_speed(name, 0.0, case.end), case.sound_speed(one.material)
            assert sound is not None
            if not fastest <= FASTEST * sound:
                raise ValueError(
                    f"{where}: material comes in at up to {fastest:.4g} m/s; it must be at most {FASTEST:g} "
                    f"of the sound speed, which is {sound:.4g} m/s: use a larger section, a lower rate, or a "
                    f"larger {where}.material.sound_speed"
                )
            _check_path(where, name, case)
        _check_overlaps(where, name, case)


def _check_path(where: str, name: str, case: Case) -> None:
    """Refuse a mouth that moves out of the domain."""
    one, mouth, (lower, upper) = case.sources[name], case.mouths[name], case.domain_bounds
    centre, half = np.array(mouth.centre), np.array(mouth.half_width)
    tolerance = WHOLE * case.grid.cell_size
    begins, ends = one.source.spell(case.mouth_area(name), one.material.density)
    for time in np.linspace(begins, min(ends, max(case.end, begins)), TIMES):
        moved = np.broadcast_to(one.source.moved(float(time)), centre.shape)
        if not moved.any():
            continue
        low, high = centre + moved - half, centre + moved + half
        for a, axis in enumerate(case.space_.axes):
            if plane := _cut_by(mouth, a, case):
                if abs(moved[a]) > tolerance:
                    raise ValueError(
                        f"{where}: the plane of symmetry {plane} cuts its mouth, which moves along {axis} at "
                        f"t = {time:.4g} s; it must stay on the plane"
                    )
                continue
            if low[a] < lower[a] - tolerance or high[a] > upper[a] + tolerance:
                out = low[a] if low[a] < lower[a] - tolerance else high[a]
                raise ValueError(
                    f"{where}: at t = {time:.4g} s its mouth reaches {axis} = {out:.6g} m, outside the grid, "
                    f"whose domain along {axis} is [{lower[a]:.9g}, {upper[a]:.9g}] m"
                )


def _cut_by(mouth: Mouth, a: int, case: Case) -> str | None:
    """The plane of symmetry across an axis that cuts a mouth at the start, if any."""
    axis, tolerance = case.space_.axes[a], WHOLE * case.grid.cell_size
    for side, beyond in (
        ("min", case.domain_bounds[0][a] - mouth.centre[a] + mouth.half_width[a]),
        ("max", mouth.centre[a] + mouth.half_width[a] - case.domain_bounds[1][a]),
    ):
        if beyond > tolerance and case.grid.faces.get(f"{axis}_{side}") == "symmetry":
            return f"{axis}_{side}"
    return None


def _check_overlaps(where: str, name: str, case: Case) -> None:
    """Refuse a column that comes out of a body or out of a wall."""
    mouth, row = case.mouths[name], section_of(case, name)
    behind = row.position.copy()
    behind[:, mouth.axis] -= mouth.sign * row_length(case, name) / 2
    for number, body in enumerate(case.bodies):
        if body.shape.contains(behind, case.space_).any():
            raise ValueError(
                f"{where}: its section is in bodies.{number}.shape, which fills the place that its material "
                "comes from; a source may touch a body but not overlap it"
            )
    begins, _ = case.sources[name].source.spell(case.mouth_area(name), case.sources[name].material.density)
    with blaming_plugins([("surface", wall.surface) for wall in case.walls.values()]):
        for wall_name, wall in case.walls.items():
            surface = audit.placed(wall.surface, case.space_)
            if not surface.present(begins):
                continue
            distance, normal = surface.distance(row.position, begins)
            half = (np.abs(normal) * row.width / 2).sum(axis=1)
            if (distance < -ROUNDING * half - WHOLE * case.grid.cell_size).any():
                raise ValueError(
                    f"{where}: its section overlaps the wall '{wall_name}', by up to {-distance.min():.3g} m "
                    f"at t = {begins:.4g} s; a source may touch a wall but not overlap it"
                )
