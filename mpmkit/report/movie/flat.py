"""Pictures of a scene in a plane: axisymmetric ones are shown whole, both sides of the axis."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ..domain import domain_of
from ..outline import AROUND, AROUND_WALLS, add_section, limits
from ..run_results import RunResults
from ..section import section_of
from ..style import BLACK, MILLIMETRES
from ..wall_lines import draw_walls, legend_handles, looks, wall_lines
from .picture import add_scale, add_title, empty_picture, pixels
from .quantities import Quantity, scale_of


def flat_pictures(
    results: RunResults, frames: Sequence[tuple[float, Path]], quantity: Quantity
) -> Iterator[np.ndarray]:
    """One picture a frame, RGB bytes, all of the same limits, size and scale."""
    domain = domain_of(results)
    sections = [section_of(path, results, None, domain, quantity.field) for _, path in frames]
    walls = list(results.case.get("walls") or ())
    look = looks(walls, walls)
    filled = [section for section in sections if len(section)]
    lower, upper = limits(filled, domain, AROUND_WALLS if walls else AROUND)
    scale = scale_of(quantity, [section.value for section in sections])
    horizontal = "r" if results.case["space"] == "axisymmetric" else "x"
    for (time, _), section in zip(frames, sections, strict=True):
        figure, axes = empty_picture(upper - lower)
        axes.grid(False)
        add_section(axes, section, scale.norm, domain, results.case["grid"]["cell_size"], scale.colour_map)
        draw_walls(axes, wall_lines(results, time, None, domain), look)
        if domain.floor is not None:
            axes.axhline(domain.floor * MILLIMETRES, color=BLACK, linewidth=1.5)
        axes.set_xlim(lower[0] * MILLIMETRES, upper[0] * MILLIMETRES)
        axes.set_ylim(lower[1] * MILLIMETRES, upper[1] * MILLIMETRES)
        axes.set_xlabel(f"{horizontal} (mm)")
        axes.set_ylabel("z (mm)")
        if walls:
            axes.legend(handles=legend_handles(look, set(walls)), loc="upper right", fontsize=8)
        add_title(figure, results.title, f"t = {time:.3f} s")
        add_scale(figure, quantity, scale)
        yield pixels(figure)
