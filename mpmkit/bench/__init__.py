"""The speed of this machine: standard scenes in mid-flow, timed as a whole and for each operation."""

from .scenes import SCENES, BenchScene
from .timing import Timing, time_scene

__all__ = ["SCENES", "BenchScene", "Timing", "time_scene"]
