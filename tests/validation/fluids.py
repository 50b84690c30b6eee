"""The fluids of section 2 of the targets, and its band."""

from channel import Fluid

CONCRETE = Fluid(188.91, 45.65, 1.33, density=2574.0)
PLASTIC = Fluid(188.91, 45.65, density=2574.0)
UNIT = Fluid(0.25, 1.0)
WATER = Fluid(0.0, 1.0)
BAND = 0.02
