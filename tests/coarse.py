"""The shipped cases, and changes that make them coarse enough for tests of checkpoints."""

from pathlib import Path

CASES = Path(__file__).parents[1] / "cases"
COARSE = {
    "slump": ["grid.cell_size=0.04", 'grid.domain={"r": [0, 0.36], "z": [0, 0.32]}'],
    "slump_fast": ["grid.cell_size=0.04", 'grid.domain={"r": [0, 0.36], "z": [0, 0.32]}'],
    "slump_lifted": [
        "grid.cell_size=0.04",
        'grid.domain={"r": [0, 0.36], "z": [0, 0.32]}',
        "walls.mould.surface.thickness=0.04",
    ],
    "slump_bingham": ["grid.cell_size=0.04", 'grid.domain={"r": [0, 0.36], "z": [0, 0.32]}'],
    "slump_as_published": ["grid.cell_size=0.04", 'grid.domain={"r": [0, 0.36], "z": [0, 0.32]}'],
    "slump_quarter": ["grid.cell_size=0.05", 'grid.domain={"x": [0, 0.4], "y": [0, 0.4], "z": [0, 0.35]}'],
    "slump_quarter_fine": [
        "grid.cell_size=0.05",
        'grid.domain={"x": [0, 0.4], "y": [0, 0.4], "z": [0, 0.35]}',
    ],
    "slump_ferreira": [
        "grid.cell_size=0.05",
        'grid.domain={"x": [-0.35, 0.35], "y": [-0.35, 0.35], "z": [0, 0.35]}',
    ],
    "film": [],
    "two_discs": [],
    "vibrating_bar": [],
}
"""Changes of each case."""
