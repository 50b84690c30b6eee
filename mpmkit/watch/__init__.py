"""The page of a run, served on this machine alone while the run is at work.

A process of its own serves what the run has written so far. It shares no memory, no lock and no thread with
the run, so that it can neither slow it nor stop it, and it ends when the run ends, however that is.
"""

from .process import Watch

__all__ = ["Watch"]
