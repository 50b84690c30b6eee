"""Write docs/accuracy.md, docs/images/accuracy_cures.png and docs/images/accuracy_sensitivity.png.

    python docs/figures/accuracy_runs.py && python docs/figures/accuracy_page.py

Made from what the runs left in runs/accuracy; none of them may be missing.
"""

import csv
import json

import numpy as np
from accuracy_runs import RUNS
from common import DOCS, REFERENCE
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from members import CELLS, CURES, EVERY, FLOORS, ORDERS, REGULARISATION, SOUND, STICK, STIFFNESS, Member
from options import parser, require

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")


class Result:
    """What a member's run left."""

    def __init__(self, member: Member) -> None:
        data = json.loads((RUNS / f"{member.name}.json").read_text())
        self.label = member.label
        self.time, self.spread, self.height, self.axis_height, self.energy = (
            np.array(data[key])
            for key in ("time", "spread_diameter", "height", "axis_height", "kinetic_energy")
        )
        self.particles, self.wall_time, self.stopped = data["particles"], data["wall_time"], data["stopped"]

    @property
    def t500(self) -> str:
        if self.spread[-1] < 0.5:
            return "–"
        first = int(np.argmax(self.spread >= 0.5))
        before, after = self.spread[first - 1 : first + 1]
        found = self.time[first - 1] + (0.5 - before) / (after - before) * (
            self.time[first] - self.time[first - 1]
        )
        return f"{found:.3f}"

    @property
    def departure(self) -> float:
        """Largest relative departure of D(t) from the reference, per cent."""
        time, spread = reference()
        return 100 * float(np.abs(self.spread / np.interp(self.time, time, spread) - 1).max())

    @property
    def energy_from_2_s(self) -> str:
        late = self.energy[self.time >= 2]
        return f"{late.max():.1e}" if len(late) else "–"

    def at(self, time: float) -> str:
        return f"{1e3 * np.interp(time, self.time, self.spread):.1f}" if time <= self.time[-1] else "–"


def reference() -> tuple[np.ndarray, np.ndarray]:
    with REFERENCE.open() as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return tuple(np.array([float(row[key]) for row in rows]) for key in ("time_s", "spread_diameter_m"))  # type: ignore[return-value]


def draw(axes: Axes, results: list[Result], title: str, exact: bool = True, until: float = 4.0) -> None:
    if exact:
        time, spread = reference()
        axes.plot(time, 1e3 * spread, "k--", lw=1.6, label="finite elements", zorder=5)
    for result, colour in zip(results, COLOURS, strict=False):
        axes.plot(result.time, 1e3 * result.spread, color=colour, lw=1.2, label=result.label)
    axes.set_title(title, fontsize=10, loc="left")
    axes.set(xlim=(0, until), xlabel="time (s)", ylabel="spread diameter (mm)")
    axes.grid(alpha=0.3)
    axes.legend(frameon=False, fontsize=7.5, loc="lower right")


def draw_departures(axes: Axes, results: list[Result], title: str) -> None:
    """D(t) over the reference, less one; a run that is off the scale leaves the picture."""
    time, spread = reference()
    axes.axhline(0.0, color="k", ls="--", lw=1.6)
    for result, colour in zip(results, COLOURS, strict=False):
        off = 100 * (result.spread / np.interp(result.time, time, spread) - 1)
        axes.plot(result.time, off, color=colour, lw=1.2)
    axes.set_title(title, fontsize=10, loc="left")
    axes.set(xlim=(0, 4), ylim=(-3, 3), xlabel="time (s)", ylabel="departure from the reference (%)")
    axes.grid(alpha=0.3)


def sheet(name: str, panels: list[tuple], columns: int) -> None:
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(5.2 * columns, 3.9 * rows), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    for number, panel in enumerate(panels):
        painter, *arguments = panel if callable(panel[0]) else (draw, *panel)
        painter(figure.add_subplot(rows, columns, number + 1), *arguments)
    figure.savefig(DOCS / "images" / f"accuracy_{name}.png")


def table(results: list[Result], first: str) -> str:
    lines = [
        f"| {first} | T500 (s) | largest departure | D at 0.5, 1, 2, 4 s (mm) | final height, largest and on "
        "the axis (mm) | energy from 2 s on (J) | particles at the end | wall time (s) |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for r in results:
        ended = "" if r.stopped is None else f" (stopped at {r.time[-1]:g} s)"
        spreads = ", ".join(r.at(t) for t in (0.5, 1, 2, 4))
        lines.append(
            f"| {r.label}{ended} | {r.t500} | {r.departure:.2f} % | {spreads} | "
            f"{1e3 * r.height[-1]:.1f}, {1e3 * r.axis_height[-1]:.1f} | {r.energy_from_2_s} | "
            f"{r.particles:,} | {r.wall_time:.0f} |"
        )
    return "\n".join(lines)


def spreads(results: list[Result], first: str) -> str:
    times = (0.1, 0.2, 0.5, 1.0, 2.0, 4.0)
    lines = [f"| {first} | " + " | ".join(f"{t:g} s" for t in times) + " |", "|---" * (len(times) + 1) + "|"]
    lines += [f"| {r.label} | " + " | ".join(r.at(t) for t in times) + " |" for r in results]
    return "\n".join(lines)


def main() -> None:
    parser().parse_args()
    require(RUNS / f"{member.name}.json" for member in EVERY)
    groups = {
        name: [Result(m) for m in members]
        for name, members in (
            ("cures", CURES),
            ("cells", CELLS),
            ("sound", SOUND),
            ("stiffness", STIFFNESS),
            ("regularisation", REGULARISATION),
            ("floors", FLOORS),
            ("orders", ORDERS),
            ("stick", STICK),
        )
    }
    sheet(
        "cures",
        [
            (groups["cures"], "One cure after the other, 5 mm"),
            (draw_departures, groups["cures"], "The same, over the reference"),
        ],
        2,
    )
    sheet(
        "sensitivity",
        [
            (groups["cells"], "Cell size"),
            (groups["sound"], "Sound speed, 10 mm"),
            (groups["stiffness"], "Elastic modulus below yield, 10 mm"),
            (groups["regularisation"], "Regularised instead of exact, 10 mm"),
            (groups["floors"], "Floor, 10 mm", False),
            (groups["stick"], "Stick floor: cell size", False),
        ],
        2,
    )
    page = (DOCS / "figures" / "accuracy.template.md").read_text(encoding="utf-8")
    for name, results in groups.items():
        page = page.replace(f"{{{{table {name}}}}}", table(results, "run"))
        page = page.replace(f"{{{{spreads {name}}}}}", spreads(results, "run"))
    (DOCS / "accuracy.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
