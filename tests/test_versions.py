"""Versions of the plug-in contracts: plug-ins of version 1 work, and a message says what to change."""

import json
from pathlib import Path

import numpy as np
import pytest
from distributions import run_their_tests

import mpmkit
from mpmkit.case.plugins import cautions
from mpmkit.contracts import API_VERSION, Kinematics, Motion, VelocityUpdate
from mpmkit.contracts.version1 import deprecation
from mpmkit.errors import GuardStop
from mpmkit.registry import Registered, Registry, installed

OLD = Path(__file__).parent / "version1"
ADVICE = "'Motion' is now 'Kinematics', 'ops.advance' is 'ops.move_particles'"


def test_plugins_of_version_1_pass_their_own_tests(tmp_path):
    """A law, an order, a velocity update and a volumetric treatment, word for word as for 0.5.0."""
    done = run_their_tests([OLD], tmp_path)
    said = done.stdout
    assert done.returncode == 0, said + done.stderr
    assert int(said.rsplit(" passed", 1)[0].split()[-1]) >= 30
    for name in ("old-oil", "old-usf"):
        assert said.count(f"DeprecationWarning: plug-in '{name}' is written for version 1") == 1
    assert ADVICE in said
    assert "docs/plugins.md#versions" in said


class Old(VelocityUpdate):
    name = "old-flip"
    citation = "none"
    api_version = 1

    def map_to_particles(self, ops, dt):
        ops.advance(dt, flip=1.0)


class New(Old):
    name = "new-flip"
    api_version = 2


def case(name):
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    own = [Registered("velocity", plugin, "tests", "1", plugin.name) for plugin in (Old, New)]
    fluid = {"law": "newtonian", "density": 1000, "viscosity": 1, "sound_speed": 10}
    bodies = [{"shape": {"kind": "box", "lower": [0.2, 0.2], "upper": [0.4, 0.4]}, "material": fluid}] * 1
    data = {
        "space": "plane-strain",
        "until": 0.02,
        "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}},
        "bodies": bodies,
        "scheme": {"velocity": name},
        "output": {"report": False},
    }
    return mpmkit.parse_case(json.loads(json.dumps(data)), registry=Registry([*found, *own], []))


def test_a_run_says_once_that_a_plugin_is_old():
    (sentence,) = [said for said in cautions(case("old-flip")) if "version 1" in said]
    assert sentence.startswith("plug-in 'old-flip' is written for version 1 of the plug-in contracts")
    assert f"api_version = {API_VERSION}" in sentence
    assert ADVICE in sentence
    assert not any("version" in said for said in cautions(case("flip")))
    found, expected = (mpmkit.run(case(name)) for name in ("old-flip", "flip"))
    np.testing.assert_array_equal(found.kinetic_energy, expected.kinetic_energy)


def test_version_2_knows_the_new_names_alone():
    simulation = mpmkit.Simulation(case("new-flip"))
    with pytest.raises(GuardStop, match="has no attribute 'advance'"):
        simulation.advance()
    assert Motion is Kinematics


def test_what_ships_is_of_the_present_version():
    plugins = [p for kind in installed().plugins for p in installed().of_kind(kind).values()]
    assert len(plugins) >= 18
    assert [p.name for p in plugins if deprecation(p) is not None] == []
