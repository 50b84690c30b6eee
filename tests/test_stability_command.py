"""The largest stable step: the criteria, and results for schemes with known limits."""

import dataclasses
import json
import math
from types import SimpleNamespace

import numpy as np
import pytest

from mpmkit.case import parse_case
from mpmkit.cli import main, stability
from mpmkit.errors import CaseError
from mpmkit.solver.simulation import Simulation
from mpmkit.stability import Criteria, combinations, critical_fraction
from mpmkit.stability.judge import distance
from mpmkit.stability.trial import Trace, trace

COLUMN = {
    "name": "column",
    "space": "plane-strain",
    "until": 0.25,
    "grid": {
        "cell_size": 0.1,
        "domain": {"x": [0, 1], "z": [0, 1]},
        "faces": {"z_min": "slip", "x_min": "slip"},
    },
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0, 0], "upper": [0.5, 0.5]},
            "material": {"law": "newtonian", "density": 1000, "viscosity": 10, "sound_speed": 20},
        }
    ],
    "scheme": {"velocity": "flip", "volumetric": "own", "order": "musl"},
}
FREE = COLUMN | {"grid": COLUMN["grid"] | {"faces": {}}, "gravity": [0, 0], "until": 0.05}


def falling(rows=11, mass=2.0):
    """Two particles in free fall without gravity: nothing is created."""
    time = np.linspace(0, 1, rows)
    position = np.stack([np.stack([time, time], axis=1)] * 2, axis=1)
    momentum = np.tile([mass, mass], (rows, 1))
    energy = np.full(rows, mass)
    return Trace(time, energy, energy.copy(), momentum, position, np.full(2, mass / 2), None)


def broken(found, fine=None, data=FREE):
    return Criteria().broken(parse_case(data), found, fine or falling())


def test_growth_as_in_the_fine_solution_is_stable():
    assert broken(falling()) is None


def test_created_energy_is_unstable():
    energy = falling().energy * np.linspace(1, 1.02, 11)
    assert broken(dataclasses.replace(falling(), energy=energy)) == "energy"
    lost = falling().energy * np.linspace(1, 0.98, 11)
    assert broken(dataclasses.replace(falling(), energy=lost)) is None  # that is dissipation


def test_momentum_without_an_external_force_is_unstable():
    momentum = falling().momentum.copy()
    momentum[5:] *= 1.001
    found = dataclasses.replace(falling(), momentum=momentum)
    assert broken(found) == "momentum"
    assert broken(found, data=COLUMN | {"gravity": [0, 0]}) is None  # a wall may give it


def test_distance_from_the_fine_solution_is_unstable():
    moved = falling().position * np.array([1.2, 1.0])
    found = dataclasses.replace(falling(), position=moved)
    assert distance(found, falling()) == pytest.approx(0.2 / math.sqrt(2))
    assert broken(found) == "distance"


def test_a_guard_and_a_short_run():
    assert broken(dataclasses.replace(falling(), stopped_by="non-finite")) == "guard"
    energy = falling().energy.copy()
    energy[-1] = np.nan
    assert broken(dataclasses.replace(falling(), energy=energy)) == "guard"


def test_a_fraction_beyond_the_declared_limit_is_used():
    case = parse_case(COLUMN, ["scheme.order=usl", "scheme.time_step.fraction=1"])
    kept, tried = Simulation(case), Simulation(case, fraction=0.9)
    assert kept.time_step == pytest.approx(0.4 * kept.limits.acoustic)
    assert tried.time_step == pytest.approx(0.9 * kept.limits.acoustic)


def test_a_trace_looks_at_the_run_at_equal_times_and_cuts_no_step():
    case = parse_case(COLUMN)
    found, simulation = trace(case, 0.3), Simulation(case, fraction=0.3)
    equal = np.linspace(0, 0.25, len(found.time))
    assert np.abs(found.time - equal).max() <= simulation.time_step / 2
    steps = found.time / simulation.time_step
    assert steps == pytest.approx(np.rint(steps), abs=1e-6)
    assert found.position.shape == (len(found.time), 100, 2)
    assert found.stopped_by is None


def test_positions_of_a_trace_are_those_of_equal_times():
    body = COLUMN["bodies"][0] | {"velocity": [1.0, 2.0]}
    found = trace(parse_case(FREE | {"bodies": [body]}), 0.7)
    gone = found.position[-1] - found.position[0]
    assert gone == pytest.approx(np.tile([0.05, 0.1], (100, 1)), abs=1e-9)


def test_a_trace_goes_on_beyond_periodic_faces():
    faces = {"x_min": "periodic", "x_max": "periodic", "z_min": "slip", "z_max": "open"}
    grid = COLUMN["grid"] | {"domain": {"x": [0, 0.5], "z": [0, 1]}, "faces": faces}
    body = COLUMN["bodies"][0] | {"velocity": [3.0, 0.0]}
    found = trace(parse_case(COLUMN | {"grid": grid, "bodies": [body], "gravity": [0, 0]}), 0.3)
    gone = found.position[-1] - found.position[0]
    assert gone == pytest.approx(np.tile([0.75, 0.0], (100, 1)), abs=1e-9)  # one and a half periods


def test_only_the_requested_combinations_are_tried():
    found = critical_fraction(parse_case(COLUMN), largest=0.3)
    assert (found.fraction, found.unstable, found.broken) == (0.3, math.inf, "")


def test_usl_is_stable_for_shorter_steps_than_musl_as_declared():
    """Inside a body USL bears 0.756 of dx/c and MUSL √2 of it and more; surfaces take some of it."""
    found = {
        labels["order"]: critical_fraction(case)
        for labels, case in combinations(COLUMN, {"order": ["usl", "musl"]})
    }
    assert found["usl"].limit == "acoustic"
    assert found["usl"].declared < found["usl"].fraction < 1.0
    assert found["usl"].fraction < found["musl"].fraction
    assert found["musl"].declared <= found["musl"].fraction * 1.06
    assert found["usl"].broken in ("guard", "energy", "distance")
    assert found["usl"].unstable / found["usl"].fraction < 1.07


def test_laws_are_made_over_and_unknown_names_refused():
    labels = [
        labels for labels, _ in combinations(COLUMN, {"law": ["newtonian"], "shape": ["linear", "cpgimp"]})
    ]
    assert labels == [{"law": "newtonian", "shape": "linear"}, {"law": "newtonian", "shape": "cpgimp"}]
    with pytest.raises(CaseError, match="--order usq: it must be one of musl, usf, usl"):
        list(combinations(COLUMN, {"order": ["usq"]}))


def test_the_command_prints_and_draws(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "column.json").write_text(json.dumps(COLUMN | {"until": 0.05}))
    with pytest.raises(SystemExit) as stop:
        main(["stability", "column.json", "--order", "usl,musl", "--json", "--out", "map"])
    assert stop.value.code == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["order"] for row in rows] == ["usl", "musl"]
    assert {"fraction", "unstable", "broken", "limit", "declared"} <= set(rows[0])
    map_ = tmp_path / "map" / "stability.png"
    assert map_.stat().st_size > 10_000
    map_.write_bytes(b"of an earlier search")
    with pytest.raises(SystemExit) as stop:
        main(["stability", "column.json", "--order", "usl,musl", "--out", "map"])
    assert stop.value.code == 2
    assert capsys.readouterr().err == (
        "mpmkit: 'map/stability.png' exists: give --overwrite to replace it, or write elsewhere with --out\n"
    )
    assert map_.read_bytes() == b"of an earlier search"
    coarse = ["--until", "0.001", "--overwrite", "--json"]
    with pytest.raises(SystemExit) as stop:
        main(["stability", "column.json", "--out", "map", *coarse])
    assert stop.value.code == 0
    assert map_.stat().st_size > 10_000
    with pytest.raises(SystemExit) as stop:
        main(["stability", "column.json", "--order", "nothing"])
    assert stop.value.code == 2


def test_a_long_search_reports_its_trials_and_a_short_one_does_not(monkeypatch, capsys):
    clock = iter([0.0, 5.0, 12.0, 12.0, 15.0])
    monkeypatch.setattr(stability, "time", SimpleNamespace(monotonic=lambda: next(clock)))
    kept = stability._Kept("usl, flip")
    for fraction in (0.05, 2.0, 0.316228):
        kept(fraction, falling())
    assert capsys.readouterr().err == "usl, flip: trial 2, at 2 of the limit, has ended\n"
    assert list(kept.traces) == [0.05, 2.0, 0.316228]
