"""The largest stable step of a scheme, found by trials and judged by physical criteria."""

from .bisect import Critical, critical_fraction
from .combinations import KINDS, combinations
from .judge import Criteria

__all__ = ["KINDS", "Criteria", "Critical", "combinations", "critical_fraction"]
