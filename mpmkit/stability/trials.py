"""Section of the page of a map: what the trials at the limit of stability did."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..report.page.histories import listed
from ..report.page.section import Section, charts, folded, note
from .bisect import FINE, Critical
from .judge import distances
from .trial import ROWS, Trace


@dataclass(frozen=True)
class Trials:
    """The trials of a combination that show its limit; None where there is none, or where it failed."""

    fine: Trace | None
    stable: Trace | None
    unstable: Trace | None

    @classmethod
    def of(cls, found: Critical, kept: Mapping[float, Trace]) -> Trials:
        """Those of a result, of all trials by their fractions."""
        stable = kept.get(found.fraction) if found.fraction > FINE else None
        return cls(kept.get(FINE), stable, kept.get(found.unstable) if found.unstable > FINE else None)


def section(rows: Sequence[dict], names: Sequence[str], trials: Sequence[Trials]) -> Section | None:
    """Energy, and distance from the fine solution, of the trials of each combination against time."""
    body = ""
    found: dict[str, dict[str, Any]] = {}
    for number, (row, name, tried) in enumerate(zip(rows, names, trials, strict=True)):
        drawn = _charts(row, tried)
        if not drawn:
            continue
        labels = {f"{kind}-{number}": f"{of['title']} of {name}" for kind, of in drawn.items()}
        found |= {f"{kind}-{number}": of for kind, of in drawn.items()}
        body += folded(name, charts(labels))
    if not found:
        return None
    said = (
        f"The fine solution has steps of {FINE:g} of the limit. A trial that creates energy, or that "
        "ends far from the fine solution, is unstable. A curve ends where a guard stopped the trial."
    )
    return Section("trials", "Trials", note(said) + body, {"charts": found})


def _charts(row: dict, tried: Trials) -> dict[str, dict[str, Any]]:
    if tried.fine is None or len(tried.fine.time) < ROWS:
        return {}
    fine, time = tried.fine, tried.fine.time
    near = {
        f"largest stable step, {row['fraction']:.3g}": tried.stable,
        f"smallest unstable step, {row['unstable']:.3g}": tried.unstable,
    }
    present = {label: trace for label, trace in near.items() if trace is not None}
    shown = {"fine solution": fine} | present
    energy = [_curve(label, trace, trace.energy, time) for label, trace in shown.items()]
    apart = [
        _curve(label, trace, distances(trace, fine), time)
        for label, trace in shown.items()
        if trace.position.shape[1:] == fine.position.shape[1:]
    ]
    return {
        "energy": _chart("Energy of the material", "J", time, energy),
        "apart": _chart("Distance from the fine solution, RMS", "m", time, apart),
    }


def _curve(label: str, trace: Trace, values: np.ndarray, time: np.ndarray) -> dict[str, Any]:
    """A curve at the times of the fine solution; nothing after a guard stopped the trial."""
    at, finite = trace.time[: len(values)], np.isfinite(values)
    if not finite.any():
        return {"label": label, "values": [None] * len(time)}
    end = time[-1] if len(at) == ROWS and finite.all() else at[finite][-1] * (1 + 1e-9)
    shown = np.interp(time, at[finite], values[finite])
    return {"label": label, "values": listed(np.where(time <= end, shown, np.nan))}


def _chart(title: str, unit: str, time: np.ndarray, curves: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "title": title,
        "unit": unit,
        "x": listed(time),
        "xLabel": "time",
        "xUnit": "s",
        "curves": curves,
    }
