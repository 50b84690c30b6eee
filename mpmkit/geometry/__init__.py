"""Bodies: their shapes, and the particles that fill them."""

from typing import Annotated

from pydantic import Field

from .base import Shape
from .box import Box
from .cylinder import Cylinder
from .frustum import Frustum
from .mesh import Mesh
from .sampling import Sample, expected_count, sample
from .sphere import Sphere

AnyShape = Annotated[Frustum | Cylinder | Box | Sphere | Mesh, Field(discriminator="kind")]
"""Any shape as it stands in a case file, told apart by its ``kind``."""

__all__ = [
    "AnyShape",
    "Box",
    "Cylinder",
    "Frustum",
    "Mesh",
    "Sample",
    "Shape",
    "Sphere",
    "expected_count",
    "sample",
]
