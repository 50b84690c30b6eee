"""Draw docs/images/stability/fracture.png: how far a strip stretches before the grid tears it.

    python docs/figures/stability/fracture.py [--draw]

Takes about seven minutes.
"""

import numpy as np
import xarray
from maps import BLACK, BLUE, DOCS, GREEN, GREY, ORANGE, VERMILION, make, sheet
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from strip import largest_stretch

import mpmkit

RULES = {
    "linear": {"shape": "linear"},
    **{
        rule: {"shape": {"name": "cpgimp", "domain": rule}}
        for rule in ("fixed", "volume", "stretch", "strain")
    },
}
FAST, SLOW, LONGEST = 200.0, 0.1, 10.0
PULLS = {
    f"{name}, {speed}": (scheme, pull)
    for name, scheme in (RULES | {"strain, splitting": {"splitting": True}}).items()
    for speed, pull in (("fast", FAST), ("slow", SLOW))
}
COUNTS = np.arange(1, 5)
COLOURS = {"linear": GREY, "fixed": ORANGE, "volume": GREEN, "strain": BLUE}
CELLS = {20.0: (0.36, 0.32), 12.5: (0.3625, 0.3125), 10.0: (0.36, 0.31)}
"""Cells of the slump, mm, and the domain, m."""


def slump(cell: float, scheme: dict, splitting: bool) -> tuple[float, float, float]:
    """Largest error of the density on the nodes well inside the sheet, and part of the volume in boxes longer
    than a cell, both at 0.5 s; spread at 1.5 s, m."""
    radius, height = CELLS[cell]
    case = mpmkit.load_case(
        DOCS.parent / "cases/slump.json",
        [f"grid.cell_size={cell / 1000}", f'grid.domain={{"r": [0, {radius}], "z": [0, {height}]}}'],
    ).model_dump()
    case["scheme"] |= {"order": "usf", "redistribution": "none", "splitting": splitting} | scheme
    simulation = mpmkit.Simulation(mpmkit.parse_case(case))
    while simulation.time < 0.5:
        simulation.advance()
    off, torn = density_off(simulation), simulation.measures(simulation.particles)["fractured_fraction"]
    while simulation.time < 1.5:
        simulation.advance()
    return off, torn, simulation.measures(simulation.particles)["spread_diameter"]


def density_off(simulation: mpmkit.Simulation) -> float:
    """Of the nodes within 0.1 m of the axis and 0.03 m of the floor; those on either are left out."""
    operations, dx = simulation.operations, simulation.grid.cell_size
    operations.begin()
    operations.map_to_grid(forces=False)
    window = operations.window
    r, z = np.arange(1, round(0.1 / dx)), np.arange(1, max(2, round(0.03 / dx)))
    mass = window.nodes.reshape(*window.shape[:2], -1)[..., 0]
    density = mass[np.ix_(r - window.lower[0], z - window.lower[1])] / (2 * np.pi * r[:, None] * dx**3)
    return float(np.abs(density / 2574.0 - 1).max())


def measure() -> xarray.Dataset:
    torn = [
        [largest_stretch(int(n), scheme, pull, LONGEST) for n in COUNTS] for scheme, pull in PULLS.values()
    ]
    slumps = np.array(
        [[[slump(cell, s, split) for cell in CELLS] for split in (False, True)] for s in RULES.values()]
    )
    where = ("rule", "splitting", "cell")
    return xarray.Dataset(
        {
            "stretch": (
                ("pull", "count"),
                torn,
                {"units": "1", "long_name": "stretch at which the strip tears"},
            ),
            "density_off": (
                where,
                slumps[..., 0],
                {"units": "1", "long_name": "largest error of the density"},
            ),
            "fractured": (where, slumps[..., 1], {"units": "1", "long_name": "volume in boxes over a cell"}),
            "spread": (where, slumps[..., 2], {"units": "m", "long_name": "spread at 1.5 s"}),
        },
        {
            "pull": list(PULLS),
            "count": ("count", COUNTS, {"units": "1", "long_name": "particles per cell"}),
            "rule": list(RULES),
            "splitting": ["off", "on"],
            "cell": ("cell", list(CELLS), {"units": "mm", "long_name": "side of a cell"}),
        },
    )


def draw(data: xarray.Dataset) -> Figure:
    figure, (left, right) = sheet("Numerical fracture: stretch at which it begins, and density", 2)
    draw_strip(left, data)
    draw_slump(right, data)
    return figure


def draw_strip(axes: Axes, data: xarray.Dataset) -> None:
    n = np.linspace(0.8, 4.2, 200)
    follows = 0.5 + np.sqrt(0.25 + n)  # root of the stretch at which lambda - √lambda = n
    theory = {"linear": n, "fixed": n + 1, "volume": np.minimum(follows**2, 2 * n), "strain": 2 * n}
    for number, (rule, colour) in enumerate(COLOURS.items()):
        at = data["count"] + 0.05 * (number - 1.5)
        axes.plot(n, theory[rule], color=colour, lw=1.2, zorder=1)
        axes.plot(at, data.stretch.sel(pull=f"{rule}, fast"), "o", color=colour, label=rule)
        axes.plot(at, data.stretch.sel(pull=f"{rule}, slow"), "o", color=colour, mfc="white")
    slow = data.stretch.sel(pull="strain, splitting, slow")
    axes.plot(data["count"] + 0.12, slow, "^", color=VERMILION, mfc="white")
    fast = data.stretch.sel(pull="strain, splitting, fast").where(np.isfinite, LONGEST)
    axes.plot(data["count"], fast, "^", color=VERMILION, label=f"strain, splitting ({LONGEST:g}: not torn)")
    axes.plot([], [], "o", color=BLACK, label="pulled fast")
    axes.plot([], [], "o", color=BLACK, mfc="white", label="pulled slowly")
    axes.plot([], [], color=BLACK, lw=1.2, label="theory")
    axes.set(xlim=(0.8, 4.2), ylim=(0.8, 14.5), xticks=COUNTS, yticks=range(2, 13, 2))
    axes.set(xlabel="particles per cell along the strip", ylabel="stretch at which the strip tears")
    axes.set_title("Elastic strip, pulled by a block that flies off", fontsize=9)
    axes.legend(frameon=False, fontsize=8, ncols=2, loc="upper left")


def draw_slump(axes: Axes, data: xarray.Dataset) -> None:
    for cell, colour in zip(data.cell.values, (GREY, ORANGE, BLUE), strict=True):
        for split, fill in (("off", colour), ("on", "white")):
            off = 100 * data.density_off.sel(cell=cell, splitting=split)
            axes.semilogy(
                data.rule, off, "o", color=colour, mfc=fill, label=f"{cell:g} mm, splitting {split}"
            )
    axes.set(ylim=(0.2, 200), xlabel="boxes", ylabel="largest error of the nodal density / %")
    axes.set_title("Slump, inside the sheet at 0.5 s", fontsize=9)
    axes.legend(frameon=False, fontsize=8, ncols=2, loc="upper left")


if __name__ == "__main__":
    make("fracture", measure, draw)
