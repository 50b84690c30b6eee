"""The path of a nozzle from G-code."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

WORD = re.compile(r"([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))")
MOVES = (0, 1)
MILLI = 1e-3
PER_MINUTE = MILLI / 60


class Course(NamedTuple):
    """A path in time, linear between its corners."""

    times: tuple[float, ...]
    """s, rising"""
    places: tuple[tuple[float, ...], ...]
    """m, with a coordinate for each axis"""
    volumes: tuple[float, ...]
    """m³, brought in since the start"""


def course_of(lines: list[str], section: float) -> Course:
    """The path of lines with G0 and G1 (X, Y, Z, E in mm, absolute; F in mm/min), G90, and G92 E.

    What follows ``;`` is a comment. The first line that gives X, Y and Z is where the path begins.

    Args:
        lines: of G-code.
        section: m³ for 1 mm of E.

    Raises:
        ValueError: one sentence on the first line that is not understood.
    """
    at: dict[str, float] = {}
    extruded, speed = 0.0, 0.0
    times, places, volumes = [0.0], [], [0.0]
    for number, line in enumerate(lines):
        text = line.split(";")[0].strip().upper()
        if not text:
            continue
        words = WORD.findall(text)
        if WORD.sub("", text).strip() or not words or words[0][0] != "G":
            raise ValueError(f"gcode.{number} is {line!r}; a line must be G0, G1, G90 or G92 with numbers")
        code, values = float(words[0][1]), {letter: float(value) for letter, value in words[1:]}
        if unknown := values.keys() - set("XYZEF"):
            raise ValueError(f"gcode.{number} has the word {min(unknown)}; known are X, Y, Z, E and F")
        if code == 92 and values.keys() <= {"E"}:
            extruded = values.get("E", 0.0)
        elif code in MOVES:
            speed = values.get("F", speed / PER_MINUTE) * PER_MINUTE
            before = dict(at)
            at |= {letter: MILLI * values[letter] for letter in "XYZ" if letter in values}
            if len(at) == 3:
                place = [at["X"], at["Y"], at["Z"]]
                fed = values.get("E", extruded) - extruded
                extruded += fed
                if len(before) < 3:
                    places.append(place)
                    continue
                _add(number, line, np.array(place), fed * section, speed, times, places, volumes)
        elif code != 90:
            raise ValueError(f"gcode.{number} is {line!r}; only G0, G1, G90 and G92 E are known")
    if len(places) < 2:
        raise ValueError("gcode has no move from one place to another; its first line must give X, Y and Z")
    return Course(tuple(times), tuple(map(tuple, places)), tuple(volumes))


def _add(
    number: int,
    line: str,
    place: np.ndarray,
    volume: float,
    speed: float,
    times: list[float],
    places: list,
    volumes: list[float],
) -> None:
    """One straight way of the path."""
    length = float(np.linalg.norm(place - np.array(places[-1])))
    if length == 0 and volume == 0:
        return
    if length == 0 or volume < 0:
        what = "moves nowhere" if length == 0 else "draws material back"
        raise ValueError(f"gcode.{number} is {line!r}, which {what}; a nozzle only pushes, on its way")
    if not speed > 0:
        raise ValueError(f"gcode.{number} is {line!r}, and no F has given a speed before")
    times.append(times[-1] + length / speed)
    places.append(place.tolist())
    volumes.append(volumes[-1] + volume)
