"""Scenes whose particles lie on a lattice turned with a wall, or inside a curve."""

from __future__ import annotations

import math
from unittest import mock

import numpy as np

import mpmkit
from mpmkit.geometry import Sample
from mpmkit.solver import scene


def axes(degrees: float) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors along a wall that is turned by an angle, and along its normal."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([c, s]), np.array([-s, c])


def lattice(spacing: float, keep, origin=(0.0, 0.0), degrees: float = 0.0, reach: float = 1.0) -> Sample:
    """Points a ``spacing`` apart, m, along axes turned about ``origin``, and boxes of the grid's axes.

    ``keep`` is asked which of them belong to the body, by their two coordinates along the turned axes.
    """
    count = math.ceil(reach / spacing)
    a, b = (np.indices((2 * count, 2 * count)).reshape(2, -1) - count + 0.5) * spacing
    inside = keep(a, b)
    along, normal = axes(degrees)
    places = np.asarray(origin) + a[inside, None] * along + b[inside, None] * normal
    n = len(places)
    return Sample(places, np.full(n, spacing**2), np.full((n, 2), spacing / 2))


def filled(case: dict, sample: Sample) -> mpmkit.Simulation:
    """A simulation of a case in plane strain with one body, which consists of the particles of a sample."""
    lower, upper = zip(*case["grid"]["domain"].values(), strict=True)
    body = {"shape": {"kind": "box", "lower": list(lower), "upper": list(upper)}, **case["bodies"][0]}
    parsed = mpmkit.parse_case({"space": "plane-strain", **case, "bodies": [body]})
    with (
        mock.patch.object(scene, "_sample_body", return_value=sample),
        mock.patch.object(scene, "_refuse_overlaps"),
    ):
        return mpmkit.Simulation(parsed)


def put_under_weight(simulation: mpmkit.Simulation, level: float, gravity: float = 9.81) -> None:
    """Give a fluid at rest below a level, m, of the case's last axis the pressure of its weight.

    Positions stay as they are; J = 1 - g depth/c².
    """
    p = simulation.particles
    (group,) = p.groups
    height = p.position[:, -1] + simulation.grid.lower[-1]
    p.volume_ratio[:] = 1 - gravity * np.maximum(level - height, 0.0) / group.sound_speed**2
    p.volume[:] = p.volume_ratio * p.initial_volume
    p.pressure[:] = group.pressure(p.volume_ratio)
