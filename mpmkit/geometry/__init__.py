"""Bodies: their shapes, and the particles that fill them."""

from typing import Annotated, get_args

from pydantic import Field

from .base import Shape
from .box import Box
from .cylinder import Cylinder
from .frustum import Frustum
from .mesh import Mesh
from .overlap import shared_volume
from .sampling import Sample, expected_count, sample
from .sphere import Sphere

AnyShape = Annotated[Frustum | Cylinder | Box | Sphere | Mesh, Field(discriminator="kind")]
"""Any shape as it stands in a case file, told apart by its ``kind``."""

FILES = {
    get_args(shape.model_fields["kind"].annotation)[0]: shape.files
    for shape in (Frustum, Cylinder, Box, Sphere, Mesh)
}
"""Fields that name a file, by kind of shape."""

__all__ = [
    "FILES",
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
    "shared_volume",
]
