"""How long a step a scheme bears: found by trying, and judged by physics."""

from .bisect import Critical, critical_fraction
from .combinations import KINDS, combinations
from .judge import Criteria

__all__ = ["KINDS", "Criteria", "Critical", "combinations", "critical_fraction"]
