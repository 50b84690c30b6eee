"""mpmkit: a plug-in based Material Point Method for yield-stress materials.

>>> import mpmkit
>>> case = mpmkit.load_case("cases/slump.json")
>>> history = mpmkit.run(case)          # an xarray.Dataset
>>> history.spread_diameter.plot()
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .case import Case, load_case, parse_case
    from .fitting import fit
    from .results import Run, open_run, progress_bar
    from .running.runner import run
    from .solver.simulation import Simulation
    from .version import __version__

__all__ = [
    "Case",
    "Run",
    "Simulation",
    "__version__",
    "fit",
    "load_case",
    "open_run",
    "parse_case",
    "progress_bar",
    "run",
]

_HOME = {
    "Case": "mpmkit.case",
    "load_case": "mpmkit.case",
    "parse_case": "mpmkit.case",
    "fit": "mpmkit.fitting",
    "run": "mpmkit.running.runner",
    "Run": "mpmkit.results",
    "open_run": "mpmkit.results",
    "progress_bar": "mpmkit.results",
    "Simulation": "mpmkit.solver.simulation",
    "__version__": "mpmkit.version",
}


def __dir__() -> list[str]:
    """The public names, for completion in notebooks, also those that are not loaded yet."""
    return sorted({*globals(), *__all__})


def __getattr__(name: str) -> Any:
    # Loaded at the first use: a plug-in that imports mpmkit.contracts must not load the solver, and the
    # command line must handle Ctrl-C before slow imports.
    if name in _HOME:
        from importlib import import_module

        return getattr(import_module(_HOME[name]), name)
    raise AttributeError(f"module 'mpmkit' has no attribute '{name}'")
