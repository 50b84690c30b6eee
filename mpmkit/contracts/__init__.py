"""What a plug-in author needs: one contract a kind, and the marker that registers an implementation."""

from .base import API_VERSION, Plugin, quantity
from .elastoviscoplastic import ElastoviscoplasticLaw
from .equation_of_state import EquationOfState
from .generalised_newtonian import REST_SHEAR_RATE, GeneralisedNewtonianLaw
from .hooks import KINDS, hookimpl
from .law import ConstitutiveLaw, Motion, StateVariable
from .operations import Operations
from .order import UpdateOrder
from .redistribution import Cells, Lattice, Redistributing, Redistribution
from .shape import ShapeFunction
from .velocity import VelocityUpdate
from .volumetric import VolumetricTreatment

__all__ = [
    "API_VERSION",
    "KINDS",
    "REST_SHEAR_RATE",
    "Cells",
    "ConstitutiveLaw",
    "ElastoviscoplasticLaw",
    "EquationOfState",
    "GeneralisedNewtonianLaw",
    "Lattice",
    "Motion",
    "Operations",
    "Plugin",
    "Redistributing",
    "Redistribution",
    "ShapeFunction",
    "StateVariable",
    "UpdateOrder",
    "VelocityUpdate",
    "VolumetricTreatment",
    "hookimpl",
    "quantity",
]
