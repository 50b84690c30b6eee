"""Signed distances: how far points are from a solid, and in which direction."""

from .ball import Ball
from .brick import Brick, BrickShell
from .extruded import Extruded
from .revolved import Revolved
from .section import Section, trapezium, trapezium_plates, trapezium_shell
from .surface_mesh import SurfaceMesh

__all__ = [
    "Ball",
    "Brick",
    "BrickShell",
    "Extruded",
    "Revolved",
    "Section",
    "SurfaceMesh",
    "trapezium",
    "trapezium_plates",
    "trapezium_shell",
]
