"""Data for a redistribution: lattices and cells over the material, sizes and positions of particles."""

from .stage import Stage, redistributes

__all__ = ["Stage", "redistributes"]
