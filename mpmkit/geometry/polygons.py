"""Common parts of the readers of mesh files."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np


class Unusable(ValueError):
    """Why a file cannot be used; completes the sentence "the mesh's file is …, but …"."""


def fans(polygons: Iterable[np.ndarray]) -> np.ndarray:
    """Triangles (t, 3) of blocks of polygons with equally many corners, (n, k) each; triangles come first."""
    blocks = sorted((np.asarray(block, dtype=np.int64) for block in polygons), key=lambda b: b.shape[1] > 3)
    triangles = [block[:, [0, i, i + 1]] for block in blocks for i in range(1, block.shape[1] - 1)]
    return np.concatenate([np.empty((0, 3), dtype=np.int64), *triangles])
