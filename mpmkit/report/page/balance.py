"""Section: mass, momentum and energy of the material, and the cause of each change."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray

from ..energies import CURVES
from .histories import listed, of_curves, rows_of
from .section import Section, note, pairs, table
from .section import charts as charts_side_by_side
from .source import Source
from .words import number, percent

CAUSES = {
    "start": "at the start",
    "in": "put in by sources",
    "out": "taken out by sinks",
    "gravity": "gravity",
    "walls": "walls",
    "forces": "other forces",
    "refinement": "splitting and merging of particles",
    "redistribution": "even spacing of particles",
    "rest": "rest",
}
"""The causes of the ledger in words; a cause of another name is shown by its name."""
ROUNDING = 1e-12
"""An entry below this part of the largest of its kind is shown as 0."""
VISIBLE = 1e-3
"""A curve below this part of the largest is left out."""
REST = "rest"


def section(source: Source) -> Section | None:
    """The ledger as a table and against time, and the energies of the material."""
    ledger = _ledger(source)
    drawn = {
        "energies": _energies(source),
        "causes": None if ledger is None else _energy_by_cause(source, ledger),
    }
    charts = {name: chart for name, chart in drawn.items() if chart is not None}
    said = [*_mass(source), *([] if ledger is None else _energy(ledger))]
    if not said and not charts:
        return None
    body = pairs(said)
    if ledger is not None:
        body += _table(source, ledger)
    body += charts_side_by_side({name: f"{of['title']} against time" for name, of in charts.items()})
    return Section("balance", "Balances", body, {"charts": charts})


def _ledger(source: Source) -> xarray.Dataset | None:
    """The ledger up to the last row; None for a run of a version without one."""
    history = source.results.history
    return history if "ledger_energy" in history and history.sizes["time"] else None


def _mass(source: Source) -> list[tuple[str, str]]:
    mass = source.results.series("total_mass")
    if mass is None:
        return []
    whole = {"axisymmetric": "of the whole body", "plane-strain": "of a slice 1 m thick"}
    of = whole.get(source.space.name, "of the part that is simulated")
    if source.results.series("mass_in") is not None:  # it may begin empty
        first, last = (f"{number(float(mass[row]), 4)} kg" for row in (0, -1))
        return [("Mass", f"{first} at the start, {last} at the end, {of}")]
    lost = (mass[-1] - mass[0]) / mass[0]
    change = "unchanged" if abs(lost) < 1e-9 else f"changed by {percent(lost)}"
    return [("Mass", f"{number(float(mass[0]), 4)} kg {of}; {change} from start to end")]


def _energy(ledger: xarray.Dataset) -> list[tuple[str, str]]:
    """What flow has dissipated, or what the method has created."""
    rest = float(ledger["ledger_energy"].isel(time=-1).sel(cause=REST))
    if not np.isfinite(rest):
        return []
    if rest <= 0:
        return [
            (
                "Energy lost in the flow",
                f"{number(-rest)} J, by viscosity, friction and the damping of the method",
            )
        ]
    return [("Created energy", f"{number(rest)} J: an error of the method")]


def _table(source: Source, ledger: xarray.Dataset) -> str:
    """A row for each cause, and the sums, which are the amounts at the end."""
    last = ledger.isel(time=-1)
    causes = [str(cause) for cause in ledger["cause"].values]
    columns = {"mass (kg)": last["ledger_mass"].values}
    for axis in map(str, ledger["component"].values):
        if axis != "r":  # not conserved along r: the hoop stress acts there
            columns[f"momentum along {axis} (N s)"] = last["ledger_momentum"].sel(component=axis).values
    columns["energy (J)"] = last["ledger_energy"].values
    sums = {heading: float(values.sum()) for heading, values in columns.items()}
    largest = {heading: float(np.abs(values).max()) for heading, values in columns.items()}

    def cells(entries: dict[str, float]) -> list[str]:
        return [_entry(value, largest[heading]) for heading, value in entries.items()]

    rows = [
        (CAUSES.get(cause, cause), *cells({heading: float(of[row]) for heading, of in columns.items()}))
        for row, cause in enumerate(causes)
    ]
    rows = [row for row in rows if any(cell != "0" for cell in row[1:])]
    rows.append(("sum: at the end", *cells(sums)))
    caption = "What has changed mass, momentum and energy from the start to the end"
    return table(["cause", *columns], rows, caption) + note(
        "The energy is kinetic, elastic and compressive; gravity adds what it releases. The rest of the "
        "energy is what the material has dissipated, with gains and losses of the method. The rest of mass "
        "and momentum is an error of rounding. Causes without a change are left out."
    )


def _entry(value: float, largest: float) -> str:
    return "0" if abs(value) <= ROUNDING * largest else number(value, 4)


def _energy_by_cause(source: Source, ledger: xarray.Dataset) -> dict[str, Any] | None:
    """What each cause has added so far."""
    rows = rows_of(source)
    energy = ledger["ledger_energy"].where(np.isfinite)
    entries = {str(cause): energy.sel(cause=cause).values for cause in ledger["cause"].values}
    largest = max(_largest(values) for values in entries.values())
    curves = [
        {"label": CAUSES.get(name, name), "values": listed(values[rows])}
        for name, values in entries.items()
        if _largest(values) > VISIBLE * largest
    ]
    return of_curves(source, "Energy by cause, from the start on", "J", curves)


def _largest(values: np.ndarray) -> float:
    return float(np.nanmax(np.abs(values), initial=0.0))


def _energies(source: Source) -> dict[str, Any] | None:
    results = source.results
    curves: dict[str, np.ndarray] = {}
    for name, (label, _) in CURVES.items():
        values = results.series(name)
        if values is not None and np.nanmax(np.abs(values)):
            curves[label] = values - np.nanmin(values) if name == "potential_energy" else values
    if len(curves) > 1:
        curves["sum"] = np.sum(list(curves.values()), axis=0)
    rows = rows_of(source)
    drawn = [{"label": label, "values": listed(values[rows])} for label, values in curves.items()]
    return of_curves(source, "Energies of the material", "J", drawn)
