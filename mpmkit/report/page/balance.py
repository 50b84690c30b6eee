"""Section: the balances of mass and energy, and the forces of the walls."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...case.model import STANDARD_GRAVITY
from ..energies import CURVES
from ..wall_forces import charts_of, chosen_of
from .histories import listed, of_curves, rows_of
from .section import Section, note, pairs
from .section import charts as charts_side_by_side
from .source import Source
from .words import number, percent

NEGLIGIBLE = 1e-4
"""A chart or curve below this part of the largest value is left out: it shows only noise."""
LAST = 0.1
"""The final force is the mean over this last part of the rows."""


def section(source: Source) -> Section | None:
    """The balance in figures, the energies, and forces of walls."""
    charts = {}
    if energies := _energies(source):
        charts["energies"] = energies
    charts |= _walls(source)
    said = [*_mass(source), *_weight(source), *_energy(source)]
    if not said and not charts:
        return None
    body = pairs(said)
    body += charts_side_by_side({name: f"{of['title']} against time" for name, of in charts.items()})
    if any(name.startswith("wall") for name in charts):
        body += note(
            "The charts show force, torque and power of the walls on the material. Each value is the mean "
            "over the time between two rows of the history."
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
    """A chart for each component of force, and for torque and power if they are not zero."""
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
    comes_in = source.results.series("mass_in") is not None
    whole = {"axisymmetric": "of the whole body", "plane-strain": "of a slice 1 m thick"}
    of = whole.get(source.space.name, "of the part that is simulated")
    if comes_in:
        first, last = (f"{number(float(mass[row]), 4)} kg" for row in (0, -1))
        found = [("Mass", f"{first} at the start, {last} at the end, {of}")]
    else:
        lost = (mass[-1] - mass[0]) / mass[0]
        change = "unchanged" if abs(lost) < 1e-9 else f"changed by {percent(lost)}"
        found = [("Mass", f"{number(float(mass[0]), 4)} kg {of}; {change} from start to end")]
    for name, said in (("mass_in", "put in by sources"), ("mass_out", "taken out by sinks")):
        values = source.results.series(name)
        if values is not None and values[-1]:
            names = " and ".join(source.results.case.get("sources" if name == "mass_in" else "sinks", {}))
            found.append((f"Mass {said}", f"{number(float(values[-1]), 4)} kg ({names})"))
    return found


def _weight(source: Source) -> list[tuple[str, str]]:
    """The weight of the material, and the vertical force of the walls at the end."""
    history, mass = source.results.history, source.results.series("total_mass")
    gravity = source.results.case.get("gravity") or [0.0, -STANDARD_GRAVITY]
    rows, upright = len(source.results.time), gravity[-1] < 0 and not any(gravity[:-1])
    if not upright or mass is None or "wall_force" not in history or rows < 3:
        return []
    vertical = history["wall_force"].values[..., -1].sum(axis=1)[-max(1, round(LAST * rows)) :]
    return [
        ("Weight", f"{number(-float(mass[-1]) * gravity[-1])} N"),
        (
            "Walls carry",
            f"{number(float(np.mean(vertical)))} N upwards, mean over the last tenth of the run; "
            "if the material is at rest, this equals the weight",
        ),
    ]


def _energy(source: Source) -> list[tuple[str, str]]:
    """Energy added and energy left; the difference is the energy that the flow dissipated."""
    results = source.results
    present = {name: values for name in CURVES if (values := results.series(name)) is not None}
    if not present:
        return []
    if _has_no_balance(source):
        said = "not available: the history does not record the work of gravity along a periodic axis"
        if _flows(source):
            said = "not available: the history does not record the energy of material that flows in and out"
        return [("Balance of energy", said)]
    found = []
    potential = present.get("potential_energy")
    if potential is not None and potential.any():
        found.append(("Energy released by gravity", f"{number(float(potential[0] - potential[-1]))} J"))
    if worked := _work_of_walls(source):
        which = "from" if worked > 0 else "taken by"
        found.append((f"Energy {which} moving walls", f"{number(abs(worked))} J"))
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
    """Whether energy enters or leaves in a way that the history does not record."""
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
    """∫ power dt, J; each row holds the mean power since the previous row."""
    history = source.results.history
    if "wall_power" not in history:
        return 0.0
    power = np.nan_to_num(history["wall_power"].values.sum(axis=1), posinf=0.0, neginf=0.0)
    return float(np.sum(power[1:] * np.diff(source.results.time)))
