"""The interface for authors of plug-ins: one contract for each kind, and the marker of the hooks."""

from . import maxwell, tensors
from .base import API_VERSION, OLDEST_API_VERSION, Plugin, quantity
from .body_force import BodyForce
from .body_shape import AnyShape, BodyShape
from .contact import Contact, ContactNodes
from .diagnostic import Column, Diagnostic, Observed, ParticleField
from .elastoviscoplastic import ElastoviscoplasticLaw
from .elastoviscoplastic_with_state import ElastoviscoplasticLawWithState
from .equation_of_state import EquationOfState
from .generalised_newtonian import REST_SHEAR_RATE, GeneralisedNewtonianLaw
from .hooks import KINDS, hookimpl
from .initial_field import Beginning, InitialField
from .law import ConstitutiveLaw, Kinematics, StateVariable
from .operations import Operations
from .order import UpdateOrder
from .rate import Rate, RateTable
from .redistribution import Cells, Lattice, Redistributing, Redistribution
from .refinement import Refinement, Refining
from .shape import ShapeFunction
from .sink import Sink
from .solid import Solid
from .source import Mouth, Source
from .surface import PlacedSurface, Space, Surface
from .table import require_table
from .velocity import VelocityUpdate
from .version1 import Motion as Motion
from .volumetric import VolumetricTreatment

__all__ = [
    "API_VERSION",
    "KINDS",
    "OLDEST_API_VERSION",
    "REST_SHEAR_RATE",
    "AnyShape",
    "Beginning",
    "BodyForce",
    "BodyShape",
    "Cells",
    "Column",
    "ConstitutiveLaw",
    "Contact",
    "ContactNodes",
    "Diagnostic",
    "ElastoviscoplasticLaw",
    "ElastoviscoplasticLawWithState",
    "EquationOfState",
    "GeneralisedNewtonianLaw",
    "InitialField",
    "Kinematics",
    "Lattice",
    "Mouth",
    "Observed",
    "Operations",
    "ParticleField",
    "PlacedSurface",
    "Plugin",
    "Rate",
    "RateTable",
    "Redistributing",
    "Redistribution",
    "Refinement",
    "Refining",
    "ShapeFunction",
    "Sink",
    "Solid",
    "Source",
    "Space",
    "StateVariable",
    "Surface",
    "UpdateOrder",
    "VelocityUpdate",
    "VolumetricTreatment",
    "hookimpl",
    "maxwell",
    "quantity",
    "require_table",
    "tensors",
]
