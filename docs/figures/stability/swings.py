"""Scenes that keep their energy: a bar that vibrates, discs that meet, a block of fluid."""

import numpy as np
from maps import DOCS

import mpmkit

LENGTH, BAR_SPEED = 25.0, 10.0
SIDE, BLOCK_SPEED = 0.6, 10.0


def bar(cells: int) -> dict:
    dx = LENGTH / cells
    return mpmkit.load_case(
        DOCS.parent / "cases/vibrating_bar.json",
        [
            f"grid.cell_size={dx!r}",
            f'grid.domain={{"x": [0, {(cells + 2) * dx!r}], "z": [0, {dx!r}]}}',
            f"bodies.0.shape.upper=[{LENGTH}, {dx!r}]",
            "bodies.0.particles_per_cell=1",
        ],
    ).model_dump()


def discs(cells: int) -> dict:
    return mpmkit.load_case(
        DOCS.parent / "cases/two_discs.json", [f"grid.cell_size={0.4 / cells}"]
    ).model_dump()


def block(cells: int) -> dict:
    """At rest on a slip floor, held at one side; the others are free."""
    return {
        "space": "plane-strain",
        "until": 1.0,
        "gravity": [0.0, 0.0],
        "grid": {
            "cell_size": SIDE / cells,
            "domain": {"x": [0.0, 2 * SIDE], "z": [0.0, 2 * SIDE]},
            "faces": {"z_min": "slip", "x_min": "stick"},
        },
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [SIDE, SIDE]},
                "material": {
                    "law": "newtonian",
                    "viscosity": 0.0,
                    "density": 1000.0,
                    "sound_speed": BLOCK_SPEED,
                },
                "velocity": {"amplitude": [0.0, -0.02], "wave_vector": [0.0, np.pi / (2 * SIDE)]},
            }
        ],
        "scheme": {
            "velocity": "flip",
            "volumetric": {"name": "nodal-average", "relaxation": 0.0},
            "redistribution": "none",
        },
    }
