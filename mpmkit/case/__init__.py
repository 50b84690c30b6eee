"""Case files: their model, how they are read, and the messages about errors in them."""

from .composed import case_model
from .load import load_case, parse_case
from .model import Case
from .schema import case_schema

__all__ = ["Case", "case_model", "case_schema", "load_case", "parse_case"]
