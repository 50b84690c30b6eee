"""Section: the numerical method in plain words, and warnings."""

from __future__ import annotations

import re

import numpy as np

from .section import Section, bullets, folded, note, pairs
from .source import Source
from .words import count, length, number, percent, seconds

LIMITED = re.compile(r"step \S+ s \(\S+ of the (?P<limit>[\w-]+) limit\)")
"""The log message about the time step at the start of a run."""
LIMITS = {
    "acoustic": "how fast sound crosses a cell",
    "viscous": "how fast viscosity spreads a velocity over a cell",
    "advective": "how fast the material crosses a cell",
    "forces": "how fast a force changes",
}
KINDS = {
    "shape": "Between particles and grid",
    "order": "Order of a step",
    "velocity": "Velocity of particles",
    "volumetric": "Pressure",
    "redistribution": "Even spacing",
    "refinement": "Splitting of particles",
}
"""The role of each plug-in of a scheme, in words."""
FRACTURED = 0.01
"""Part of the volume in stretched particles above which the page says so."""
MACH = 0.1
DENSE = 0.05
"""Difference between the density and that of the material above which the page says so."""


def section(source: Source) -> Section:
    """Method, sizes, and all warnings of the log."""
    careful = [*_warnings(source), *_observations(source)]
    body = (
        bullets(careful, "careful")
        if careful
        else note("The run gave no warning, and its checks found nothing.")
    )
    body = f"<h3>Cautions</h3>{body}<h3>Method</h3>{pairs(_facts(source))}"
    if remarks := _remarks(source):
        body += folded("Messages of the run at its start", bullets(remarks))
    return Section("numerics", "Numerics and cautions", body)


def _warnings(source: Source) -> list[str]:
    said = [line.text for line in source.last_start if line.level in ("WARNING", "ERROR")]
    return [_sentence(text) for text in dict.fromkeys(said) if text]


def _observations(source: Source) -> list[str]:
    """Problems that the history shows, even if the log gave no warning about them."""
    results, found = source.results, []
    mach = results.series("mach_number")
    if mach is not None and (most := float(np.nanmax(mach))) > MACH:
        found.append(
            f"The material moved at up to {number(most, 2)} of its artificial sound speed: above {MACH:g} it "
            "behaves as a compressible one."
        )
    apart = results.series("fractured_fraction")
    if apart is not None and (most := float(np.nanmax(apart))) > FRACTURED:
        found.append(
            f"Up to {percent(most)} of the volume was in particles stretched to more than a cell. There the "
            "material breaks apart for numerical reasons, not for physical ones."
        )
    density = results.series("density_mean")
    if density is not None and (most := float(np.nanmax(np.abs(density - 1)))) > DENSE:
        found.append(f"The mean density inside the material was wrong by up to {percent(most)}.")
    return found


def _remarks(source: Source) -> list[str]:
    """Log messages before the first step that the page does not show elsewhere."""
    said = [line.text for line in source.last_start if line.level == "INFO"]
    begun = [row for row, text in enumerate(said) if ": " in text and " particles, step " in text]
    if not begun:
        return []
    after = said[begun[0] + 1 :]
    ends = [row for row, text in enumerate(after) if re.match(r"\S+ after \d+ steps, t = ", text)]
    return [_sentence(text) for text in after[: ends[0] if ends else None]]


def _sentence(text: str) -> str:
    """A line of the log as a sentence; a name at its start, such as bodies.0, is not changed."""
    word = text.split(maxsplit=1)[0]
    begin = text if any(mark in word for mark in "._'") else f"{text[0].upper()}{text[1:]}"
    return begin if begin.endswith(".") else f"{begin}."


def _facts(source: Source) -> list[tuple[str, str]]:
    case, summary = source.results.case, source.results.summary
    grid, axes = case["grid"], source.space.axes
    counts = [round((grid["domain"][a][1] - grid["domain"][a][0]) / grid["cell_size"]) for a in axes]
    found = [
        ("Space", SPACE[case["space"]]),
        ("Cells", f"{' × '.join(map(str, counts))} of {length(grid['cell_size'])}"),
    ]
    found += _particles(source)
    found += _time_step(source)
    if summary:
        found.append(("Steps", count(summary["steps"])))
    scheme = case["scheme"]
    for kind, words in KINDS.items():
        if (chosen := scheme.get(kind)) is not None:
            found.append((words, chosen["name"] if isinstance(chosen, dict) else str(chosen)))
    return found


SPACE = {
    "3d": "three dimensions",
    "plane-strain": "a vertical slice: nothing changes across it",
    "axisymmetric": "a body of revolution, computed in its half section and drawn whole",
}


def _particles(source: Source) -> list[tuple[str, str]]:
    summary = source.results.summary
    begun = [m for line in source.log if (m := re.search(r": (\d+) particles, step ", line.text))]
    if not summary or not begun:
        return []
    first, last = int(begun[0][1]), summary["particles"]
    change = "" if first == last else f" at the start, {count(last)} at the end"
    return [("Particles", f"{count(first)}{change}")]


def _time_step(source: Source) -> list[tuple[str, str]]:
    step = source.results.series("time_step")
    if step is None:
        return []
    low, high = float(np.nanmin(step[:-1])), float(np.nanmax(step))
    said = seconds(low) if high < 1.01 * low else f"{seconds(low)} to {seconds(high)}"
    limits = [match["limit"] for line in source.log if (match := LIMITED.search(line.text))]
    if limits:
        said += f"; limited by {LIMITS.get(limits[-1], limits[-1])} (the {limits[-1]} limit), at the start"
    return [("Time step", said)]
