"""Scenes in which a plug-in of the test replaces a built-in one, and the message about it."""

from __future__ import annotations

import json

import pytest

import mpmkit
from mpmkit.case.plugins import cautions
from mpmkit.contracts import (
    ConstitutiveLaw,
    StateVariable,
)
from mpmkit.errors import PluginStop
from mpmkit.registry import Registered, Registry, installed

FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 1.0, "sound_speed": 10.0}
N = 64


def simulation(kind, plugin):
    """A falling block with one plug-in of the tests."""
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered(kind, plugin, "tests", "1", plugin.name)], [])
    case = {
        "space": "plane-strain",
        "until": 1.0,
        "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
        "bodies": [
            {"shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]}, "material": dict(FLUID)}
        ],
    }
    if kind == "law":
        case["bodies"][0]["material"] = {"law": plugin.name, "density": 1000.0, "sound_speed": 10.0}
    elif kind == "equation_of_state":
        case["bodies"][0]["material"]["equation_of_state"] = plugin.name
    else:
        case["scheme"] = {"redistribution": "none"} | {kind: plugin.name}
    return mpmkit.Simulation(mpmkit.parse_case(json.loads(json.dumps(case)), registry=registry))


def blamed(kind, plugin, steps=3):
    """The message about the plug-in when the case is read, set up, or run for a few steps."""

    def run():
        made = simulation(kind, plugin)
        made.remarks(), cautions(made.case)
        for _ in range(steps):
            made.advance()
        made.check()

    with pytest.raises(PluginStop) as stop:
        run()
    assert f"the plug-in '{plugin.name}' ({kind.replace('_', ' ')})" in str(stop.value)
    assert stop.value.guard == "plug-in-error"
    return str(stop.value)


class Law(ConstitutiveLaw):
    name = "of-the-tests"
    api_version = 2
    citation = "none"
    state = {"age": StateVariable("s", "age")}

    def update_stress(self, kinematics, state, dt, stress):
        stress[:] = 0.0
