"""The plug-ins of this environment: how they are found and checked, and which one caused an error."""

from .discovery import discover, installed
from .registered import Problem, Registered, Registry
from .requirements import check

__all__ = ["Problem", "Registered", "Registry", "check", "discover", "installed"]
