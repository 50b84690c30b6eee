"""A tank in which an inviscid fluid sloshes in its first mode."""

import math
from collections.abc import Iterator

import numpy as np

import mpmkit

LENGTH, DEPTH, G = 1.0, 0.5, 9.81
K = math.pi / LENGTH
OMEGA = math.sqrt(G * K * math.tanh(K * DEPTH))
PERIOD = 2 * math.pi / OMEGA
PERIODS, ROWS = 20, 161
WATER = {"law": "newtonian", "viscosity": 1e-3}

AVERAGED = {"name": "nodal-average", "relaxation": 1.0}
YIELD = {"law": "bingham-evp", "yield_stress": 10.0, "plastic_viscosity": 1e-3}
TANKS: dict[str, tuple[dict, str, dict]] = {
    "own": ({"volumetric": "own"}, "-", {}),
    "averaged, relaxation 0": ({"volumetric": AVERAGED | {"relaxation": 0.0}}, "-", {}),
    "averaged, relaxation 1": ({}, "-", {}),
    "averaged, relaxation 10": ({"volumetric": AVERAGED | {"relaxation": 10.0}}, "-", {}),
    "relaxation 1, USF": ({"order": "usf"}, "--", {}),
    "relaxation 0, splitting": ({"splitting": True, "volumetric": AVERAGED | {"relaxation": 0.0}}, "--", {}),
    "relaxation 1, splitting": ({"splitting": True}, "--", {}),
    "relaxation 1, half the cell": ({}, ":", {"cells": 20}),
    "relaxation 1, fixed boxes": ({"shape": {"name": "cpgimp", "domain": "fixed"}}, "--", {}),
    "relaxation 1, at rest": ({}, ":", {"amplitude": 0.0}),
    "relaxation 1, 10 Pa s": ({}, "-.", {"law": WATER | {"viscosity": 10.0}}),
    "relaxation 1, 100 Pa s": ({}, "-.", {"law": WATER | {"viscosity": 100.0}}),
    "relaxation 1, yield stress 1 Pa": ({}, "-.", {"law": YIELD | {"yield_stress": 1.0}}),
    "relaxation 1, yield stress 10 Pa": ({}, "-.", {"law": YIELD}),
}
"""Schemes, dashes, and what else is not as in the others."""


def tank(scheme: dict, cells: int = 10, amplitude: float = 0.1, law: dict | None = None) -> mpmkit.Simulation:
    """The first mode, ``amplitude`` m high at the walls; the pressure is hydrostatic at first."""
    dx, sound = DEPTH / cells, 15 * math.sqrt(2 * G * DEPTH)
    case = mpmkit.parse_case(
        {
            "space": "plane-strain",
            "until": 100.0,
            "grid": {
                "cell_size": dx,
                "domain": {"x": [0, LENGTH], "z": [0, 2 * DEPTH]},
                "faces": {"x_min": "slip", "x_max": "slip", "z_min": "slip"},
            },
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [0, 0], "upper": [LENGTH, DEPTH]},
                    "material": {
                        "density": 1000,
                        "sound_speed": sound,
                        **(law or WATER),
                    },
                }
            ],
            "scheme": {"redistribution": "none", "time_step": {"fraction": 0.4}, **scheme},
        }
    )
    simulation = mpmkit.Simulation(case)
    p = simulation.particles
    x, z = p.position.T
    p.volume_ratio[:] = 1 / (1 + G * (DEPTH - z) / sound**2)
    p.volume[:] = p.volume_ratio * p.initial_volume
    p.pressure[:] = 1000 * G * (DEPTH - z)
    scale = amplitude * OMEGA / math.sinh(K * DEPTH)
    p.velocity[:] = scale * np.column_stack([np.sin(K * x) * np.cosh(K * z), -np.cos(K * x) * np.sinh(K * z)])
    return simulation


def heights(scheme: dict, settings: dict) -> Iterator[float]:
    """Of the centre of mass, eight times a period, over that of the tank at rest."""
    simulation = tank(scheme, **settings)
    simulation.guards.watches_density = False  # how far it sinks is what is asked
    for time in np.linspace(0, PERIODS * PERIOD, ROWS):
        while simulation.time < time:
            simulation.advance()
        p = simulation.particles
        yield float(np.average(p.position[:, 1], weights=p.mass)) / (DEPTH / 2)
