"""NetCDF files: written completely or not at all, and read, at exactly the given path."""

from __future__ import annotations

import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .atomic import cannot_write, replacing

if TYPE_CHECKING:
    import xarray

PIECE = bytes(2**20)
MORE = 2**16
"""Bytes that a NetCDF file may have in addition to its arrays."""
_ONE_AT_A_TIME = threading.Lock()
"""Lock for HDF5, the library inside netCDF4: it crashes if two threads use it, even for different files."""


def load_library() -> None:
    """Load the library, which takes about a second at the first time."""
    import netCDF4  # noqa: F401
    import xarray  # noqa: F401


def leave_dask_out() -> None:
    """Have xarray find that Dask is not there. It loads Dask wherever it is installed, although a run has
    none of its arrays. For a process that does nothing else than one run.

    xarray asks once and remembers the answer. Afterwards Dask can be loaded as ever.
    """
    if "dask" in sys.modules or "xarray" in sys.modules:
        return
    sys.modules["dask"] = None  # type: ignore[assignment]  # so Python finds no such module
    try:
        import xarray

        xarray.Dataset(coords={"x": [0.0]})
    finally:
        del sys.modules["dask"]


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
    """Write a dataset; the file at ``path`` is complete at any time.

    Raises:
        OutputError: it cannot be written; the sentence contains the reason of the system, such as a full
        disk.
    """
    with replacing(path) as partial:
        try:
            with _ONE_AT_A_TIME:
                _dump(dataset, partial)
        except (RuntimeError, OSError) as error:
            if isinstance(error, OSError) and (error.errno or 0) > 0:
                raise  # the system gives the reason
            _meet_the_reason(partial, dataset.nbytes + MORE)
            raise cannot_write(path, error) from error


def _dump(dataset: xarray.Dataset, path: Path) -> None:
    """As ``to_netcdf``, which loads Dask where it is installed, to ask it for a lock."""
    from xarray.backends import NetCDF4DataStore

    # The absolute path, since xarray takes "~" at the begin of a path for the home folder.
    store = NetCDF4DataStore.open(path.absolute(), mode="w", lock=False)
    try:
        dataset.dump_to_store(store)
    finally:
        store.close()


def read_dataset(path: Path) -> xarray.Dataset:
    """Read a dataset into memory.

    Raises:
        OSError, RuntimeError, ValueError: there is none at the path, or a part of one.
    """
    import xarray

    # With the engine; otherwise xarray tries others for an invalid file, and warns about each.
    with _ONE_AT_A_TIME, xarray.open_dataset(Path(path).absolute(), engine="netcdf4") as dataset:
        return dataset.load()


def _meet_the_reason(path: Path, size: int) -> None:
    """Write as many plain bytes to the same place: the library only reports "HDF error", the system the
    reason.

    Raises:
        OSError: from the system, if they cannot be written.
    """
    with path.open("wb") as file:
        for _ in range(0, size, len(PIECE)):
            file.write(PIECE)
