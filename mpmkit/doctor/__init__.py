"""Facts about an installation and its machine for a bug report, and the problems found in them."""

from .examine import SECTIONS, examine
from .finding import Finding

__all__ = ["SECTIONS", "Finding", "examine"]
