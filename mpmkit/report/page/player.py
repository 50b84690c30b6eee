"""Section: the player of the flow."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any, NamedTuple

import numpy as np

from ...case.state_variables import LAW, particle_variables
from ...contracts.law import initial_state
from ...errors import GuardStop
from ...output.flow import Moment
from ...registry.blame import blaming_plugins
from ..domain import domain_of, symmetry_plane
from .colour_maps import stops
from .packing import Packed, Scale, packed
from .section import Section, note, paragraph
from .source import Source
from .thinning import Thinned, fitting
from .walls import walls_of
from .words import number, unit_of

NO_WALLS = ("open", "periodic", "symmetry")
"""Conditions of faces that are not walls."""
TRIMMED = 99.5
"""Percentile at the end of a colour scale, so that a single particle does not set the scale."""
WIDE = 300.0
"""A quantity whose largest value is above this multiple of the lowest has a logarithmic scale."""
DECADES = 1e-3
"""Lowest shear rate on the colour scale, relative to the largest."""


class Words(NamedTuple):
    """A quantity for a reader."""

    label: str
    unit: str
    meaning: str


WORDS = {
    "speed": Words("Speed", "m/s", "how fast the material moves"),
    "shear_rate": Words("Shear rate", "1/s", "how fast the material is sheared"),
    "yielded": Words("Yielded zone", "", "the material flows where the stress exceeds the yield stress"),
    "pressure": Words("Pressure", "Pa", "of the material, positive in compression"),
}


def section(source: Source, room: int) -> Section | None:
    """The player, with at most about ``room`` characters of data; None if the run has no data for it."""
    if not source.moments:
        return Section(
            "flow", "Flow", note("This run has no data for the player: set output.report to true.")
        )
    walls = walls_of(source)
    for_walls = sum(len(text) for wall in walls for shape in wall["shapes"] for text in shape.values())
    for_walls += sum(12 * len(place) for wall in walls for place in wall["places"])
    scales = _scales(source)
    words = _words(source, scales)
    longest = _longest(source)

    def pack(moments: Sequence[Moment]) -> Packed:
        return packed(moments, scales, _boxes(source.space.dim), longest)

    thinned = fitting(source.moments, pack, max(room - for_walls, 10_000))
    if len(thinned.moments) < len(source.moments):  # the places of walls are those at the moments
        source = Source(source.results, thinned.moments, source.log, source.case, source.directory)
        walls = walls_of(source)
    data = _scene(source) | {
        "packing": thinned.packed.description,
        "blob": thinned.packed.text,
        "quantities": [_quantity(name, scale, words[name]) for name, scale in scales.items()],
        "walls": walls,
    }
    return Section("flow", "Flow", _controls(source, words) + _said(thinned, source), data)


def _boxes(dim: int) -> np.ndarray:
    """Exponents of the half sides in each stored size: both sides in 2-D, their geometric mean in 3-D."""
    return np.eye(2) if dim == 2 else np.full((1, 3), 1 / 3)


def _longest(source: Source) -> float:
    """Half side of the largest box that is drawn, m; the ends of a longer box contain no material."""
    drawn = max(float(moment.half_size.max()) for moment in source.moments)
    return min(drawn, source.results.case["grid"]["cell_size"] / 2)


def _scales(source: Source) -> dict[str, Scale]:
    moments = source.moments

    def highest(name: str) -> float:
        return max(float(np.percentile(getattr(moment, name), TRIMMED)) for moment in moments)

    scales = {"speed": Scale(0.0, highest("speed") or 1.0)}
    if (most := highest("shear_rate")) > 0:
        scales["shear_rate"] = Scale(DECADES * most, most, logarithmic=True)
    if _can_yield(source):
        scales["yielded"] = Scale(0.0, 1.0)
    for name in ("pressure", *dict.fromkeys(name for moment in moments for name in moment.added)):
        values = np.concatenate([moment.values(name) for moment in moments])
        there = np.isfinite(values)
        if not there.any():
            continue
        low, high = np.percentile(values[there], [100 - TRIMMED, TRIMMED])
        if high > low:
            wide = bool(low > 0 and high > WIDE * low)
            scales[name] = Scale(float(low), float(high), wide, gaps=not there.all())
    return scales


def _words(source: Source, names: Iterable[str]) -> dict[str, Words]:
    """The words for each quantity; those of a state variable are its law's."""
    known = {} if source.case is None else particle_variables(source.case)
    found = {}
    for name in names:
        if name in WORDS:
            found[name] = WORDS[name]
            continue
        label = name.removeprefix(LAW).replace("_", " ").capitalize()
        if name not in known:
            found[name] = Words(label, "", "a field of the particles")
            continue
        found[name] = Words(label, unit_of(known[name].units), known[name].long_name)
    return found


def _can_yield(source: Source) -> bool:
    """Whether a law has a yield point; if the case cannot be read, whether any material is at rest."""
    if source.case is None:
        return not all(moment.yielded.all() for moment in source.moments)
    laws = [body.material.constitutive_law for body in source.case.bodies]
    try:
        with blaming_plugins([("law", law) for law in laws]):
            return any(law.yield_point(initial_state(law, 1)) is not None for law in laws)
    except GuardStop:  # the page is made even if a plug-in fails
        return False


def _quantity(name: str, scale: Scale, words: Words) -> dict[str, Any]:
    meaning = words.meaning
    if scale.logarithmic:
        meaning += "; the scale is logarithmic"
    if scale.gaps:
        meaning += "; grey where it has no value"
    return {
        "name": name,
        "label": words.label,
        "unit": words.unit,
        "meaning": meaning,
        "low": scale.low,
        "high": scale.high,
        "logarithmic": scale.logarithmic,
        "gaps": scale.gaps,
        "colours": stops(name),
    }


def _scene(source: Source) -> dict[str, Any]:
    """The space around the material: faces, planes of symmetry, and the visible part."""
    results, space = source.results, source.space
    grid, axes = results.case["grid"], space.axes
    lower, upper = np.array([grid["domain"][axis] for axis in axes], dtype=float).T
    faces = grid.get("faces", {})
    closed = [
        [faces.get(f"{axis}_{side}", "open") not in NO_WALLS for side in ("min", "max")] for axis in axes
    ]
    mirrors = [0.0 if axis == "r" else symmetry_plane(results, axis) for axis in axes[:-1]]
    periods = [
        float(high - low) if faces.get(f"{axis}_min") == "periodic" else None
        for axis, low, high in zip(axes, lower, upper, strict=True)
    ]
    if space.dim == 2:  # as in the pictures of the report
        domain = domain_of(results)
        assert domain.mirror == mirrors[0]
    low = np.min([(m.position - m.half_size).min(axis=0) for m in source.moments], axis=0).astype(float)
    high = np.max([(m.position + m.half_size).max(axis=0) for m in source.moments], axis=0).astype(float)
    return {
        "space": space.name,
        "axes": ["x" if axis == "r" else axis for axis in axes] if space.dim == 3 else list(axes),
        "domain": {"lower": lower.tolist(), "upper": upper.tolist(), "closed": closed, "periods": periods},
        "mirrors": [*mirrors, None],
        "material": {"lower": np.maximum(low, lower).tolist(), "upper": np.minimum(high, upper).tolist()},
        "cell": grid["cell_size"],
    }


def _controls(source: Source, quantities: dict[str, Words]) -> str:
    choices = "".join(
        f'<label><input type="radio" name="colour" value="{escape(name)}"{" checked" if row == 0 else ""}>'
        f"<span>{escape(words.label)}</span></label>"
        for row, (name, words) in enumerate(quantities.items())
    )
    how = "Drag to turn. To zoom, click and then scroll, or pinch. Arrow keys turn the view; + and − zoom."
    solid = source.space.dim == 3
    stage = "The material in three dimensions" if solid else "Section through the material"
    return (
        f'<div class="player" data-player>'
        f'<fieldset class="choices"><legend>Colour by</legend>{choices}</fieldset>'
        f'<div class="stage" tabindex="0" role="img" aria-label="{stage}"><canvas class="under"></canvas>'
        '<canvas class="material"></canvas>'
        '<canvas class="over"></canvas><output class="reading" aria-live="off"></output></div>'
        '<div class="bar" aria-hidden="true"><canvas></canvas></div><p class="meaning"></p>'
        '<div class="transport"><button type="button" class="play" aria-label="Play">▶</button>'
        '<input type="range" class="time" min="0" max="1000" value="0" step="1" aria-label="Time">'
        '<output class="clock">t = 0 s</output>'
        '<label class="pace">Speed <select aria-label="Speed of playing"></select></label></div>'
        '<noscript><p class="note">The player needs JavaScript.</p></noscript></div>'
        + (note(how) if source.space.dim == 3 else "")
    )


def _said(thinned: Thinned, source: Source) -> str:
    """How much of the run the player shows."""
    moments, share = thinned.moments, min(moment.share for moment in thinned.moments)
    said = (
        f"The player shows {len(moments)} moments of the run; between them, particles move along straight "
        "lines."
    )
    if share < 1:
        said += (
            f" To keep the page small, it draws one in {number(1 / share, 2)} particles, enlarged to fill "
            "the volume of the others; the frames in the directory of the run have all particles."
        )
    if any(plane is not None for plane in _scene(source)["mirrors"]):
        cut = "half of it" if source.space.dim == 2 else "a part of it"
        said += f" The run computes {cut}; the rest is its mirror image."
    return paragraph(said, "note")
