"""Draw docs/images/comparisons/shapes.png: linear hats and cpGIMP on a slump, a bar, and a bar that falls.

    for name in schemes_slump schemes_bar falling_bar shapes; do mpmkit study cases/studies/$name.json; done
    python docs/figures/comparisons/shapes.py

The studies take about five minutes of one core, the figure a second; with --draw it needs no runs.
"""

import xarray
from shared import ORDERS, SHAPES, data, panels, reference, save, say

PULL, MASS = 0.02, 12.5
"""Acceleration of the falling bar, m/s², and its mass, kg."""


def main() -> None:
    slump, bar, falling, particles = data(
        schemes_slump=["spread_diameter", "t500", "final_spread"],
        schemes_bar=["kinetic_energy", "strain_energy"],
        falling_bar=["kinetic_energy", "strain_energy"],
        shapes=["spread_diameter", "t500", "particles"],
    )
    sheet, (spread, t500, energy, fall) = panels(2, "Linear hats and cpGIMP", rows=2)

    time, exact = reference()
    spread.plot(time, 1e3 * exact, "k--", lw=1, label="finite elements")
    runs = 1e3 * slump.spread_diameter.sel(cells="10 mm")
    for shape, style in SHAPES.items():
        spread.plot(
            slump.time, runs.sel(step="0.4", shape=shape, order="USF"), label=f"{shape}, USF", **style
        )
    last(spread, runs.sel(step="0.1", shape="linear", order="USL"), "linear, USL, step 0.1", "#E69F00")
    spread.set(xlim=(0, 1.5), ylim=(180, 590))
    say(spread, "Slump, 10 mm, 4 particles per cell", "time / s", "spread diameter / mm")

    for cells, line in (("20 mm", "--"), ("10 mm", "-")):
        for shape, style in SHAPES.items():
            found = particles.t500.sel(cells=cells, shape=shape)
            counts = found["bodies.0.particles_per_cell"].astype(int)
            t500.plot(counts, found, line, marker="o", ms=3, label=f"{shape}, {cells}", **style)
    t500.axhspan(0.606, 0.612, color="k", alpha=0.2, lw=0, label="finite elements")
    t500.set(ylim=(0.6, 0.68), xticks=counts)
    say(t500, "Slump, USF", "particles per cell", "T500 / s")

    total = (bar.kinetic_energy + bar.strain_energy).sel(cells="50 cells, 2 particles")
    for_each(energy, total / total[..., 0], once=20)
    energy.set_ylim(0.985, 1.017)
    say(energy, "Vibrating bar, 50 cells", "time / s", "energy over the initial one")

    fallen = falling.sel(fall="falling")
    own = fallen.kinetic_energy + fallen.strain_energy - MASS * (PULL * fallen.time) ** 2 / 2
    for_each(fall, own / own[..., 0], once=20)
    fall.set_ylim(0.5, 1.9)
    say(fall, "Bar that falls through 50 cells", "time / s", "energy about its centre, over the initial")

    for plot in (spread, t500, energy, fall):
        plot.legend(frameon=False, fontsize=7, ncols=1 if plot is spread else 2)
    save(sheet, "shapes")


def for_each(plot, values: xarray.DataArray, once: int) -> None:
    """Energy by shape and order, once a period, as far as a run came."""
    for shape, style in SHAPES.items():
        for order, lines in ORDERS.items():
            run = values.sel(shape=shape, order=order).dropna("time")
            if len(run) > once:
                plot.plot(run.time[::once], run[::once], label=f"{shape}, {order}", **(lines | style))
            else:
                last(plot, run, f"{shape}, {order}", style["color"])


def last(plot, run: xarray.DataArray, label: str, color: str) -> None:
    """A run that was stopped, with a cross at its end."""
    run = run.dropna("time")[:-1]  # the last row is what the guard refused
    plot.plot(run.time, run, color=color, lw=1)
    plot.plot(run.time[-1:], run[-1:], "x", color=color, label=f"{label}: stopped")


if __name__ == "__main__":
    main()
