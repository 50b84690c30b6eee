"""The walls of a scene for the player: one drawing of each wall, and its position at every moment."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

import numpy as np

from ...case.plugins import plugins_of
from ...errors import MpmkitError
from ...geometry import Motion
from ...output import read_wall_frame
from ...registry import audit
from ...registry.blame import blaming_plugins
from .source import Source

MOST_PARTS = 12_000
"""Approximate largest number of triangles or segments of all drawings on the page."""
LOOKS = 6
"""Number of drawings of a rigid wall among which the most complete one is chosen."""
NOT_THERE = -1


def walls_of(source: Source) -> list[dict[str, Any]]:
    """For each wall its drawings, and for each moment the visible drawing with its rotation and shift."""
    names = dict.fromkeys(name for walls in source.results.walls.values() for name in walls)
    found, most = [], MOST_PARTS // max(1, len(names))
    for name in names:
        files = {time: walls[name] for time, walls in source.results.walls.items() if name in walls}
        shapes, places = _moving(source, name, files, most) or _as_drawn(source, files, most)
        found.append({"name": name, "shapes": shapes, "places": places})
    return found


def _moving(source: Source, name: str, files: dict[float, Path], most: int) -> tuple[list, list] | None:
    """For a wall that uses the framework's motion: one drawing and its positions; None for any other wall."""
    case, dim = source.case, source.space.dim
    wall = None if case is None else case.walls.get(name)
    if case is None or wall is None:
        return None
    motion = getattr(wall.surface, "motion", None)
    if not isinstance(motion, Motion | None):
        return None
    time, points, parts = max(
        ((t, *_drawn(path, dim)) for t, path in _some(files)), key=lambda drawn: len(drawn[2])
    )
    try:
        with blaming_plugins(plugins_of(case)):
            surface = audit.placed(wall.surface, case.space_)
            there = [surface.present(moment.time) for moment in source.moments]
    except MpmkitError:
        return None
    eye, origin = np.eye(dim), np.zeros((1, dim))
    if motion is None:
        poses = [(eye, origin[0])] * len(source.moments)
    else:
        points = motion.back(points, time)
        # From X = Qᵀ x + b follows x = Q (X - b); motion.back of the origin gives b.
        turns = [motion.turned(eye, moment.time).T for moment in source.moments]
        poses = [
            (turn, -turn @ motion.back(origin, moment.time)[0])
            for turn, moment in zip(turns, source.moments, strict=True)
        ]
    places = [_place(0 if seen else NOT_THERE, *pose) for seen, pose in zip(there, poses, strict=True)]
    return [_shape(points, parts, most)], places


def _some(files: dict[float, Path]) -> list[tuple[float, Path]]:
    """A few of the drawings; each file is read once."""
    once = {path: time for time, path in reversed(files.items())}
    listed = [(time, path) for path, time in once.items()]
    return listed[:: max(1, len(listed) // LOOKS)]


def _as_drawn(source: Source, files: dict[float, Path], most: int) -> tuple[list, list]:
    """For any other wall: its drawing at the last frame before each moment."""
    paths = list(dict.fromkeys(files.values()))
    shapes = [_shape(*_drawn(path, source.space.dim), most // len(paths)) for path in paths]
    frames = sorted(source.results.walls)
    eye, origin = np.eye(source.space.dim), np.zeros(source.space.dim)
    places = []
    for moment in source.moments:
        frame = frames[max(0, int(np.searchsorted(frames, moment.time * (1 + 1e-9), side="right")) - 1)]
        path = files.get(frame)
        places.append(_place(NOT_THERE if path is None else paths.index(path), eye, origin))
    return shapes, places


def _drawn(path: Path, dim: int) -> tuple[np.ndarray, np.ndarray]:
    points, parts, _ = read_wall_frame(path)
    return points[:, :dim], parts


def _place(shape: int, turn: np.ndarray, shift: np.ndarray) -> list[float]:
    """Number of the drawing, the matrix by rows, and the shift, m."""
    return [shape, *(float(f"{value:.7g}") for value in (*turn.ravel(), *shift))]


def _shape(points: np.ndarray, parts: np.ndarray, most: int) -> dict[str, str]:
    points, parts = _coarser(points, parts, most)
    return {"points": _text(points, np.float32), "parts": _text(parts, np.uint32)}


def _coarser(points: np.ndarray, parts: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """The drawing with points that are close together merged, until it has few enough parts."""
    extent = np.ptp(points, axis=0).max()
    cells = 256
    while len(parts) > most and cells > 4:
        cell = np.floor((points - points.min(axis=0)) / extent * cells).astype(np.int64)
        _, first, of = np.unique(cell, axis=0, return_index=True, return_inverse=True)
        merged = of.ravel()[parts]
        whole = np.all([merged[:, a] != merged[:, a - 1] for a in range(merged.shape[1])], axis=0)
        points, parts = points[first], np.unique(np.sort(merged[whole], axis=1), axis=0)
        cells //= 2
    return points, parts


def _text(array: np.ndarray, kind: type) -> str:
    plain = np.ascontiguousarray(array, dtype=np.dtype(kind).newbyteorder("<"))
    return base64.b64encode(plain.tobytes()).decode()
