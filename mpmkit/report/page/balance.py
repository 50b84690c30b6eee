"""Section: where energy and mass went, and what the walls gave."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..energies import CURVES
from ..wall_forces import charts_of, chosen_of
from .histories import listed, of_curves, rows_of
from .section import Section, note, pairs
from .section import charts as charts_side_by_side
from .source import Source
from .words import number, percent

NEGLIGIBLE = 1e-4
"""Part of the largest figure below which a chart or a curve would show nothing but noise."""


def section(source: Source) -> Section | None:
    """The balance in figures, the energies, and forces of walls."""
    charts = {}
    if energies := _energies(source):
        charts["energies"] = energies
    charts |= _walls(source)
    said = [*_mass(source), *_energy(source)]
    if not said and not charts:
        return None
    body = pairs(said)
    body += charts_side_by_side({name: f"{of['title']} against time" for name, of in charts.items()})
    if any(name.startswith("wall") for name in charts):
        body += note(
            "Forces, torques and powers are those of the walls on the material: means over the time between "
            "two rows of the history."
        )
    return Section("balance", "Balance of mass and energy", body, {"charts": charts})


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


def _walls(source: Source) -> dict[str, dict[str, Any]]:
    """A chart for each component of force, for torque and power where there is any."""
    results = source.results
    if "wall_force" not in results.history or len(results.time) < 3:
        return {}
    charts = charts_of(results)
    if not charts:
        return {}
    largest = max(np.abs(of.values).max() for of in charts)
    charts = [of for of in charts if np.abs(of.values).max() > NEGLIGIBLE * largest]
    rows, (chosen, _) = rows_of(source), chosen_of(charts)
    names = [str(name) for name in results.history["wall"].values]
    found = {}
    for count, (label, values) in enumerate(charts):
        title, _, unit = label.rpartition(" (")
        whole = np.vstack([np.full((1, values.shape[1]), np.nan), values])[rows]
        curves = [
            {"label": _wall_name(names[wall], results.case), "values": listed(whole[:, wall])}
            for wall in chosen
            if np.abs(values[:, wall]).max() > NEGLIGIBLE * np.abs(values).max()
        ]
        if drawn := of_curves(source, f"Walls: {title}", unit.rstrip(")"), curves):
            found[f"wall-{count}"] = drawn
    return found


def _wall_name(name: str, case: dict[str, Any]) -> str:
    return f"wall {name}" if name in case.get("walls", {}) else f"face {name}"


def _mass(source: Source) -> list[tuple[str, str]]:
    mass = source.results.series("total_mass")
    if mass is None:
        return []
    lost = (mass[-1] - mass[0]) / mass[0]
    whole = {"axisymmetric": "of the whole body", "plane-strain": "of a slice 1 m thick"}
    of = whole.get(source.space.name, "of the part that is simulated")
    change = "unchanged" if abs(lost) < 1e-9 else f"changed by {percent(lost)}"
    found = [("Mass", f"{number(float(mass[0]), 4)} kg {of}; {change} from start to end")]
    for name, said in (("mass_in", "put in by sources"), ("mass_out", "taken out by sinks")):
        values = source.results.series(name)
        if values is not None and values[-1]:
            found.append((f"Mass {said}", f"{number(float(values[-1]), 4)} kg"))
    return found


def _energy(source: Source) -> list[tuple[str, str]]:
    """What came in and what is left, so that the rest is what the flow turned into heat."""
    results = source.results
    present = {name: values for name in CURVES if (values := results.series(name)) is not None}
    if not present:
        return []
    if _has_no_balance(source):
        said = "none, since the history does not tell what gravity does along a periodic axis"
        if _flows(source):
            said = "none, since the history does not tell the energy of what flows in and out"
        return [("Balance of energy", said)]
    found = []
    potential = present.get("potential_energy")
    if potential is not None and potential.any():
        found.append(("Energy set free by gravity", f"{number(float(potential[0] - potential[-1]))} J"))
    if worked := _work_of_walls(source):
        found.append(("Energy from moving walls", f"{number(worked)} J"))
    put_in = results.series("redistribution_energy")
    moved = 0.0 if put_in is None else float(put_in[-1])
    start, end = (sum(float(values[row]) for values in present.values()) for row in (0, -1))
    lost = start + worked + moved - end
    if lost >= 0:
        said = f"{number(lost)} J, by viscosity, friction and the damping of the method"
        found.append(("Energy lost in the flow", said))
    else:
        found.append(("Created energy", f"{number(-lost)} J: an error of the method"))
    if moved:
        said = f"{number(moved)} J, by shifting particles so that they stay evenly spread"
        found.append(("Energy put in by the method", said))
    return found


def _has_no_balance(source: Source) -> bool:
    """Whether energy comes in or goes out in a way that no variable of the history tells."""
    case = source.results.case
    faces, gravity = case["grid"].get("faces", {}), case.get("gravity") or []
    along_periodic = any(
        pull and faces.get(f"{axis}_min") == "periodic"
        for axis, pull in zip(source.space.axes, gravity, strict=False)
    )
    return along_periodic or _flows(source)


def _flows(source: Source) -> bool:
    """Whether material flows in or out."""
    case = source.results.case
    return bool(case.get("sources") or case.get("sinks"))


def _work_of_walls(source: Source) -> float:
    """∫ power dt, J: a row holds the mean since the row before."""
    history = source.results.history
    if "wall_power" not in history:
        return 0.0
    power = np.nan_to_num(history["wall_power"].values.sum(axis=1), posinf=0.0, neginf=0.0)
    return float(np.sum(power[1:] * np.diff(source.results.time)))
