"""Checks of what plug-ins return, and of what they write.

The values that a plug-in returns are checked where they are used (``returned``). Shapes and bounds are
checked in every step. Whether numbers are finite is checked in every step of a small scene, but only every
``LOOKS`` steps of a large one, because going through all arrays takes some per cent of the time of a step.

Compiled code that writes out of bounds gives no error. So every ``INTERVAL`` steps, and in the first step,
each plug-in gets a trial call (``rehearse_…``): it is called with copies of its arguments, each between bands
of memory that it must not change. An order and a velocity update get no arrays. For them, the operations that
they call in a step are added up (``account``).

A trial call cannot detect faults that occur only for other particles or in other steps, nor writes beyond the
bands.
"""

from . import forces
from .account import Account, is_finite
from .equations_of_state import rehearse_equation_of_state
from .fences import SAMPLE
from .laws import rehearse_law, require_stress
from .returned import (
    FEW,
    described,
    require_array,
    require_energy,
    require_finite,
    require_number,
    require_sentences,
    require_truth,
)
from .shapes import particle_domain, rehearse_shape, require_bounds, require_weights
from .treatments import Rehearsed
from .walls import AuditedSurface, call_contact, placed, problem, rehearse_contact, require_contact

LOOKS = 20
"""Steps between two checks of all numbers of a scene with more than ``FEW`` particles."""
INTERVAL = 200
"""Steps between two trial calls: these then take less than 1 % of a run, also with few particles."""

__all__ = [
    "FEW",
    "INTERVAL",
    "LOOKS",
    "SAMPLE",
    "Account",
    "AuditedSurface",
    "Rehearsed",
    "call_contact",
    "described",
    "forces",
    "is_finite",
    "particle_domain",
    "placed",
    "problem",
    "rehearse_contact",
    "rehearse_equation_of_state",
    "rehearse_law",
    "rehearse_shape",
    "require_array",
    "require_bounds",
    "require_contact",
    "require_energy",
    "require_finite",
    "require_number",
    "require_sentences",
    "require_stress",
    "require_truth",
    "require_weights",
]
