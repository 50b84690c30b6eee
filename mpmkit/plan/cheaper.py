"""Cheaper models of the same scene: each is a few changes of the case."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from ..case import parse_case
from ..case.model import Case
from ..case.overrides import assign
from ..contracts.elastoviscoplastic import ElastoviscoplasticLaw
from ..errors import CaseError, PluginStop
from ..registry import installed
from ..rheology.refit import with_law
from .symmetric_walls import are_turned
from .symmetry import axis_of_revolution, planes_of_symmetry

CELLS_HIGH = (30, 15)
"""Height of the scene in cells, for coarser models: values of the shipped study, with known errors."""
FACTOR, MACH = 10.0, 0.1
"""Sound speeds of the shipped study: a multiple of √(2 g h), and a constant Mach number."""
COARSER = 1.25
"""A coarser model is listed only if its cells are wider by this factor."""

VECTORS = ("base", "centre", "point", "normal", "velocity", "amplitude", "positions")
"""Fields of surfaces, of their shapes and motions, that have a component for each axis."""

Changes = dict[str, Any]


@dataclass(frozen=True)
class Cheaper:
    """A cheaper model of a case."""

    name: str
    why: str
    """the reason why it is allowed"""
    changes: Changes
    """new values by their paths in the case, as ``--set`` takes them"""
    case: Case

    @property
    def options(self) -> list[str]:
        """The changes as command line options."""
        return [
            f"{path}={value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)}"
            for path, value in self.changes.items()
        ]


def cheaper_models(case: Case) -> list[Cheaper]:
    """Each allowed change alone, and the cheapest changes of all kinds together."""
    found: list[Cheaper] = []
    chosen: list[Cheaper] = []
    together = case
    for kind in (_spaces, _cells, _sounds, _laws):
        found.extend(_models(case, kind))
        last = list(_models(together, kind))[-1:]
        chosen += last
        together = last[0].case if last else together
    if len(chosen) > 1:
        changes: Changes = {}
        for model in chosen:
            kept = {path: value for path, value in changes.items() if not _within(path, model.changes)}
            changes = kept | model.changes
        found.append(Cheaper("all of these", " + ".join(model.name for model in chosen), changes, together))
    return found


def _within(path: str, changes: Changes) -> bool:
    """Whether another change replaces a change."""
    return any(path == other or path.startswith(f"{other}.") for other in changes)


def _models(case: Case, kind: Callable[[Case], Iterator[tuple[str, str, Changes]]]) -> Iterator[Cheaper]:
    """The models of one kind, the cheapest last."""
    for name, why, changes in kind(case):
        data = copy.deepcopy(case.model_dump(mode="json", exclude_unset=True))
        for path, value in changes.items():
            assign(data, path, value)
        try:
            model = parse_case(data)
        except (
            CaseError,
            PluginStop,
        ):  # the change does not fit the rest of the case, e.g. an output along y
            continue
        axis = axis_of_revolution(case) if model.space != case.space else None
        if axis is None or are_turned(case, model, axis):
            yield Cheaper(name, why, changes, model)


def _spaces(case: Case) -> Iterator[tuple[str, str, Changes]]:
    dx, faces = case.grid.cell_size, dict(case.model_dump(mode="json")["grid"]["faces"])
    planes, axis = planes_of_symmetry(case), axis_of_revolution(case)
    if planes is not None:
        domain = dict(case.grid.domain)
        for name, place in zip("xy", planes, strict=True):
            domain[name] = _whole(place, domain[name][1], dx)
            faces[f"{name}_min"] = "symmetry"
        changes = {"grid.domain": domain, "grid.faces": faces}
        yield "a quarter", "two vertical planes cut the scene into equal quarters", changes
    if axis is None:
        return
    reach = max(
        abs(end - place) for name, place in zip("xy", axis, strict=True) for end in case.grid.domain[name]
    )
    upright = {side: face for side, face in faces.items() if side.startswith("z")}
    turned: Changes = {
        "space": "axisymmetric",
        "grid.domain": {"r": _whole(0.0, reach, dx), "z": case.grid.domain["z"]},
        "grid.faces": upright,
    }
    if case.gravity is not None:
        turned["gravity"] = [0.0, case.gravity[-1]]
    for index, body in enumerate(case.bodies):
        turned |= {f"bodies.{index}.{path}": value for path, value in _turned(body).items()}
    for name, wall in case.model_dump(mode="json", exclude_unset=True).get("walls", {}).items():
        turned[f"walls.{name}.surface"] = _half_plane(wall["surface"])
    yield "axisymmetric", "all bodies turn about one vertical axis", turned


def _turned(body: Any) -> Changes:
    """A body of revolution in the half plane."""
    changes: Changes = {}
    for name in ("base", "centre"):
        if getattr(body.shape, name, None) is not None:
            changes[f"shape.{name}"] = [0.0, getattr(body.shape, name)[-1]]
    count = body.particles_per_cell
    if isinstance(count, list):
        changes["particles_per_cell"] = [count[0], count[-1]]
    elif count is not None:
        changes["particles_per_cell"] = round(count ** (1 / 3)) ** 2
    if isinstance(body.velocity, list):
        changes["velocity"] = [0.0, body.velocity[-1]]
    return changes


def _half_plane(surface: Any, vector: bool = False) -> Any:
    """A surface in the half plane: of its vectors, in fields of these names, the z component is kept.

    ``are_turned`` checks whether it is then the same wall.
    """
    if isinstance(surface, dict):
        return {key: _half_plane(part, key in VECTORS) for key, part in surface.items()}
    if not isinstance(surface, list) or not vector:
        return surface
    if any(isinstance(part, list) for part in surface):
        return [_half_plane(part, vector) for part in surface]
    return [0.0, surface[-1]]


def _cells(case: Case) -> Iterator[tuple[str, str, Changes]]:
    for cells in CELLS_HIGH:
        dx = float(f"{case.height / cells:.4g}")
        if dx > COARSER * case.grid.cell_size:
            domain = {axis: _whole(ends[0], ends[1], dx) for axis, ends in case.grid.domain.items()}
            changes = {"grid.cell_size": dx, "grid.domain": domain}
            yield f"cells of {1e3 * dx:.3g} mm", f"the scene is still {cells} cells high", changes


def _sounds(case: Case) -> Iterator[tuple[str, str, Changes]]:
    fluids = {
        path: case.sound_speed(material)
        for path, material in case.materials.items()
        if material.constitutive_law.uses_equation_of_state
    }
    falls = math.sqrt(2 * case.largest_energy)
    laws = (material.constitutive_law for material in case.materials.values())
    if falls == 0 or any(law.needs_deformation_gradient for law in laws):
        return
    of_height = FACTOR * math.sqrt(2 * math.hypot(*case.gravity_vector) * case.height)
    faster = [path for path, speed in fluids.items() if speed is not None and speed > 1.05 * of_height]
    if faster and falls <= of_height / FACTOR:
        changes = {f"{path}.sound_speed": {"factor": FACTOR} for path in faster}
        yield f"c = {FACTOR:g} √(2 g h)", "at a Mach number of at most 0.1", changes
    followed = [m for m in case.materials.values() if getattr(m.sound_speed, "mach", 0) >= MACH]
    if fluids and not followed:
        changes = {f"{path}.sound_speed": {"mach": MACH} for path in fluids}
        yield f"Mach {MACH:g}", "the sound speed follows the flow, and the steps grow as it slows", changes


def _laws(case: Case) -> Iterator[tuple[str, str, Changes]]:
    registry = installed()
    changes: Changes = {}
    for path, material in case.materials.items():
        exact = material.constitutive_law.exact_form
        if exact is not None and issubclass(
            registry.of_kind("law").get(exact, object), ElastoviscoplasticLaw
        ):
            given = material.model_dump(mode="json", exclude_unset=True)
            changes[path] = with_law(given, exact, registry)[0]
    if changes:
        if "viscous" in case.scheme.time_step.ignore:
            changes["scheme.time_step.ignore"] = [x for x in case.scheme.time_step.ignore if x != "viscous"]
        yield "exact yield", "the same flow curve, without a viscous limit, and it comes to rest", changes


def _whole(lower: float, upper: float, dx: float) -> list[float]:
    """An interval of a whole number of cells, not shorter than the given one."""
    cells = math.ceil((upper - lower) / dx - 1e-6)
    return [lower, float(f"{lower + cells * dx:.10g}")]
