"""What a run costs, before it is run, and what cheaper models of it would cost and lose."""

from .cheaper import Cheaper, cheaper_models
from .cost import plan
from .expectation import expected_error

__all__ = ["Cheaper", "cheaper_models", "expected_error", "plan"]
