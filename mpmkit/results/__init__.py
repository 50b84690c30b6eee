"""A finished run, opened from its directory in Python and notebooks."""

from .progress import progress_bar
from .run import Run, open_run

__all__ = ["Run", "open_run", "progress_bar"]
