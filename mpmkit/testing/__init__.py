"""The conformance kit: it checks whether a plug-in keeps its contract, in a test file of three lines.

>>> from mpmkit.testing import law_tests
>>> from mpmkit_casson import Casson
>>> test_casson = law_tests(Casson(yield_stress=20, casson_viscosity=0.8), flow_curve=…)

With pytest each property is a test of its own; without pytest, ``for check in law_checks(law): check()``.
"""

from .checks import (
    Check,
    body_force_checks,
    body_shape_checks,
    contact_checks,
    diagnostic_checks,
    equation_of_state_checks,
    initial_field_checks,
    law_checks,
    order_checks,
    particle_field_checks,
    redistribution_checks,
    refinement_checks,
    shape_checks,
    sink_checks,
    source_checks,
    surface_checks,
    velocity_checks,
    volumetric_checks,
)
from .pytest_tests import (
    body_force_tests,
    body_shape_tests,
    contact_tests,
    diagnostic_tests,
    equation_of_state_tests,
    initial_field_tests,
    law_tests,
    order_tests,
    particle_field_tests,
    redistribution_tests,
    refinement_tests,
    shape_tests,
    sink_tests,
    source_tests,
    surface_tests,
    velocity_tests,
    volumetric_tests,
)
from .violation import Violation

__all__ = [
    "Check",
    "Violation",
    "body_force_checks",
    "body_force_tests",
    "body_shape_checks",
    "body_shape_tests",
    "contact_checks",
    "contact_tests",
    "diagnostic_checks",
    "diagnostic_tests",
    "equation_of_state_checks",
    "equation_of_state_tests",
    "initial_field_checks",
    "initial_field_tests",
    "law_checks",
    "law_tests",
    "order_checks",
    "order_tests",
    "particle_field_checks",
    "particle_field_tests",
    "redistribution_checks",
    "redistribution_tests",
    "refinement_checks",
    "refinement_tests",
    "shape_checks",
    "shape_tests",
    "sink_checks",
    "sink_tests",
    "source_checks",
    "source_tests",
    "surface_checks",
    "surface_tests",
    "velocity_checks",
    "velocity_tests",
    "volumetric_checks",
    "volumetric_tests",
]
