"""Common functions for scenes with walls at any position and angle."""

from __future__ import annotations

import numpy as np
from fluids import CONCRETE

G = 9.81
STIFF = {"law": "neo-hookean", "density": 2000.0, "youngs_modulus": 1e6, "poisson_ratio": 0.3}
FRESH = {
    "law": "herschel-bulkley-evp",
    "density": CONCRETE.density,
    "yield_stress": CONCRETE.yield_stress,
    "consistency": CONCRETE.consistency,
    "flow_index": CONCRETE.flow_index,
}


def plane(point, normal, contact="slip", **more):
    surface = {"kind": "plane", "point": list(map(float, point)), "normal": list(map(float, normal)), **more}
    return {"surface": surface, "contact": contact}


def grid(cell, lower, upper, **more):
    """A domain of whole cells that holds a box."""
    low, high = np.floor(np.array(lower) / cell), np.ceil(np.array(upper) / cell)
    return {
        "cell_size": cell,
        "domain": {a: [low[i] * cell, high[i] * cell] for i, a in enumerate("xz")},
        **more,
    }


def centre(simulation, of="position"):
    p = simulation.particles
    return p.mass @ getattr(p, of) / p.mass.sum()


def coulomb(coefficient):
    return {"kind": "coulomb", "coefficient": coefficient}
