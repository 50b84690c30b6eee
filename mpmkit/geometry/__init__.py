"""Bodies: the solids that they are made of, the particles that fill them; walls: distances and motions."""

from ..contracts.solid import HalfSpace, Inverted, Jointed, Shell, Solid
from .closed_mesh import (
    copy_of_file,
    inside_surface,
    problem_of_file,
    surface_in_file,
    volume_in_surface,
)
from .contour import contour
from .distance import (
    Ball,
    Brick,
    BrickShell,
    Extruded,
    Revolved,
    Section,
    SurfaceMesh,
    trapezium,
    trapezium_plates,
    trapezium_shell,
)
from .motion import AnyMotion, Motion, Rotation
from .moving import MovingSolid
from .overlap import shared_volume
from .revolved import part_of_revolved
from .sampling import Sample, expected_count, sample
from .turning import axis_problem, generator, rotation

__all__ = [
    "AnyMotion",
    "Ball",
    "Brick",
    "BrickShell",
    "Extruded",
    "HalfSpace",
    "Inverted",
    "Jointed",
    "Motion",
    "MovingSolid",
    "Revolved",
    "Rotation",
    "Sample",
    "Section",
    "Shell",
    "Solid",
    "SurfaceMesh",
    "axis_problem",
    "contour",
    "copy_of_file",
    "expected_count",
    "generator",
    "inside_surface",
    "part_of_revolved",
    "problem_of_file",
    "rotation",
    "sample",
    "shared_volume",
    "surface_in_file",
    "trapezium",
    "trapezium_plates",
    "trapezium_shell",
    "volume_in_surface",
]
