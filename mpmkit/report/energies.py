"""Picture: the energies of the material against time."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from .run_results import RunResults
from .style import BLUE, GREEN, GREY, ORANGE, VERMILION, line_chart

CURVES = {
    "potential_energy": ("potential, above its lowest", BLUE),
    "kinetic_energy": ("kinetic", VERMILION),
    "strain_energy": ("elastic strain", GREEN),
    "compressive_energy": ("compressive", ORANGE),
}


def draw(results: RunResults) -> Figure | None:
    """The energies, J, that are not zero throughout, and their sum, whose fall is what flow dissipated."""
    curves = {name: values for name in CURVES if (values := _energy(results, name)) is not None}
    if not curves:
        return None
    figure, axes = line_chart(f"{results.title}: energies", "energy (J)")
    if len(curves) > 1:
        axes.plot(results.time, sum(curves.values()), color=GREY, linestyle=(0, (5, 2)), label="sum")
    for name, values in curves.items():
        label, colour = CURVES[name]
        axes.plot(results.time, values, color=colour, label=label)
    axes.set_ylim(bottom=min(0, axes.get_ylim()[0]) if min(map(np.nanmin, curves.values())) < 0 else 0)
    # Outside the axes: in every corner, the curves of some case pass.
    figure.legend(loc="outside lower center", ncols=3)
    return figure


def _energy(results: RunResults, name: str) -> np.ndarray | None:
    values = results.series(name)
    if values is None or not np.nanmax(np.abs(values)):
        return None
    # The zero of the potential energy depends on the axes of the case: use its lowest value instead.
    return values - np.nanmin(values) if name == "potential_energy" else values
