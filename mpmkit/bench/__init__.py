"""How fast this machine is: the standard scenes, in mid-flow, timed as a whole and operation by operation."""

from .measure import Timing, measure
from .scenes import SCENES, BenchScene

__all__ = ["SCENES", "BenchScene", "Timing", "measure"]
