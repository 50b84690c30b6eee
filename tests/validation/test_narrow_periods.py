"""A flow that does not vary along a periodic axis is the same with one cell along it as with two or three."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from bands import below

import mpmkit

pytestmark = pytest.mark.section(6)

DX = 0.05
FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 50.0, "sound_speed": 15.0}


def layer(cells, shape, order):
    """Speed, m/s, by height of a layer that flows along a stick floor, in a period of this many cells."""
    axes = "xz" if len(cells) == 1 else "xyz"
    sizes = [*cells, 3]
    case = {
        "space": "3d" if len(sizes) == 3 else "plane-strain",
        "until": 1.0,
        "gravity": [4.0, *[0.0] * (len(sizes) - 2), -8.0],
        "grid": {
            "cell_size": DX,
            "domain": {a: [0.0, n * DX] for a, n in zip(axes, [*cells, 5], strict=True)},
            "faces": {f"{a}_{end}": "periodic" for a in axes[:-1] for end in ("min", "max")}
            | {"z_min": "stick"},
        },
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0.0] * len(sizes), "upper": [n * DX for n in sizes]},
                "material": FLUID,
            }
        ],
        "scheme": {"shape": shape, "order": order, "velocity": "apic", "time_step": {"fraction": 0.4}},
    }
    simulation = mpmkit.Simulation(mpmkit.parse_case(case))
    while simulation.time < 0.1:
        simulation.advance(min(1e-3, 0.1 - simulation.time))
    p = simulation.particles
    level = np.round(4 * p.position[:, -1] / DX)
    speeds = [p.velocity[level == k, 0] for k in np.unique(level)]
    assert max(np.ptp(speed) for speed in speeds) < 1e-9  # nothing varies along a layer
    return np.array(
        [
            [p.position[level == k, -1].mean(), speed.mean()]
            for k, speed in zip(np.unique(level), speeds, strict=True)
        ]
    )


@pytest.mark.parametrize("shape", ["linear", "cpgimp"])
@pytest.mark.parametrize("order", ["usl", "usf", "musl"])
def test_layer_in_a_period_of_one_cell(validate, shape, order):
    whole = {1: layer([3], shape, order), 2: layer([3, 3], shape, order)}
    surface = whole[1][-1, 1]
    assert surface > 0.05
    # A cube's side goes with J^(1/3), a square's with J^(1/2): boxes differ by a sixth of the compression.
    compression = 8.0 * 3 * DX / FLUID["sound_speed"] ** 2
    assert np.abs(whole[2] - whole[1]).max() < compression / 6 * surface
    for cells in ([1], [2], *product([1, 3], [1, 2])):
        off = np.abs(layer(list(cells), shape, order) - whole[len(cells)]).max() / surface
        name = f"Layer in a period of {' by '.join(map(str, cells))} cells, {shape}, {order}: off that of 3"
        validate(name, off, below(1e-9, "0"))
