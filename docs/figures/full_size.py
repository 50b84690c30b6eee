"""Draw docs/images/full_size.png and docs/images/full_size_section.png.

    mpmkit run cases/slump.json
    mpmkit run docs/figures/slump_full.json --threads 2
    mpmkit run cases/slump_quarter_fine.json --set scheme.redistribution=none --set scheme.splitting=true \\
        --until 4 --out runs/quarter
    mpmkit run cases/slump_ferreira.json --threads 1            # ended after an hour, with Ctrl-C
    python docs/figures/full_size.py

The runs take about two hours of two cores together. Prints the table of docs/performance.md too.
"""

import json
from pathlib import Path

import numpy as np
import xarray
from common import DOCS, figure, plot_reference
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from options import parser, require

from mpmkit.output import read_frame

RUNS = {
    "slump": ("axisymmetric, 5 mm", {"color": "#0072B2"}),
    "slump_full": ("whole cone in 3-D, 5 mm", {"color": "#D55E00", "ls": "-."}),
    "quarter": ("quarter in 3-D, 5 mm, Mach 0.1", {"color": "#009E73", "ls": ":", "lw": 2.2}),
    "slump_ferreira": ("whole cone, the paper to the letter", {"color": "#CC79A7", "ls": (0, (6, 2))}),
}
TIMES = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0)


def arguments() -> Path:
    """Where the run directories lie; all of them are there."""
    options = parser()
    options.add_argument(
        "--runs", default=DOCS.parent / "runs", type=Path, help="where the run directories lie"
    )
    runs = options.parse_args().runs
    require(runs / name / "history.nc" for name in RUNS)
    require([runs / "slump_full" / "frames"])
    return runs


def main() -> None:
    runs = arguments()
    sheet, axes = figure("The paper's cone at the paper's size, free-slip floor")
    plot_reference(axes)
    print(
        f"| run | D at {', '.join(map(str, TIMES))} s (mm) | T500 (s) | particles at first, at last ", end=""
    )
    print("| to (s) | steps | wall time (s) | million particle-steps/s |\n|---|---|---|---|---|---|---|---|")
    spreads = {}
    for name, (label, style) in RUNS.items():
        directory = runs / name
        history = xarray.load_dataset(directory / "history.nc")
        axes.plot(history.time, 1e3 * history.spread_diameter, label=label, **style)
        time, spread = history.time.values, history.spread_diameter.values
        spreads[name] = (time, spread)
        row(directory, label, time, spread)
    axes.legend(frameon=False, fontsize=8, loc="lower right")
    sheet.savefig(DOCS / "images" / "full_size.png")
    apart(spreads)
    section(runs / "slump_full")


def row(directory: Path, label: str, time: np.ndarray, spread: np.ndarray) -> None:
    reached = [f"{1e3 * np.interp(t, time, spread):.1f}" for t in TIMES if t <= time[-1] * 1.001]
    first = sorted((directory / "frames").glob("*.vtu"))[0]
    at_first = len(read_frame(first)["position"])
    summary = directory / "summary.json"
    found = json.loads(summary.read_text(encoding="utf-8")) if summary.exists() else {}
    t500 = found.get("t500")
    cells = [
        label,
        ", ".join(reached),
        "–" if t500 is None else f"{t500:.3f}",
        f"{at_first:,}, {found.get('particles', 0):,}",
        f"{time[-1]:.2f}",
        f"{found.get('steps', 0):,}",
        f"{found.get('wall_time', 0):,.0f}",
        f"{(found.get('particle_steps_per_second') or 0) / 1e6:.2f}",
    ]
    print(f"| {' | '.join(cells)} |")


def apart(spreads: dict[str, tuple[np.ndarray, np.ndarray]]) -> None:
    """Largest departure of each from the body of revolution, as far as both go."""
    time, spread = spreads["slump"]
    for name, (t, found) in spreads.items():
        if name != "slump":
            common = np.linspace(0, min(t[-1], time[-1]), 201)
            off = np.abs(np.interp(common, t, found) / np.interp(common, time, spread) - 1).max()
            print(f"{RUNS[name][0]}: at most {off:.2%} from the body of revolution")


def section(directory: Path) -> None:
    """The last frame of the whole cone from above and from the side, coloured by speed."""
    frame = read_frame(sorted((directory / "frames").glob("*.vtu"))[-1])
    position, speed = 1e3 * frame["position"], frame["speed"]
    sheet = Figure(figsize=(7.2, 6.6), dpi=160, layout="constrained")
    FigureCanvasAgg(sheet)
    above, side = sheet.subplots(2, 1, height_ratios=[5, 1])
    for axes, vertical, depth in ((above, 1, position[:, 2]), (side, 2, -position[:, 1])):
        order = np.argsort(depth)
        points = axes.scatter(
            position[order, 0], position[order, vertical], c=speed[order], s=2.0, linewidths=0, cmap="viridis"
        )
        axes.set_aspect("equal")
        axes.set_ylabel(f"{'xyz'[vertical]} / mm")
    side.set_xlabel("x / mm")
    above.set_title(f"{len(speed):,} particles, from above and from the side", fontsize=10)
    sheet.colorbar(points, ax=[above, side], label="speed / (m/s)", shrink=0.7)
    sheet.savefig(DOCS / "images" / "full_size_section.png")


if __name__ == "__main__":
    main()
