"""Case files: what a scene is, how it is read, and what is said of a bad one."""

from .composed import case_model
from .load import load_case, parse_case
from .model import Case
from .schema import case_schema

__all__ = ["Case", "case_model", "case_schema", "load_case", "parse_case"]
