"""The frames of a run as one xarray dataset; a file is read when its values are needed."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from xarray.backends import BackendArray
from xarray.core import indexing

from ..errors import CaseError
from ..output import PARTICLE_VARIABLES, read_frame
from ..output.variables import ParticleVariable, tensor_components
from ..spaces import Space

if TYPE_CHECKING:
    import xarray

COUNT = re.compile(rb'NumberOfPoints="(\d+)"')
HEAD = 4096
"""Bytes at the start of a file that contain the number of its particles."""
KEPT = 4
"""Frames kept in memory: programs often read all fields of one time one after the other."""
FROM_VTK = [0, 1, 2, 4, 5, 3]
"""Components of a tensor of VTK, xx, yy, zz, xy, yz, xz, in mpmkit's order."""
OTHERS = {
    "speed": ParticleVariable("m/s", "speed of the particle"),
    "half_size": ParticleVariable("m", "half sides of the particle's box", ("component",)),
    "body": ParticleVariable("1", "number of the body"),
}
"""Fields of the frames that a history does not have."""
NUMBER = "particle"
"""The field that says the number of a particle."""


def open_frames(
    files: Sequence[tuple[float, Path]], space: Space, states: Mapping[str, ParticleVariable] | None = None
) -> xarray.Dataset:
    """The frames as a dataset with the dimensions time, particle and component.

    The index along ``particle`` is the number of the particle, as in a history. Values are NaN at times when
    a particle does not exist: it was split off later or was merged before.

    Args:
        files: times, s, and files, in order of time.
        space: of the scene.
        states: what the laws and the plug-ins of the case add, with units.

    Raises:
        CaseError: there is no frame, or one cannot be read.
    """
    import xarray

    if not files:
        raise CaseError("the run has no frames; see output.frame_interval")
    paths = tuple(path for _, path in files)
    first, most = read_frame(paths[0]), _numbers(paths)
    known, variables = PARTICLE_VARIABLES | OTHERS | dict(states or {}), dict[str, Any]()
    for name, field in first.items():
        if name == NUMBER:
            continue
        about = known.get(name) or ParticleVariable("", name)
        trailing, columns = _trailing(name, field, about, space)
        sizes = {"component": len(space.axes), "tensor_component": 6, f"{name}_component": len(columns or ())}
        shape = (len(paths), most, *(sizes[dimension] for dimension in trailing))
        array = indexing.LazilyIndexedArray(_Field(paths, name, shape, columns))
        attributes = {"units": about.units, "long_name": about.long_name}
        variables[name] = xarray.Variable(("time", "particle", *trailing), array, attributes)
    times = xarray.Variable(
        "time", [time for time, _ in files], {"units": "s", "long_name": "simulated time"}
    )
    dataset = xarray.Dataset(variables, {"time": times, "particle": np.arange(most)})
    labels = {"component": list(space.axes), "tensor_component": tensor_components(space.axes)}
    return dataset.assign_coords({name: label for name, label in labels.items() if name in dataset.dims})


def _trailing(
    name: str, field: np.ndarray, about: ParticleVariable, space: Space
) -> tuple[tuple[str, ...], list[int] | None]:
    """Dimensions after time and particle, and the columns of the file along them."""
    if field.ndim == 1:
        return (), None
    if about.trailing == ("tensor_component",):
        return about.trailing, FROM_VTK
    if about.trailing == ("component",):
        return about.trailing, list(range(space.dim))  # in 2-D, the file has a zero as third component
    return (f"{name}_component",), list(range(field.shape[1]))


def _numbers(paths: Sequence[Path]) -> int:
    """One more than the largest number of a particle.

    If the first and the last frame have as many particles as numbers, no particle was added. Otherwise all
    frames are read.
    """
    counts = {_count(path) for path in paths}
    ends = [_largest(path) for path in (paths[0], paths[-1])]
    if len(counts) == 1 and {end + 1 for end in ends} == counts:
        return ends[0] + 1
    return max(map(_largest, paths)) + 1


def _count(path: Path) -> int:
    with path.open("rb") as file:
        found = COUNT.search(file.read(HEAD))
    return -1 if found is None else int(found[1])


def _largest(path: Path) -> int:
    frame = _loaded(path, path.stat().st_mtime_ns)
    number = frame.get(NUMBER, np.arange(len(frame["position"])))
    return int(number.max(initial=-1))


@lru_cache(maxsize=KEPT)
def _loaded(path: Path, _written: int) -> dict[str, np.ndarray]:
    return read_frame(path)


class _Field(BackendArray):
    """A field of all frames; xarray reads the part that is needed."""

    def __init__(
        self, paths: Sequence[Path], name: str, shape: tuple[int, ...], columns: list[int] | None
    ) -> None:
        self._paths, self._name, self._columns = paths, name, columns
        self.shape = shape
        self.dtype = np.dtype(float)

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._part)

    def _part(self, key: tuple) -> np.ndarray:
        """Indices along each axis in turn; a single number takes its dimension away."""
        time, *others = (part if isinstance(part, slice) else np.atleast_1d(part) for part in key)
        frames = [self._frame(self._paths[index]) for index in np.arange(self.shape[0])[time]]
        found = np.stack(frames) if frames else np.empty((0, *self.shape[1:]))
        for axis, part in enumerate(others, start=1):
            found = found[(slice(None),) * axis + (part,)]
        single = [axis for axis, part in enumerate(key) if isinstance(part, int | np.integer)]
        return found.squeeze(axis=tuple(single))

    def _frame(self, path: Path) -> np.ndarray:
        """The field of one frame, by the numbers of the particles."""
        frame = _loaded(path, path.stat().st_mtime_ns)
        found = np.full(self.shape[1:], np.nan)
        values = frame[self._name]
        number = frame.get(NUMBER, np.arange(len(values)))
        found[number] = (
            values
            if self._columns is None
            else values[:, self._columns].reshape(len(values), *self.shape[2:])
        )
        return found
