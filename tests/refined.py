"""Scenes of particles that are split and merged."""

from __future__ import annotations

import numpy as np
import pytest

from mpmkit.case import parse_case
from mpmkit.solver.simulation import Simulation

DX = 0.1
AXES = {"plane-strain": "xz", "axisymmetric": "rz", "3d": "xyz"}
spaces = pytest.mark.parametrize("space", AXES)
FLUID = {
    "law": "bingham-evp",
    "density": 1000,
    "yield_stress": 5,
    "plastic_viscosity": 5,
    "sound_speed": 20.0,
}


def data(space="plane-strain", refinement="split-and-merge", materials=(FLUID,), cells=4, **scheme):
    """Blocks of four cells, each on the one before, with room around them."""
    axes = AXES[space]
    bodies = []
    for number, material in enumerate(materials):
        lower, upper = [0.3] * len(axes), [0.3 + cells * DX] * len(axes)
        lower[-1], upper[-1] = lower[-1] + number * cells * DX, upper[-1] + number * cells * DX
        shape = {"kind": "box", "lower": lower, "upper": upper}
        if space == "axisymmetric":
            shape = {"kind": "cylinder", "radius": cells * DX, "height": cells * DX, "base": [0, lower[-1]]}
        bodies.append({"shape": shape, "material": material})
    high = 0.6 + len(materials) * cells * DX
    domain = {axis: [0, 0.6 + cells * DX] for axis in axes} | {"z": [0, round(high, 3)]}
    return {
        "space": space,
        "until": 1.0,
        "gravity": [0.0] * len(axes),
        "grid": {"cell_size": DX, "domain": domain},
        "bodies": bodies,
        "scheme": {"refinement": refinement, "redistribution": "none", **scheme},
    }


def scene(*args, **kwargs):
    return Simulation(parse_case(data(*args, **kwargs)))


def draw_out(simulation, seed, stretch=3.0):
    """Particles in disorder, with boxes that are long along one axis and thin along the others."""
    p, rng = simulation.particles, np.random.default_rng(seed)
    p.position += rng.uniform(-0.5, 0.5, p.position.shape) * DX
    np.clip(p.position, 1e-3, simulation.grid.extent - 1e-3, out=p.position)
    p.box *= stretch ** rng.uniform(-1, 1, p.box.shape)
