"""What a redistribution works on: lattices and cells over the material, sizes and places of particles."""

from .stage import Stage, redistributes

__all__ = ["Stage", "redistributes"]
