"""From measurements to materials: parameters of cases fitted to measurements."""

from .load import load_fit, parse_fit
from .model import Fit
from .run_fit import fit

__all__ = ["Fit", "fit", "load_fit", "parse_fit"]
