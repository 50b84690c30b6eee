"""Hypothesis strategies of walls around the block of cells that holds the bodies of a case."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from fuzz_values import SCHEMA, logarithmic, value_of
from hypothesis import strategies as st

from mpmkit.spaces import SPACES

NAMES = ("mould", "floor_2", "x", "Plunger-1")


class Block(NamedTuple):
    """What walls stand around."""

    space: str
    lower: np.ndarray
    upper: np.ndarray
    cell: float
    until: float
    fastest: float
    """m/s, of a wall: far below the waves of the softest material"""

    @property
    def dim(self) -> int:
        return len(self.lower)

    @property
    def radial(self) -> bool:
        return SPACES[self.space].radial


def contacts() -> st.SearchStrategy[Any]:
    """Any registered contact, by its name or with parameters."""
    return value_of(SCHEMA["$defs"]["Wall"]["properties"]["contact"])


@st.composite
def walls(draw: st.DrawFn, block: Block) -> dict[str, Any]:
    """One to three walls that touch the block, or lie beside it, in any motion, at any time."""
    kinds = [planes, obstacles, containers]
    names = draw(st.lists(st.sampled_from(NAMES), min_size=1, max_size=3, unique=True))
    return {
        name: {"surface": draw(draw(st.sampled_from(kinds))(block)), "contact": draw(contacts())}
        for name in names
    }


@st.composite
def planes(draw: st.DrawFn, block: Block) -> dict[str, Any]:
    """A plane through the corner of the block that comes first along its normal."""
    normal = [draw(st.sampled_from([-1.0, -0.4, 0.0, 0.05, 1.0])) for _ in range(block.dim)]
    if not any(normal):
        normal[-1] = 1.0
    point = np.where(np.array(normal) > 0, block.lower, block.upper)
    surface = {"kind": "plane", "point": point.tolist(), "normal": normal}
    return surface | draw(_times(block)) | draw(_motions(block, point, arm=None))


@st.composite
def obstacles(draw: st.DrawFn, block: Block) -> dict[str, Any]:
    """A body that stands on the block, or under it, as wide as one to three cells."""
    size = block.cell * draw(st.sampled_from([1.0, 1.7, 3.0]))
    middle, on_top = (block.lower + block.upper) / 2, draw(st.booleans())
    if block.radial:
        middle[0] = 0.0
    middle[-1] = block.upper[-1] + size / 2 if on_top else block.lower[-1] - size / 2
    shape = draw(_shapes(middle, np.full(block.dim, size / 2), block.radial, inside=False))
    surface = {"kind": "body", "shape": shape, "side": "outside"}
    return surface | draw(_times(block)) | draw(_motions(block, middle, arm=size))


@st.composite
def containers(draw: st.DrawFn, block: Block) -> dict[str, Any]:
    """A body around the block, solid outside or a shell, some of its ends open."""
    middle, half = (block.lower + block.upper) / 2, (block.upper - block.lower) / 2
    if block.radial:
        middle[0], half[0] = 0.0, block.upper[0]
    shape = draw(_shapes(middle, half, block.radial, inside=True))
    surface = {"kind": "body", "shape": shape, "side": "inside"}
    if draw(st.booleans()):
        surface["thickness"] = block.cell * draw(st.sampled_from([1.0, 1.5, 4.0]))
        ends = {"cylinder": ["bottom", "top"], "frustum": ["bottom", "top"], "box": ["z_min", "z_max"]}
        if shape["kind"] in ends and draw(st.booleans()):
            surface["open"] = draw(st.lists(st.sampled_from(ends[shape["kind"]]), max_size=1))
    arm = 3 * float(np.linalg.norm(half)) + 4 * block.cell
    return surface | draw(_times(block)) | draw(_motions(block, middle, arm))


@st.composite
def _shapes(
    draw: st.DrawFn, middle: np.ndarray, half: np.ndarray, radial: bool, inside: bool
) -> dict[str, Any]:
    """A shape around a box (``inside``), or within it."""
    lower, upper = middle - half, middle + half
    kind = draw(st.sampled_from(["box", "sphere", "cylinder", "frustum"]))
    if kind == "box":
        lower = np.where(np.arange(len(half)) == 0, 0.0, lower) if radial else lower
        return {"kind": "box", "lower": lower.tolist(), "upper": upper.tolist()}
    if kind == "sphere":
        radius = float(np.linalg.norm(half)) if inside else float(half.min())
        return {"kind": "sphere", "centre": middle.tolist(), "radius": radius * (1.001 if inside else 1.0)}
    base = [*middle[:-1].tolist(), float(lower[-1])]
    radius = float(np.linalg.norm(half[:-1]) if inside else half[:-1].min()) * (1.001 if inside else 1.0)
    height = float(2 * half[-1])
    if kind == "cylinder":
        return {"kind": "cylinder", "radius": radius, "height": height, "base": base}
    wider = radius * draw(st.sampled_from([1.0, 1.5]))
    radii = {"bottom_radius": wider, "top_radius": radius} if draw(st.booleans()) else {
        "bottom_radius": radius, "top_radius": wider,
    }  # fmt: skip
    return {"kind": "frustum", **radii, "height": height, "base": base}


@st.composite
def _times(draw: st.DrawFn, block: Block) -> dict[str, float]:
    """When the wall is there: from the start, later, or up to a time."""
    found = {}
    if draw(st.integers(0, 3)) == 0:
        found["appears"] = block.until * draw(st.sampled_from([-1.0, 0.0, 1e-3, 0.5]))
    if draw(st.integers(0, 3)) == 0:
        found["vanishes"] = block.until * draw(st.sampled_from([0.6, 2.0]))
    return found


@st.composite
def _motions(draw: st.DrawFn, block: Block, middle: np.ndarray, arm: float | None) -> dict[str, Any]:
    """A motion, or none; ``arm``, m, is how far a body reaches from where it turns."""
    turns = arm is not None and not block.radial
    kind = draw(st.sampled_from(["rest", "velocity", "table", "oscillation", *["rotation"] * turns]))
    if kind == "rest":
        return {}
    speed = block.fastest * draw(st.sampled_from([0.1, 1.0]))
    towards = np.array([draw(st.sampled_from([-1.0, 0.0, 0.5])) for _ in range(block.dim)])
    if block.radial:
        towards[0] = 0.0
    towards *= speed / max(1.0, float(np.linalg.norm(towards)))
    time = draw(logarithmic(-5, 2))
    if kind == "table":
        times, places = [0.0, time, 1.5 * time], [0 * towards, time * towards, 0.8 * time * towards]
        return {"motion": {"kind": "table", "times": times, "positions": [p.tolist() for p in places]}}
    spell = {}
    if draw(st.booleans()):
        spell["start"] = draw(st.sampled_from([0.0, 1e-4, 0.5])) * block.until
    if draw(st.booleans()):
        spell["end"] = spell.get("start", 0.0) + time
    if kind == "velocity":
        return {"motion": {"kind": "velocity", "velocity": towards.tolist(), **spell}}
    if kind == "oscillation":
        amplitude = (towards * time / (2 * math.pi)).tolist()
        return {"motion": {"kind": "oscillation", "amplitude": amplitude, "frequency": 1 / time, **spell}}
    turn = {"kind": "rotation", "point": middle.tolist(), "rate": speed / arm, **spell}
    if block.dim == 3:
        turn["axis"] = draw(st.sampled_from([[0.0, 0.0, 1.0], [1.0, -2.0, 2.0]]))
    return {"motion": turn}
