"""From a run directory to a movie."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from ...errors import CaseError
from ...output import read_frame
from ..run_results import RunResults, read_results
from ..section import drawable
from ..style import figure_style
from .moments import shown_frames
from .quantities import QUANTITIES, Quantity
from .writers import WRITERS, require_writer


def make_movie(
    directory: Path,
    out: Path,
    fps: float = 10.0,
    colour_by: str = "speed",
    listen: Callable[[int, int], None] | None = None,
) -> Path:
    """Draw the frames of a run and write them as a movie.

    Args:
        directory: of the run.
        out: the file, ``.gif`` or ``.mp4``; replaced if it is there.
        fps: pictures a second.
        colour_by: a name in ``QUANTITIES``.
        listen: called after each picture with its number, from 1, and the number of all.

    Raises:
        CaseError: the directory holds no run, there are too few frames, or the file type is not supported.
        OutputError: it cannot be written.
    """
    require_writer(out)
    results = read_results(directory)
    frames, quantity = shown_frames(results, directory), QUANTITIES[colour_by]
    _require_field(frames[0][1], quantity)
    if not any(len(drawable(path, results, quantity.field)["body"]) for _, path in frames):
        raise CaseError(f"the frames of the run in '{directory}' contain nothing that can be drawn")
    drawn: list[np.ndarray] = []
    with figure_style():
        for picture in _pictures(results, frames, quantity):
            drawn.append(picture)
            if listen is not None:
                listen(len(drawn), len(frames))
    WRITERS[out.suffix.lower()](out, drawn, fps)
    return out


def _require_field(path: Path, quantity: Quantity) -> None:
    there = read_frame(path)
    if quantity.field not in there:
        possible = [name for name, one in QUANTITIES.items() if one.field in there]
        raise CaseError(
            f"the frames have no '{quantity.field}' to colour by; "
            f"they can be coloured by {', '.join(possible)}"
        )


def _pictures(
    results: RunResults, frames: Sequence[tuple[float, Path]], quantity: Quantity
) -> Iterator[np.ndarray]:
    if results.case["space"] == "3d":
        from .solid import solid_pictures

        return solid_pictures(results, frames, quantity)
    from .flat import flat_pictures

    return flat_pictures(results, frames, quantity)
