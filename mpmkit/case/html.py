"""The view of a case in a notebook: a table beside a picture."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import Any

from pydantic import BaseModel

from ..contracts import BodyShape
from .ending import ending
from .model import Case
from .picture import picture
from .sound_speed import SoundSpeedFactor, SoundSpeedMach
from .whole_cells import cells_along

BESIDE = '<div style="display: flex; flex-wrap: wrap; gap: 1em; align-items: flex-start">'
TABLE = '<table style="max-width: 44em">'
LEFT = 'style="text-align: left"'


def case_html(case: Case) -> str:
    """The case as HTML. If the picture cannot be drawn, a notebook shows the rest."""
    try:
        drawn = picture(case)
    except Exception:  # e.g. a mesh without the needed packages, or a fault of a plug-in
        drawn = ""
    rows = "".join(
        f"<tr><th {LEFT}>{escape(name)}</th><td {LEFT}>{escape(value)}</td></tr>"
        for name, value in _rows(case)
    )
    about = f"<p>{escape(case.description)}</p>" if case.description else ""
    return f"<div><p><b>{escape(case.name)}</b></p>{about}{BESIDE}{TABLE}{rows}</table>{drawn}</div></div>"


def _rows(case: Case) -> Iterator[tuple[str, str]]:
    yield "space", case.space
    yield "until", ending(case.until) or f"{case.end:g} s"
    cells = " × ".join(f"{round(cells_along(case, axis)):,}" for axis in case.space_.axes)
    yield "grid", f"{cells} cells of {1e3 * case.grid.cell_size:g} mm"
    faces = [f"{name}: {_said(face)}" for name, face in case.grid.faces.items()]
    yield "faces", ", ".join(faces) or "open"
    for number, body in enumerate(case.bodies):
        yield f"bodies.{number}", f"{_shape(body.shape)}, {_material(body.material)}"
    for name, inflow in case.sources.items():
        yield f"sources.{name}", f"{inflow.kind}, {_material(inflow.material)}"
    for name, wall in case.walls.items():
        yield f"walls.{name}", f"{_said(wall.surface)}, {_said(wall.contact)}"
    scheme = case.scheme
    chosen = (scheme.shape, scheme.order, scheme.velocity, scheme.volumetric, scheme.redistribution)
    yield "scheme", ", ".join(_said(one) for one in chosen)
    for sentence in case.grid.extensions:
        yield "note", sentence


def _said(value: Any) -> str:
    """A choice by its name."""
    if isinstance(value, str):
        return value
    return str(getattr(value, "kind", None) or getattr(value, "name", None) or value)


def _shape(shape: BodyShape) -> str:
    """A shape by its name and its lengths."""
    lengths = [f"{name} {value:g} m" for name, value in shape if isinstance(value, float)]
    return f"{shape.name} ({', '.join(lengths)})" if lengths else shape.name


def _material(material: BaseModel) -> str:
    """A law with its parameters and their units; parameters at their defaults are not shown."""
    found = [str(getattr(material, "law", ""))]
    for name, field in type(material).model_fields.items():
        value, extra = getattr(material, name), field.json_schema_extra
        if value is None or not isinstance(extra, dict) or "unit" not in extra:
            continue
        unit = "" if extra["unit"] == "1" else f" {extra['unit']}"
        if isinstance(value, float):
            found.append(f"{name} {value:g}{unit}")
        elif isinstance(value, SoundSpeedFactor):
            found.append(f"{name} {value.factor:g} √(2 g h)")
        elif isinstance(value, SoundSpeedMach):
            found.append(f"{name} at Mach {value.mach:g}")
    return ", ".join(found)
