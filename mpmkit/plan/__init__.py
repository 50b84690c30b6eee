"""Cost of a run before it is run, and cost and error of cheaper models."""

from .cheaper import Cheaper, cheaper_models
from .cost import plan
from .expectation import expected_error

__all__ = ["Cheaper", "cheaper_models", "expected_error", "plan"]
