"""The page of a run, served on this machine alone while the run is at work.

A separate process serves what the run has written so far. It shares no memory, no lock and no thread with
the run, so that it can neither slow nor stop the run. It ends when the run ends, for whatever reason.
"""

from .process import Watch

__all__ = ["Watch"]
