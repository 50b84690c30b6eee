"""Reader of Wavefront OBJ files: only corners and faces."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TextIO

import numpy as np

from .polygons import Unusable, fans


def read_obj(path: str) -> tuple[np.ndarray, np.ndarray]:
    """Corners (v, 3) and triangles (t, 3) of an OBJ file; larger polygons are split into fans.

    An own reader is needed because other readers fail for common files: meshio refuses files with different
    numbers of normals, textures and corners, and meshio and trimesh misread relative indices if corners and
    faces alternate.

    Raises:
        Unusable: a line is not valid, or names a corner that does not exist.
    """
    corners: list[list[float]] = []
    polygons: dict[int, list[list[int]]] = {}
    largest, where = 0, 0
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, words in _lines(file):
            try:
                if words[0] == "v":
                    x, y, z = map(float, words[1:4])
                    corners.append([x, y, z])
                elif words[0] == "f":
                    # "5/1/2" is corner 5, texture 1, normal 2; "-1" is the last corner so far.
                    given = [int(word.split("/")[0]) for word in words[1:]]
                    face = [index - 1 if index > 0 else len(corners) + index for index in given]
                    if len(face) < 3 or 0 in given or min(face) < 0:
                        raise ValueError
                    if max(face) > largest:
                        largest, where = max(face), number
                    polygons.setdefault(len(face), []).append(face)
            except ValueError:
                line = " ".join(words)
                line = line if len(line) <= 40 else line[:37] + "..."
                raise Unusable(
                    f"its line {number} is '{line}'; it must be 'v' and three numbers, or 'f' and three or "
                    f"more indices of corners, from 1 or, backwards, from -1 to -{len(corners)}"
                ) from None
    if largest >= len(corners) and polygons:
        raise Unusable(
            f"its line {where} names corner {largest + 1}, but it has {len(corners)} corners: it is damaged "
            "or truncated"
        )
    return np.array(corners, dtype=float).reshape(-1, 3), fans(map(np.array, polygons.values()))


def _lines(file: TextIO) -> Iterator[tuple[int, list[str]]]:
    """Numbers and words of the lines; one that ends in a backslash goes on in the next."""
    words: list[str] = []
    for number, line in enumerate(file, 1):
        goes_on = line.rstrip().endswith("\\")
        words += line.split("#")[0].replace("\\", " ").split()
        if words and not goes_on:
            yield number, words
            words = []
    if words:
        yield number, words
