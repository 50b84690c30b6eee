"""The history: one row per time, kept in memory and rewritten to NetCDF during the run."""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .netcdf import load_library, write_dataset
from .variables import PARTICLE_VARIABLES, ParticleVariable, Variable, tensor_components

if TYPE_CHECKING:
    import xarray

FLUSH_INTERVAL = 5.0
"""Least wall time, s, between two rewrites of the file."""
FLUSH_PAUSE = 20
"""Least pause after a rewrite, in durations of the rewrite: so they take at most 5 % of the wall time."""


class History:
    """Rows of scalars, vectors and, if asked for, particle fields.

    xarray cannot append to NetCDF files, so the whole file is rewritten, but only as often as this is cheap.
    A killed process loses only the rows since the last rewrite.

    Args:
        columns: the columns of every row.
        attributes: global attributes of the dataset; may be added to until the last write.
        axes: names of the axes of the space, such as ``("r", "z")``.
        particle_variables: the particle fields that a row may hold.
        walls: names of the walls, of which some columns have an entry each.
    """

    def __init__(
        self,
        columns: Sequence[Variable],
        attributes: dict[str, Any],
        axes: Sequence[str],
        particle_variables: Mapping[str, ParticleVariable] = PARTICLE_VARIABLES,
        walls: Sequence[str] = (),
    ) -> None:
        self.attributes = attributes
        self._columns = {column.name: column for column in columns}
        self._axes = tuple(axes)
        self._walls = tuple(walls)
        self._variables = particle_variables
        self._times: list[float] = []
        self._rows: dict[str, list[np.ndarray]] = {name: [] for name in self._columns}
        self._particles: dict[str, list[np.ndarray]] | None = None
        self._next_flush = -np.inf  # the first row is written at once, to detect a full disk

    def __len__(self) -> int:
        return len(self._times)

    def record(
        self,
        time: float,
        values: Mapping[str, float | np.ndarray],
        particles: Mapping[str, np.ndarray] | None = None,
    ) -> None:
        """Append a row.

        Args:
            time: simulated time, s.
            values: a number, or a vector ``(dim,)``, for every column, in the column's units.
            particles: fields named in ``particle_variables`` in the order of particle numbers: ``(n,)``,
                vectors ``(n, dim)``, stress ``(n, 6)``. The same fields in every row.
        """
        if values.keys() != self._rows.keys():
            raise ValueError(f"a row needs {sorted(self._rows)} and was given {sorted(values)}")
        particles = particles or {}
        if self._particles is None:
            self._particles = {name: [] for name in particles}
        if particles.keys() != self._particles.keys():
            raise ValueError(
                f"a row needs {sorted(self._particles)} of the particles, given {sorted(particles)}"
            )
        self._times.append(float(time))
        for name, row in self._rows.items():
            row.append(np.array(values[name], dtype=float))
        for name, field in self._particles.items():
            field.append(np.array(particles[name], dtype=float))

    def state(self) -> dict[str, np.ndarray]:
        """The rows so far as arrays, for a checkpoint."""
        found = {"time": np.array(self._times)}
        found |= {f"row.{name}": np.array(rows) for name, rows in self._rows.items()}
        for name, fields in (self._particles or {}).items():
            found[f"lengths.{name}"] = np.array([len(field) for field in fields])
            found[f"particles.{name}"] = np.concatenate(fields)
        return found

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Restore the rows of a checkpoint."""
        self._times, self._next_flush = state["time"].tolist(), -np.inf
        self._rows = {name: [np.array(row) for row in state[f"row.{name}"]] for name in self._columns}
        names = [key.partition(".")[2] for key in state if key.startswith("particles.")]
        self._particles = {
            name: np.split(state[f"particles.{name}"], np.cumsum(state[f"lengths.{name}"])[:-1])
            for name in names
        }

    def dataset(self) -> xarray.Dataset:
        """The rows so far: dims ``(time)``, ``(time, component)``, ``(time, particle, …)``."""
        import xarray

        variables: dict[str, tuple] = {}
        for name, column in self._columns.items():
            sizes = {"wall": len(self._walls)} if column.of_walls else {}
            sizes |= {column.dimension: len(column.labels)} if column.dimension else {}
            sizes |= {"component": len(self._axes)} if column.component else {}
            sizes |= {"about": len(column.about)} if column.about else {}
            trailing, shape = tuple(sizes), (len(self), *sizes.values())
            attributes = {"units": column.units, "long_name": column.long_name}
            variables[name] = (
                ("time", *trailing),
                np.array(self._rows[name], dtype=float).reshape(shape),
                attributes,
            )
        for name, rows in (self._particles or {}).items():
            of_particle = self._variables[name]
            attributes = {"units": of_particle.units, "long_name": of_particle.long_name}
            variables[name] = (("time", "particle", *of_particle.trailing), _padded(rows), attributes)
        # The unit is "s" without "since", so that no reader converts the numbers to dates or durations.
        time = ("time", np.array(self._times), {"units": "s", "long_name": "simulated time"})
        dataset = xarray.Dataset(variables, {"time": time}, self.attributes)
        return dataset.assign_coords(self._labels(dataset))

    def _labels(self, dataset: xarray.Dataset) -> dict[str, tuple]:
        """Coordinates of the dimensions of the dataset, without time."""

        def coordinate(dimension: str, labels: Sequence, long_name: str) -> tuple:
            return dimension, np.array(labels), {"units": "1", "long_name": long_name}

        about = next((column.about for column in self._columns.values() if column.about), ())
        labels = {
            "wall": coordinate("wall", self._walls, "name of the wall"),
            "about": coordinate("about", about, "axis of the torque"),
            "component": coordinate("component", self._axes, "axis"),
            "tensor_component": coordinate("tensor_component", tensor_components(self._axes), "pair of axes"),
            "particle": coordinate(
                "particle", range(dataset.sizes.get("particle", 0)), "number of the particle"
            ),
        }
        for column in self._columns.values():
            if column.dimension:
                words = f"name of the {column.dimension}"
                labels[column.dimension] = coordinate(column.dimension, column.labels, words)
        return {name: label for name, label in labels.items() if name in dataset.dims}

    def write(self, path: Path) -> None:
        """Write the rows so far to NetCDF; the file at ``path`` is complete at any time.

        Raises:
            OutputError: where the file cannot be written.
        """
        write_dataset(self.dataset(), path)

    def flush_if_due(self, path: Path) -> bool:
        """Write if the last write is old enough, and return whether it did; call it after every row."""
        if clock.monotonic() < self._next_flush:
            return False
        load_library()  # slow at the first time; not part of the duration of a write
        start = clock.monotonic()
        self.write(path)
        end = clock.monotonic()
        self._next_flush = max(start + FLUSH_INTERVAL, end + FLUSH_PAUSE * (end - start))
        return True


def _padded(rows: list[np.ndarray]) -> np.ndarray:
    """One array of all rows; NaN for particles that did not exist yet."""
    most = max(map(len, rows))
    return np.stack(
        [np.pad(r, [(0, most - len(r))] + [(0, 0)] * (r.ndim - 1), constant_values=np.nan) for r in rows]
    )
