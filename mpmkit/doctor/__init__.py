"""What a bug report needs to know of an installation and its machine, and what is wrong with them."""

from .examine import SECTIONS, examine
from .finding import Finding

__all__ = ["SECTIONS", "Finding", "examine"]
