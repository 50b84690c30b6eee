"""The plug-ins of this environment: how they are found, what they must be, and whose fault an error is."""

from .discovery import discover, installed
from .registered import Problem, Registered, Registry
from .requirements import check

__all__ = ["Problem", "Registered", "Registry", "check", "discover", "installed"]
