"""NetCDF files: written whole or not at all, and read, at exactly the path that is named."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .atomic import cannot_write, replacing

if TYPE_CHECKING:
    import xarray

PIECE = bytes(2**20)
MORE = 2**16
"""Bytes that a NetCDF file may have beside its arrays."""
_ONE_AT_A_TIME = threading.Lock()
"""HDF5, the library inside netCDF4, crashes when two threads use it, even on files of their own."""


def load_library() -> None:
    """Load what reads and writes, which takes about a second the first time."""
    import netCDF4  # noqa: F401
    import xarray  # noqa: F401


def read_scalars(path: Path) -> dict[str, tuple[np.ndarray, str, str]]:
    """Values, long names and units of the variables with the one dimension ``time``, ``time`` among them.

    Raises:
        OSError, RuntimeError: there is none at the path, or a part of one.
    """
    import netCDF4

    with _ONE_AT_A_TIME, netCDF4.Dataset(Path(path).absolute()) as file:
        return {
            name: (np.ma.filled(variable[:], np.nan), variable.long_name, variable.units)
            for name, variable in file.variables.items()
            if variable.dimensions == ("time",)
        }


def write_dataset(dataset: xarray.Dataset, path: Path) -> None:
    """Write a dataset; the file at ``path`` is whole at every moment.

    Raises:
        OutputError: it cannot be written; the sentence has the system's own reason, such as a full disk.
    """
    with replacing(path) as partial:
        try:
            # The absolute path, since xarray takes "~" at the begin of a path for the home folder.
            with _ONE_AT_A_TIME:
                dataset.to_netcdf(partial.absolute(), engine="netcdf4")
        except (RuntimeError, OSError) as error:
            if isinstance(error, OSError) and (error.errno or 0) > 0:
                raise  # a reason of the system's
            _meet_the_reason(partial, dataset.nbytes + MORE)
            raise cannot_write(path, error) from error


def read_dataset(path: Path) -> xarray.Dataset:
    """Read a dataset into memory.

    Raises:
        OSError, RuntimeError, ValueError: there is none at the path, or a part of one.
    """
    import xarray

    # With the engine, or xarray tries others on what is no NetCDF file, and warns of each.
    with _ONE_AT_A_TIME, xarray.open_dataset(Path(path).absolute(), engine="netcdf4") as dataset:
        return dataset.load()


def _meet_the_reason(path: Path, size: int) -> None:
    """Write as many plain bytes to the same place: the library says "HDF error", and the system says why.

    Raises:
        OSError: of the system, if it does not let them be written.
    """
    with path.open("wb") as file:
        for _ in range(0, size, len(PIECE)):
            file.write(PIECE)
