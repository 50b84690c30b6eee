"""A movie of a run, drawn from its frames."""

from .make import make_movie
from .quantities import QUANTITIES

__all__ = ["QUANTITIES", "make_movie"]
