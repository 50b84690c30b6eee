"""Section: the main results of the run."""

from __future__ import annotations

from html import escape

import numpy as np

from ...case.ending import latest
from ...output import RunDirectory
from ...output.checkpoints import Checkpoints
from ...output.summary import (
    AT_REST,
    CONDITION,
    FINISHED,
    LEAST_RATE,
    T500_DIAMETER,
    lifted_later,
    trusted_to_the_end,
)
from . import mass_flow
from .section import Section, paragraph
from .source import Source
from .words import count, duration, length, number, seconds, unit_of

ENDED = {
    FINISHED: "The run came to its end",
    AT_REST: "The run ended, because the material is at rest,",
    CONDITION: "The run ended, because a condition of until was met,",
    "interrupted": "The run was interrupted",
    "output-error": "The run stopped, because its files could not be written",
}
CONTINUE = "To continue the run: mpmkit run --resume DIRECTORY."


def section(source: Source) -> Section:
    """How the run ended, and its main results, each with an explanation."""
    cards = "".join(
        f'<div class="card"><dt>{escape(name)}</dt><dd><strong>{escape(value)}</strong>'
        f"<span>{escape(text)}</span></dd></div>"
        for name, value, text in figures(source)
    )
    return Section(
        "headline", "Results", f'{paragraph(_ending(source), "lead")}<dl class="cards">{cards}</dl>'
    )


def _ending(source: Source) -> str:
    """One or two sentences on how the run ended."""
    summary, time = source.results.summary, source.results.time
    if source.running:
        until = latest(source.results.case["until"])
        return f"The run is in progress: t = {seconds(float(time[-1]))} of {number(until)} s."
    why, end = summary["stopped_because"], summary.get("simulated_time") or 0.0
    if not trusted_to_the_end(why):
        errors = [said.text for said in source.last_start if said.level == "ERROR"]
        return (
            f"A guard stopped the run at t = {seconds(end)} ({why}): do not trust its last state; "
            f"there are no final results. {errors[-1] if errors else ''}"
        ).strip()
    can_continue = why == "interrupted" and Checkpoints(RunDirectory(source.directory).checkpoints).paths()
    further = f" {CONTINUE}" if can_continue else ""
    state = _state(source) if end > 0 else "The material had not moved yet."
    return f"{ENDED[why]} at t = {seconds(end)}. {state}{further}"


def _state(source: Source) -> str:
    """Whether the material still moves at the end."""
    summary = source.results.summary
    since, rate = summary.get("at_rest_since"), summary.get("final_spread_rate")
    if since is not None:
        return f"The material has been at rest since t = {seconds(since)}."
    if _spreads(source) and rate is not None and rate > LEAST_RATE:
        return f"The material was still spreading, at {number(1e3 * rate)} mm/s: it has no final shape yet."
    return "The material was still moving."


def figures(source: Source) -> list[tuple[str, str, str]]:
    """Name, value and explanation of each result; the value is "never" for an event that did not occur."""
    found = []
    if _spreads(source):
        found += [_spread(source), *_t500(source), _slump(source)]
    else:
        found += _extent(source)
    found += [_height(source), *_measurements(source), *mass_flow.figures(source), _speed(source)]
    if not source.running:
        summary = source.results.summary
        took = duration(summary["wall_time"])
        text = f"{count(summary['particles'])} particles, {count(summary['steps'])} steps"
        found.append(("Computing time", took, text))
    return [figure for figure in found if figure is not None]


def _spreads(source: Source) -> bool:
    """Whether the scene is one of a slump test: a body that can spread over a floor to all sides."""
    case, vertical = source.results.case, source.space.axes[-1]
    if source.space.name == "plane-strain":
        return False
    gravity = case.get("gravity")
    falls = gravity is None or gravity[-1] < 0 or bool(case.get("forces"))
    closed = case["grid"].get("faces", {}).get(f"{vertical}_min", "open") not in ("open", "periodic")
    return falls and closed and source.results.series("spread_diameter") is not None


def _last(source: Source, name: str) -> float | None:
    values = source.results.series(name)
    return None if values is None or not np.isfinite(values[-1]) else float(values[-1])


def _spread(source: Source) -> tuple[str, str, str]:
    early = source.results.summary.get("stopped_because") in ("interrupted", "output-error")
    name = "Spread now" if source.running else "Spread so far" if early else "Final spread"
    if source.results.stopped_by_guard or (value := _last(source, "spread_diameter")) is None:
        return name, "none", "the material did not reach a final shape"
    return name, length(value), "diameter of the material on the floor, as in a slump-flow test"


def _t500(source: Source) -> list[tuple[str, str, str]]:
    """T500, if the spread can reach 500 mm; also counted from the lift, if a mould is lifted later."""
    summary, spread = source.results.summary, source.results.series("spread_diameter")
    assert spread is not None
    limit, largest = length(T500_DIAMETER), length(float(np.nanmax(spread)))
    if source.running:
        return []
    if summary.get("t500") is None:
        wide = spread[0] >= T500_DIAMETER
        said = (
            f"the material was wider than {limit} from the start"
            if wide
            else f"the spread never reached {limit}; the largest was {largest}"
        )
        return [("T500", "never", said)]
    found = [("T500", seconds(summary["t500"]), f"time from t = 0 until the spread reached {limit}")]
    if lifted_later(summary):
        said = f"time from the start of the lift until the spread reached {limit}, as EN 12350-8 counts it"
        found.append(("T500 from the lift", seconds(summary["t500_from_lift"]), said))
    return found


def _slump(source: Source) -> tuple[str, str, str] | None:
    value = _last(source, "slump")
    empty = not source.results.case["bodies"]  # a scene that is empty at the start has no initial height
    if value is None or empty or source.results.stopped_by_guard:
        return None
    return "Slump", length(value), "how far the top of the material sank, on its axis"


def _extent(source: Source) -> list[tuple[str, str, str]]:
    """The width; for a scene that is not a slump test."""
    value = _last(source, "spread_diameter")
    if value is None or source.results.stopped_by_guard:
        return []
    return [("Width", length(value), f"of the material along the horizontal axes, {_when(source)}")]


def _height(source: Source) -> tuple[str, str, str] | None:
    value = _last(source, "height")
    if value is None or source.results.stopped_by_guard:
        return None
    return (
        "Height",
        length(value),
        f"of the highest point of the material, {_when(source)}",
    )


def _measurements(source: Source) -> list[tuple[str, str, str]]:
    """What the case measures: what an apparatus would report."""
    if source.results.stopped_by_guard:
        return []
    found = []
    for name, measurement in source.results.case.get("measurements", {}).items():
        value, unit, label = _last(source, name), unit_of(measurement["unit"]), name.replace("_", " ")
        shown = "none"
        if value is not None:
            shown = length(value) if unit == "m" else f"{number(value)} {unit}".rstrip()
        said = f"{measurement['description']}, {_when(source)}"
        found.append((f"{label[:1].upper()}{label[1:]}", shown, said))
    return found


def _when(source: Source) -> str:
    return "now" if source.running else "at the end"


def _speed(source: Source) -> tuple[str, str, str] | None:
    speed = source.results.series("max_speed")
    if speed is None:
        return None
    at = int(np.nanargmax(speed))
    when = seconds(float(source.results.time[at]))
    return "Largest speed", f"{number(float(speed[at]))} m/s", f"of any part of the material, at t = {when}"
