"""A checkpoint contains all data that change in a run: all other attributes of a fresh scene are poisoned."""

from __future__ import annotations

import json
import math
from pathlib import Path
from types import FunctionType
from typing import Any

import numpy as np
import pytest

from mpmkit.case import load_case, parse_case
from mpmkit.errors import GuardStop
from mpmkit.output import RunDirectory
from mpmkit.running.recorder import Recorder
from mpmkit.running.saver import run_components
from mpmkit.running.stopwatch import Stopwatch
from mpmkit.solver.simulation import CONTROL_INTERVAL, Simulation
from mpmkit.solver.stateful import Stateful, restore, state_of

CASES = Path(__file__).parents[1] / "cases"
MADE_OF_THE_CASE = {
    "Simulation": {"case", "grid", "measures", "_first_sound_speeds", "blaming"},
    "Group": {"law", "equation_of_state"},
    "SceneOperations": {"scheme", "grid", "cell_size", "radial", "_scatter", "_gather"},
    "Forces": {"_forces", "_gravity", "_lower", "_uniform", "_of_velocity"},
    "Window": {"grid"},
    "Sorting": {"grid", "_locate", "_periodic", "_walls", "_walled"},
    "ActiveNodes": {"faces"},
    "Averager": {"_scatter_pairs", "_gather_scalar"},
    "Walls": {"grid", "_names", "_of"},
    "Faces": {"grid", "_are_walls"},
    "Wall": {"surface", "contact", "grid", "odd", "pulls"},
    "WallNodes": {"contact", "grid"},
    "Relaxation": {"_treatment"},
    "Stage": {"redistribution", "acts", "_follows", "_grid", "_radial", "_times", "_downwards"},
    "Refiner": {"dim", "acts", "_author", "_grid", "_radial", "_full"},
    "Ledger": {"_gravity", "_downwards", "_along"},
    "Drains": {"_sinks", "_domain", "_lower"},
    "Sources": {"_names"},
    "Feed": {
        "_case",
        "_name",
        "_number",
        "_grid",
        "_source",
        "_density",
        "_group",
        "_mouth",
        "_area",
        "_section",
        "_length",
        "_begins",
        "_ends",
        "_half",
        "_depth",
        "_normal",
        "_scatter",
    },
    "Recorder": {"directory"},
    "Ending": {"_until"},
    "History": {"attributes", "_columns", "_axes", "_variables", "_walls"},
    "FrameWriter": {"directory", "_planar"},
    "WallFrames": {"_surfaces", "_spacing", "_lower", "_upper"},
    "WallFrameWriter": {"directory", "_dim", "_names"},
    "Schedule": {"_times"},
    "FlowRecord": {"_height", "_until"},
}
"""Attributes by class that are never written again; every other one is poisoned."""
NOT_COMPARED = {
    "Simulation": {"blaming"},  # plug-ins, and a function of this very simulation
    "SceneOperations": {"_tables"},  # memory that sorting uses as well; weight and gradient lie in it
    "Window": {"_stores", "_capacity"},  # memory, as much as was ever needed; nodes, pairs, average lie in it
    # Kept from one redistribution to the next, made again if they are missing; memory of the tables.
    "Stage": {"_blocks", "_lent"},
    # Memory of which a step reads no more rows than it has written.
    "WallNodes": {
        "_at_wall",
        "_ghosts",
        "_behind",
        "acting",
        "index",
        "weight",
        "image",
        "image_weight",
        "foot",
    }
    | {
        "foot_weight",
        "free",
        "share",
        "inverse_mass",
        "velocity",
        "inner",
        "held",
        "pair",
        "given",
        "held_at",
        "impulse",
        "mapped",
    },
    "Wall": {"_acting", "_after"},  # found when it acts, and used within the same step
    "WallFrames": {"_surfaces"},  # of the case, with what was found of them when it was asked for
    "ActiveNodes": {"held"},  # filled by a fold, and read by the filling of the same step
    "History": {"_next_flush"},  # wall time
    "Stopwatch": {"_begin", "_before"},  # wall time; ``elapsed`` is compared
}


def is_ours(value: Any) -> bool:
    return type(value).__module__.startswith("mpmkit") and not isinstance(value, FunctionType)


def of_run(value: Any, seen: set[int] | None = None):
    """Every object of our own classes that can be reached, each once, except those made from the case."""
    seen = set() if seen is None else seen
    if isinstance(value, list | tuple):
        for entry in value:
            yield from of_run(entry, seen)
    elif is_ours(value) and hasattr(value, "__dict__") and id(value) not in seen:
        seen.add(id(value))
        yield value
        for name, attribute in vars(value).items():
            if name not in MADE_OF_THE_CASE.get(type(value).__name__, ()):
                yield from of_run(attribute, seen)


def poison(*roots: Any) -> int:
    """Replace every attribute that does not hold an object of our own by one that can be used for nothing."""
    count = 0
    for owner in list(of_run(list(roots))):
        for name, value in list(vars(owner).items()):
            own = is_ours(value) or (isinstance(value, list) and value and is_ours(value[0]))
            own = own or (type(owner).__name__, name) in (
                ("Walls", "walls"),
                ("Sources", "feeds"),
            )  # maybe none
            if own and type(value).__name__ != "Limits":
                continue
            if name not in MADE_OF_THE_CASE.get(type(owner).__name__, ()):
                object.__setattr__(owner, name, object())
                count += 1
    return count


def assert_same(a: Any, b: Any, path: str, seen: set[int]):
    """Two values, and all that is in them, are equal to the bit."""
    assert type(a) is type(b), path
    if isinstance(a, np.ndarray):
        np.testing.assert_array_equal(a, b, err_msg=path)
        assert a.dtype == b.dtype, path
    elif isinstance(a, dict):
        assert a.keys() == b.keys(), path
        for key in a:
            assert_same(a[key], b[key], f"{path}[{key}]", seen)
    elif isinstance(a, list | tuple):
        assert len(a) == len(b), path
        for index, (one, other) in enumerate(zip(a, b, strict=True)):
            assert_same(one, other, f"{path}[{index}]", seen)
    elif isinstance(a, float) and math.isnan(a):
        assert math.isnan(b), path
    elif is_ours(a) and hasattr(a, "__dict__"):
        if id(a) in seen:
            return
        seen.add(id(a))
        kind = type(a).__name__
        assert vars(a).keys() == vars(b).keys(), path
        for name in vars(a).keys() - NOT_COMPARED.get(kind, set()) - {"case", "directory", "scheme"}:
            assert_same(vars(a)[name], vars(b)[name], f"{path}.{name}", seen)
    else:
        assert a == b, path


def a_run(case, directory: Path, goes_on: bool = False) -> tuple[Simulation, Recorder, Stopwatch]:
    directory.mkdir(exist_ok=True)
    simulation = Simulation(case)
    return simulation, Recorder(simulation, {}, RunDirectory(directory), goes_on), Stopwatch()


def advance(simulation: Simulation, recorder: Recorder, steps: int):
    for _ in range(steps):
        simulation.advance()
        recorder.record()


FLOWING = [
    "grid.cell_size=0.04",
    'grid.domain={"r": [0, 0.6], "z": [0, 0.32]}',
    'grid.faces={"z_min": {"kind": "friction", "coefficient": 0.3}}',
    "scheme.splitting=true",
    'bodies.0.material.sound_speed={"mach": 0.2}',
    'output.particle_history=["velocity"]',
    "until=1",
]


@pytest.mark.parametrize("redistribution", ["none", "even"])
@pytest.mark.parametrize(
    "steps", [2 * CONTROL_INTERVAL + 5, 12 * CONTROL_INTERVAL], ids=["between", "at a look"]
)
def test_every_attribute_is_restored_or_made_anew(tmp_path, steps, redistribution):
    """A friction wall, splitting, a sound that follows the flow, rows of particles: all there is to remember.

    What is filled in the course of a step is compared after one; all else comes from the checkpoint.
    """
    case = load_case(CASES / "slump_fast.json", [*FLOWING, f"scheme.redistribution={redistribution}"])
    simulation, recorder, watch = a_run(case, tmp_path)
    begun_with = len(simulation.particles)
    recorder.record()
    advance(simulation, recorder, steps)
    assert steps < 200 or redistribution == "even" or len(simulation.particles) > begun_with
    state = {name: value.copy() for name, value in state_of(run_components(recorder, watch)).items()}

    again, recorder_again, watch_again = a_run(case, tmp_path, goes_on=True)
    again.advance()  # so that it has everything that a scene in motion has
    assert poison(again, recorder_again, watch_again) > 80
    restore(run_components(recorder_again, watch_again), state)
    advance(simulation, recorder, 1)
    advance(again, recorder_again, 1)
    assert_same(simulation, again, "simulation", set())
    assert_same(recorder, recorder_again, "recorder", set())
    assert watch_again.elapsed == float(state["watch/elapsed"])


MOULDED = {
    "shell": {
        "surface": {
            "kind": "body",
            "shape": {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": 0.3},
            "side": "inside",
            "thickness": 0.05,
            "motion": {"kind": "velocity", "velocity": [0, 0.5]},
        },
        "contact": "slip",
    },
    "slope": {
        "surface": {"kind": "plane", "point": [0.2, 0.05], "normal": [-0.5, 1.0]},
        "contact": {"kind": "stick", "releases": True},
    },
}


SHAKEN = {
    "shake": {"kind": "oscillation", "amplitude": [0, 0.0005], "frequency": 30},
    "turn": {"kind": "centrifugal", "rate": 2.0},
}


def restored(case, tmp_path, steps: int) -> Simulation:
    """Restore the state after some steps into a poisoned run: one step later, both runs are the same.

    Returns:
        The run from which the state was taken.
    """
    simulation, recorder, watch = a_run(case, tmp_path)
    recorder.record()
    advance(simulation, recorder, steps)
    state = {name: value.copy() for name, value in state_of(run_components(recorder, watch)).items()}

    again, recorder_again, watch_again = a_run(case, tmp_path, goes_on=True)
    again.advance()
    poison(again, recorder_again, watch_again)
    restore(run_components(recorder_again, watch_again), state)
    advance(simulation, recorder, 1)
    advance(again, recorder_again, 1)
    assert_same(simulation, again, "simulation", set())
    assert_same(recorder, recorder_again, "recorder", set())
    return simulation


@pytest.mark.parametrize("steps", [37, 5 * CONTROL_INTERVAL])
def test_every_attribute_of_a_wall_is_restored_or_made_anew(tmp_path, steps):
    """A mould that is lifted off, a plane, and forces: their places, what they gave, what is remembered."""
    changes = [*FLOWING, f"walls={json.dumps(MOULDED)}", f"forces={json.dumps(SHAKEN)}"]
    case = load_case(CASES / "slump_fast.json", changes)
    simulation = restored(case, tmp_path, steps)
    assert simulation.wall_sums()[0].any()


POURED = {
    "pump": {
        "kind": "inlet",
        "lower": [0, 0.25],
        "upper": [0.05, 0.25],
        "direction": "-z",
        "velocity": 0.5,
        "material": {"law": "newtonian", "density": 1000, "viscosity": 1, "sound_speed": 5},
    }
}


def test_every_attribute_of_a_source_is_restored_or_made_anew(tmp_path):
    """A second material falls onto a body: its rows, and what it gave to the nodes."""
    changes = [*FLOWING, f"sources={json.dumps(POURED)}", "bodies.0.shape.height=0.2"]
    case = load_case(CASES / "slump_fast.json", changes)
    simulation = restored(case, tmp_path, 5 * CONTROL_INTERVAL)
    assert simulation.operations.sources.mass_in.sum() > 0


def test_every_component_is_stateful(tmp_path):
    simulation, recorder, watch = a_run(load_case(CASES / "slump_fast.json", FLOWING), tmp_path)
    simulation.prepare()
    owners = [simulation, simulation.operations, simulation.guards, recorder]
    components = [run_components(recorder, watch), *(owner.components for owner in owners)]
    assert all(isinstance(one, Stateful) for found in components for one in found.values())
    with pytest.raises(KeyError):
        simulation.restore({"time": np.array(1.0)})


FLIGHT = {
    "space": "plane-strain",
    "until": 10,
    "gravity": [0, 0],
    "grid": {"cell_size": 0.1, "domain": {"x": [0, 30], "z": [0, 1]}},
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0.2, 0.2], "upper": [0.6, 0.6]},
            "material": {"law": "newtonian", "viscosity": 1.0, "density": 1000, "sound_speed": 10},
            "velocity": [1.0, 0],
        }
    ],
}


def steps_until_stopped(simulation: Simulation) -> GuardStop:
    for _ in range(2000):
        try:
            simulation.advance()
        except GuardStop as stop:
            return stop
    raise AssertionError("no guard has stopped it")


def test_created_energy_is_remembered_after_a_stop():
    """A kick before the stop adds 44 % to the energy of a free flight: too much, at the tenth look."""
    whole = Simulation(parse_case(FLIGHT))
    for step in range(110):
        if step == 50:
            whole.particles.velocity *= 1.2
        whole.advance()
    again = Simulation(parse_case(FLIGHT))
    again.restore(whole.state())
    at, at_again = steps_until_stopped(whole), steps_until_stopped(again)
    assert (at.guard, at.step) == ("energy", 60 + 9 * CONTROL_INTERVAL)
    assert str(at) == str(at_again)


def test_mass_lost_before_a_stop_is_noticed_after_it():
    whole = Simulation(parse_case(FLIGHT))
    for _ in range(50):
        whole.advance()
    whole.particles.mass[3] *= 0.5
    again = Simulation(parse_case(FLIGHT))
    again.restore(whole.state())
    at, at_again = steps_until_stopped(whole), steps_until_stopped(again)
    assert (at.guard, at.step) == ("mass-drift", 60)
    assert str(at) == str(at_again)


def test_a_step_that_collapses_is_measured_by_the_longest_of_the_whole_run():
    whole = Simulation(parse_case(FLIGHT))
    for _ in range(30):
        whole.advance()
    again = Simulation(parse_case(FLIGHT))
    again.restore(whole.state())
    for simulation in (whole, again):
        simulation.guards._longest_step *= 2e4
        other = Simulation(parse_case(FLIGHT))
        other.restore(simulation.state())
        assert steps_until_stopped(other).guard == "step-collapse"
