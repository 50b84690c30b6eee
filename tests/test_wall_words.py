"""Walls in words: the description of each wall before a run, and in the message of a guard."""

import json
from pathlib import Path

import numpy as np
import pytest

import mpmkit
from mpmkit.contracts import Surface
from mpmkit.errors import GuardStop
from mpmkit.running.setting import setting
from mpmkit.solver.simulation import Simulation

CASES = Path(__file__).parents[1] / "cases"
DISC = {"kind": "sphere", "centre": [0.5, 0.5], "radius": 0.1}


def case_of(*walls, space="plane-strain"):
    """A block that rests on a wall, and other walls."""
    floor = {"surface": {"kind": "plane", "point": [0, 0], "normal": [0, 1]}, "contact": "stick"}
    data = {
        "space": space,
        "until": 0.5,
        "grid": {"cell_size": 0.05, "domain": {"x": [-0.2, 1.0], "z": [-0.2, 1.0]}},
        "walls": {"floor": floor} | {f"w{number}": wall for number, wall in enumerate(walls)},
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [0.3, 0.2]},
                "material": {"law": "newtonian", "density": 1000, "viscosity": 5, "sound_speed": 15},
            }
        ],
    }
    return mpmkit.parse_case(data)


MOTIONS = [
    ({"kind": "velocity", "velocity": [0, 0.3]}, "moves at 0.3 m/s along z from t = 0 s on"),
    (
        {"kind": "velocity", "velocity": [-0.1, 0.3], "start": 0.2, "end": 0.4},
        "moves at (-0.1, 0.3) m/s along (x, z) from t = 0.2 s to 0.4 s",
    ),
    (
        {"kind": "table", "times": [0, 0.1, 0.3], "positions": [[0, 0], [0, 0], [0, 0.1]]},
        "moves by a table of 3 places from t = 0 s to 0.3 s",
    ),
    (
        {"kind": "rotation", "point": [0.5, 0.5], "rate": 1.5},
        "turns at 1.5 rad/s about (0.5, 0.5) m from t = 0 s on",
    ),
    (
        {"kind": "oscillation", "amplitude": [0.01, 0], "frequency": 5},
        "swings by 0.01 m along x at 5 Hz from t = 0 s on",
    ),
    (None, "at rest"),
]


@pytest.mark.parametrize(("motion", "words"), MOTIONS)
def test_each_motion_has_its_words(motion, words):
    surface = {"kind": "body", "shape": DISC, "side": "outside", "motion": motion}
    said = setting(case_of({"surface": surface, "contact": "slip"}))
    assert said[-1] == f"wall w0: body (shape sphere, side outside); contact slip; {words}"


def test_parameters_stand_with_their_units():
    surface = {"kind": "plane", "point": [0.9, 0], "normal": [-1, 0], "appears": 0.2}
    contact = {"kind": "coulomb", "coefficient": 0.2}
    said = setting(case_of({"surface": surface, "contact": contact}))[-1]
    assert "appears 0.2 s" in said
    assert "point (0.9, 0) m" in said
    assert said.endswith("contact coulomb (coefficient 0.2); at rest")


def test_in_three_dimensions_a_turn_has_a_direction():
    turn = {"kind": "rotation", "point": [0, 0, 0], "axis": [0, 0, 1], "rate": 2}
    drum = {"kind": "cylinder", "radius": 0.3, "height": 0.4}
    surface = {"kind": "body", "shape": drum, "side": "inside", "motion": turn}
    override = {"drum": {"surface": surface, "contact": "stick"}}
    case = mpmkit.load_case(CASES / "slump_quarter.json", ["until=1", f"walls={json.dumps(override)}"])
    expected = "turns at 2 rad/s about the direction (0, 0, 1) through (0, 0, 0) m from t = 0 s on"
    assert setting(case)[-1].endswith(expected)


class Belt(Surface):
    """A third party's, whose motion is none of the framework's."""

    name = "belt"
    api_version = 2
    citation = "none"

    def distance(self, x, t):
        return x[:, 1].copy(), np.tile([0.0, 1.0], (len(x), 1))

    def fastest(self, t0, t1):
        return 0.25


def test_of_a_third_partys_surface_it_is_said_how_fast_it_gets():
    case = case_of()
    wall = case.walls["floor"].model_copy(update={"surface": Belt()})
    said = setting(case.model_copy(update={"walls": {"belt": wall}}))[-1]
    assert said == "wall belt: belt; contact stick (releases no); moves at up to 0.25 m/s"


@pytest.mark.parametrize(
    ("place", "words"),
    [([0.1, 0.02], "particle 7, at walls.floor, has"), ([0.1, 0.15], "particle 7 has")],
    ids=["at the wall", "away from it"],
)
def test_a_guard_names_the_wall_at_which_a_particle_is(place, words):
    simulation = Simulation(case_of())
    p = simulation.particles
    p.position[7] = np.array(place) - simulation.grid.lower
    p.volume_ratio[7] = 50.0
    with pytest.raises(GuardStop, match=words):
        simulation.check()


def test_a_guard_names_both_walls_of_a_corner():
    side = {"surface": {"kind": "plane", "point": [0, 0], "normal": [1, 0]}, "contact": "slip"}
    gone = {
        "surface": {"kind": "plane", "point": [0, 0], "normal": [1, 0], "vanishes": 1e-9},
        "contact": "slip",
    }
    simulation = Simulation(case_of(side, gone))
    simulation.advance()
    p = simulation.particles
    index = int(np.argmin(((p.position + simulation.grid.lower) ** 2).sum(axis=1)))
    p.velocity[index] = np.nan
    with pytest.raises(GuardStop, match=r"particle \d+, at walls.floor and walls.w0, has"):
        simulation.check()
