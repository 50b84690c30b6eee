"""What a scene could cost: models that are cheaper and admissible for it, and what is lost with them."""

from .cheaper import Cheaper, cheaper_models
from .expectation import expected_error

__all__ = ["Cheaper", "cheaper_models", "expected_error"]
