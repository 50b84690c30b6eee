"""A vertical section through the material of a frame, as rectangles in the plane of the picture."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

from ..output import read_frame
from ..spaces import SPACES
from .domain import Domain, columns, inside, symmetry_plane
from .run_results import RunResults

NEEDED = ("position", "half_size", "body")
"""Fields of a frame that a picture needs, besides the field of the colours."""


@dataclass(frozen=True)
class Section:
    """The particle domains cut by a vertical plane; lengths along (horizontal, vertical)."""

    centre: np.ndarray
    """``(n, 2)``, m."""
    half_size: np.ndarray
    """``(n, 2)``, m."""
    value: np.ndarray
    """``(n,)``, the field of the colours, such as the speed, m/s."""
    body: np.ndarray
    """``(n,)``, number of the body."""

    def __len__(self) -> int:
        return len(self.value)

    @property
    def lower(self) -> np.ndarray:
        """Lower corner of a section that is not empty."""
        return (self.centre - self.half_size).min(axis=0)

    @property
    def upper(self) -> np.ndarray:
        """Upper corner of a section that is not empty."""
        return (self.centre + self.half_size).max(axis=0)

    def with_image(self, of: np.ndarray, factor: np.ndarray, shift: np.ndarray) -> Section:
        """This section and, before it, the image factor · x + shift of a part of it."""
        image = Section(self.centre[of] * factor + shift, self.half_size[of], self.value[of], self.body[of])
        joined = {
            f.name: np.concatenate([getattr(image, f.name), getattr(self, f.name)]) for f in fields(self)
        }
        return Section(**joined)


def plane_of(results: RunResults) -> float | None:
    """The y, m, of the section through a 3-D scene; None for one that has no y.

    It is the plane of symmetry, or else the middle of the material at the start. If that plane cuts no
    material, for example between two bodies, it is the plane through the nearest particles.
    """
    if results.case["space"] != "3d":
        return None
    frame = drawable(results.frames[0][1], results)
    y = frame["position"][:, 1]
    plane = symmetry_plane(results, "y")
    if plane is None:
        plane = float(np.average(y, weights=frame["half_size"].prod(axis=1))) if len(y) else 0.0
        plane = round(plane, 9)  # removes rounding errors of sums that cancel
    away = np.abs(y - plane)
    if len(y) and away.min() > results.case["grid"]["cell_size"]:
        return float(y[np.argmin(away)])
    return plane


def section_of(
    path: Path, results: RunResults, plane: float | None, domain: Domain, field: str = "speed"
) -> Section:
    """The section through a frame along y = ``plane``, m, or all of it where that is None.

    ``field`` is the field of the frame for the colours.

    Half a body, cut at its axis or at a plane of symmetry, is drawn whole. Particles that are not finite, or
    have left the domain, are not drawn: a guard has stopped their run. The section may be empty.
    """
    frame = drawable(path, results, field)
    if plane is not None:
        distance = np.abs(frame["position"][:, 1] - plane)
        # Drawn from the farthest to the nearest, so that particles cut by the plane are on top.
        order = np.argsort(-distance)
        drawn = order[distance[order] <= results.case["grid"]["cell_size"]]
        frame = {name: field[drawn] for name, field in frame.items()}
    plane_axes = [0, SPACES[results.case["space"]].dim - 1]  # the horizontal and the vertical
    centre, half_size = frame["position"][:, plane_axes], frame["half_size"][:, plane_axes]
    section = Section(centre, half_size, frame[field], frame["body"])
    everything = np.ones(len(section), dtype=bool)
    if domain.mirror is not None:
        section = section.with_image(everything, np.array([-1, 1]), np.array([2 * domain.mirror, 0]))
    return section


def lengths_of(path: Path, results: RunResults) -> dict[str, float]:
    """Spread diameter and height, m, of the material in a frame, as far as the scene has them.

    They are those of the history (``solver.measures``), which need not have a row at this time.
    """
    frame = drawable(path, results)
    if not len(frame["position"]):
        return {}
    (*horizontal, vertical), column = SPACES[results.case["space"]].axes, columns(results)
    diameters = []
    for axis in horizontal:
        if results.case["grid"].get("faces", {}).get(f"{axis}_min") == "periodic":
            continue
        lowest, highest = _ends(frame, results, axis, column[axis])
        plane = 0.0 if axis == "r" else symmetry_plane(results, axis)
        diameters.append(highest - lowest if plane is None else 2 * max(highest - plane, plane - lowest))
    found = {} if not diameters else {"spread": float(np.mean(diameters))}
    floor = results.case["grid"]["domain"][vertical][0]
    return found | {"height": _ends(frame, results, vertical, column[vertical])[1] - floor}


def _ends(frame: dict[str, np.ndarray], results: RunResults, axis: str, column: int) -> tuple[float, float]:
    """Lowest and highest place, m, that the boxes of a frame reach along an axis, within the domain."""
    low, high = results.case["grid"]["domain"][axis]
    position, half_size = frame["position"][:, column], frame["half_size"][:, column]
    return max(float((position - half_size).min()), low), min(float((position + half_size).max()), high)


def drawable(path: Path, results: RunResults, field: str = "speed") -> dict[str, np.ndarray]:
    """The fields of a frame that a picture needs, of the particles that can be drawn.

    The ends of a box longer than a cell contain no material: the box is drawn one cell long, as in the
    measured lengths.
    """
    needed = (*NEEDED, field)
    frame = {name: values for name, values in read_frame(path).items() if name in needed}
    kept = inside(results, frame["position"]) & np.isfinite(frame[field])
    kept &= np.isfinite(frame["half_size"]).all(axis=1)
    frame = {name: field[kept] for name, field in frame.items()}
    frame["half_size"] = np.minimum(frame["half_size"], results.case["grid"]["cell_size"] / 2)
    return frame
