"""Memory that a run may take."""

from __future__ import annotations

from .finding import Finding, mebibytes

LITTLE = 2**30
"""Bytes; about the memory of a three-dimensional run."""


def memory() -> Finding:
    """Memory of the machine, memory that this process may still use, and the limit behind it."""
    import psutil

    from ..solver.available_memory import tightest_limit

    left, limit = tightest_limit()
    total = psutil.virtual_memory().total
    found = Finding({"of the machine": mebibytes(total), "left for a run": f"{mebibytes(left)} {limit}"})
    if left < LITTLE:
        found.problems.append(
            f"only {mebibytes(left)} of memory are left {limit}: large scenes will be refused; "
            "'mpmkit plan CASE' says how much a run needs"
        )
    return found
