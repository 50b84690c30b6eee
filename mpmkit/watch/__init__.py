"""The page of a run, served only on this machine while the run is in progress.

A separate process serves what the run has written so far. It shares no memory, no lock and no thread with
the run, so that it can neither slow nor stop the run. It ends when the run ends, for whatever reason.
"""

from .process import Watch

__all__ = ["Watch"]
