"""What plug-ins give back, and what they write where they must not.

What a plug-in returns is checked where it is used (``returned``). Shapes and bounds are checked in every
step. That numbers are finite is checked in every step of a small scene, and every ``LOOKS`` steps of a large
one, where a pass over all arrays costs per cents.

Compiled code writes wherever its indices lead, and nothing says so. Every ``INTERVAL`` steps, the first one
included, plug-ins are therefore rehearsed: called on copies of what they are given, each between bands that
nobody may write to. An order and a velocity update get no arrays: what they ask for in a step is counted
(``account``).

A rehearsal cannot see what only happens to other particles or in other steps, nor writes beyond the bands.
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
"""Steps between two looks at all numbers of a scene with more than ``FEW`` particles."""
INTERVAL = 200
"""Steps between two rehearsals: they then cost less than a hundredth of a run, however few its particles."""

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
