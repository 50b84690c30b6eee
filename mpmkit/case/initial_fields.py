"""The initial fields of the bodies of a case: their names, and whether law and space can have them."""

from __future__ import annotations

from ..registry.audit.initial_fields import LAW, shape_of
from ..registry.blame import blaming_plugins
from .allowed import one_of, shown
from .bodies import Body
from .model import Case


def check_initial_fields(where: str, body: Body, case: Case) -> None:
    """Raise ValueError with one sentence for the first field that a body cannot have.

    Raises:
        PluginStop: a field is at fault.
    """
    law = body.material.constitutive_law
    allowed = ["velocity", "stress", *(f"{LAW}{name}" for name in law.state)]
    for name, field in body.initial.items():
        if name not in allowed:
            raise ValueError(f"{where}.initial has the field {shown(name)}; it must be {one_of(allowed)}")
        if name == "velocity" and body.velocity is not None:
            raise ValueError(f"{where} has both velocity and initial.velocity; leave out one of them")
        with blaming_plugins([("initial_field", field)]):
            problem = field.problem(case.space_, name, shape_of(name, law, case.space_))
        if problem is not None:
            raise ValueError(f"{where}.initial.{name}: {problem}")
        solid = not law.uses_equation_of_state
        if name == "stress" and solid and not law.needs_deformation_gradient:
            raise ValueError(
                f"{where}.initial.stress cannot be given: the law '{law.name}' has neither an equation of "
                "state nor a deformation gradient, from which it could follow"
            )
