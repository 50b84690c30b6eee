"""Bodies: their shapes, the particles that fill them, and walls: their distances and motions."""

from typing import Annotated, get_args

from pydantic import Field

from .base import Shape
from .box import Box
from .contour import contour
from .cylinder import Cylinder
from .distance import HalfSpace, Inverted, Solid
from .frustum import Frustum
from .mesh import Mesh
from .motion import AnyMotion, Motion, Rotation
from .moving import MovingSolid
from .overlap import shared_volume
from .polygon import Polygon
from .sampling import Sample, expected_count, sample
from .sphere import Sphere
from .turning import axis_problem, generator, rotation

AnyShape = Annotated[Frustum | Cylinder | Box | Sphere | Polygon | Mesh, Field(discriminator="kind")]
"""Any shape in a case file; its ``kind`` selects the class."""

FILES = {
    get_args(shape.model_fields["kind"].annotation)[0]: shape.files
    for shape in (Frustum, Cylinder, Box, Sphere, Polygon, Mesh)
}
"""Fields that name a file, by kind of shape."""

__all__ = [
    "FILES",
    "AnyMotion",
    "AnyShape",
    "Box",
    "Cylinder",
    "Frustum",
    "HalfSpace",
    "Inverted",
    "Mesh",
    "Motion",
    "MovingSolid",
    "Polygon",
    "Rotation",
    "Sample",
    "Shape",
    "Solid",
    "Sphere",
    "axis_problem",
    "contour",
    "expected_count",
    "generator",
    "rotation",
    "sample",
    "shared_volume",
]
