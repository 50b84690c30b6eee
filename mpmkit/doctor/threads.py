"""The number of threads that a run may use, and the environment variables that change it."""

from __future__ import annotations

import os

from .finding import Finding

VARIABLES = (
    "NUMBA_NUM_THREADS",
    "NUMBA_THREADING_LAYER",
    "NUMBA_DISABLE_JIT",
    "NUMBA_BOUNDSCHECK",
    "OMP_NUM_THREADS",
    "MPMKIT_PLUGINS",
)
"""Variables of the environment that change what a run does or how fast it is."""
SLOW = {
    "NUMBA_DISABLE_JIT": "kernels are not compiled and runs are hundreds of times slower",
    "NUMBA_BOUNDSCHECK": "kernels check every index and runs are several times slower",
}


def threads() -> Finding:
    """Most threads of a run, the layer that starts them, and the variables that are set."""
    from ..kernels.environment import require_sound_environment

    require_sound_environment()  # in our words, before numba says it in its own
    import numba

    found = Finding({"most threads": numba.config.NUMBA_NUM_THREADS})
    numba.set_num_threads(1)  # loads the layer
    found.facts["threading layer"] = numba.threading_layer()
    for name in VARIABLES:
        value = os.environ.get(name)
        if value is None:
            continue
        found.facts[name] = value
        if name in SLOW and value not in ("", "0"):
            found.problems.append(f"the environment variable {name} is '{value}': {SLOW[name]}; unset it")
    return found
