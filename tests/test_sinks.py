"""Sinks remove and count the material that leaves through an open face or a drain."""

from __future__ import annotations

import copy

import numpy as np
import pytest
import xarray
from test_ledger import COLUMN, DRAIN, MUD

import mpmkit
from mpmkit.case import parse_case
from mpmkit.case.forewarnings import forewarnings
from mpmkit.contracts import Sink
from mpmkit.errors import CaseError, GuardStop
from mpmkit.plan import plan
from mpmkit.plan.pilot import coarser
from mpmkit.registry import Registered, Registry, installed
from mpmkit.running.runner import resume
from mpmkit.solver.simulation import Simulation
from mpmkit.stability.trial import trace

OPENING = {
    "space": "plane-strain",
    "until": 0.5,
    "grid": {
        "cell_size": 0.02,
        "domain": {"x": [0, 0.2], "z": [0, 0.4]},
        "faces": {"x_min": "symmetry", "x_max": "slip"},
    },
    "walls": {
        "bottom": {
            "surface": {
                "kind": "body",
                "shape": {"kind": "box", "lower": [0.08, 0.06], "upper": [0.3, 0.1]},
                "side": "outside",
            },
            "contact": "slip",
        }
    },
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0, 0.1], "upper": [0.2, 0.3]},
            "material": MUD | {"yield_stress": 5, "plastic_viscosity": 1},
        }
    ],
    "sinks": {"below": {"kind": "face", "face": "z_min"}},
    "output": {"report": False},
}
"""A column that drains through an opening, half of it 80 mm wide, 60 mm above a sink."""


def run(until=0.3, out=None, **changes):
    """``until`` as in a case."""
    return mpmkit.run(parse_case(copy.deepcopy(OPENING) | {"until": until} | changes), out)


@pytest.fixture(scope="module")
def drained(tmp_path_factory):
    path = tmp_path_factory.mktemp("sinks") / "run"
    return run(out=path), path


def test_a_column_that_drains_loses_no_mass(drained):
    history, _ = drained
    whole = history.total_mass + history.mass_out
    np.testing.assert_allclose(whole, 1500 * 0.2 * 0.2, rtol=1e-12)
    assert history.mass_out.values[-1] > 0.2 * whole[0]
    assert (np.diff(history.mass_out) >= 0).all()
    assert history.mass_out.values[0] == 0
    assert history.attrs["stopped_because"] == "finished"


def test_each_sink_is_counted_by_its_name(drained):
    history, _ = drained
    assert history.sink_mass.dims == history.sink_rate.dims == ("time", "sink")
    assert history.sink.values.tolist() == ["below"]
    assert history.sink_mass.attrs["units"] == "kg"
    assert history.sink_rate.attrs["units"] == "kg/s"
    np.testing.assert_array_equal(history.sink_mass.sel(sink="below"), history.mass_out)
    summed = (history.sink_rate.sel(sink="below") * history.time.diff("time")).sum()
    assert float(summed) == pytest.approx(float(history.mass_out[-1]), rel=1e-9)


def test_a_block_that_falls_through_a_face_leaves_as_fast_as_it_falls():
    """0.1 m above the face: ρ w (g t²/2 - 0.1 m) have left at t, to a row of particles."""
    block = {"shape": {"kind": "box", "lower": [0.06, 0.1], "upper": [0.14, 0.3]}, "material": MUD}
    history = run(0.19, bodies=[block], walls={}, gravity=[0, -9.81])
    depth = np.clip(9.81 * history.time**2 / 2 - 0.1, 0, 0.2)
    row = 1500 * 0.08 * 0.01
    assert history.mass_out.values[-1] > 5 * row
    np.testing.assert_allclose(history.mass_out, 1500 * 0.08 * depth, rtol=0, atol=0.75 * row)
    momentum = -9.81 * history.time * history.mass_out
    taken = history.ledger_momentum.sel(cause="out", component="z").values
    assert taken[-1] > 0
    assert abs(taken[-1]) < abs(momentum.values[-1])


def test_without_a_sink_the_run_is_stopped():
    with pytest.raises(
        GuardStop, match=r"left the grid at x = .*, z = .*; enlarge grid\.domain or close that"
    ):
        run(sinks={})


def test_an_open_floor_with_a_sink_gives_no_warning():
    free = {"walls": {}}
    closed = parse_case(copy.deepcopy(OPENING) | free | {"sinks": {}})
    assert any("has no floor" in sentence for sentence in forewarnings(closed))
    assert not any("has no floor" in s for s in forewarnings(parse_case(copy.deepcopy(OPENING) | free)))


def test_a_run_ends_when_enough_has_left_or_all():
    history = run({"mass_out": {"at_least": 10}, "at_most": 1.0})
    assert history.attrs["stopped_because"] == "condition"
    assert 10 <= history.mass_out.values[-1] < 12
    block = {"shape": {"kind": "box", "lower": [0.06, 0.1], "upper": [0.14, 0.2]}, "material": MUD}
    history = run(2.0, bodies=[block], walls={})
    assert history.attrs["stopped_because"] == "condition"
    assert history.time.values[-1] < 0.3
    assert float(history.total_mass[-1] + history.mass_out[-1]) == pytest.approx(1500 * 0.008, rel=1e-12)
    assert float(history.total_mass[-1]) < 0.15 * 1500 * 0.008  # the last row, which stays


def test_a_resumed_run_has_the_same_bits(drained, tmp_path):
    _, path = drained
    short = tmp_path / "short"
    run(0.2, out=short, output={"report": False, "history_interval": 0.3 / 400, "frame_interval": 0.3 / 20})
    resume(short, until=0.3)
    with xarray.open_dataset(short / "history.nc") as again, xarray.open_dataset(path / "history.nc") as once:
        xarray.testing.assert_identical(again.drop_attrs(), once.drop_attrs())


def test_plan_knows_a_scene_with_sinks_and_conditions():
    """Its pilot measures no output, and needs no condition."""
    output = {"report": False, "diagnostics": {"g": {"kind": "probe", "at": [0.05, 0.2]}}}
    until = {"g.pressure": {"at_least": 1e9}, "mass_out": {"at_least": 1e9}, "at_most": 0.05}
    case = parse_case(copy.deepcopy(OPENING) | {"until": until, "output": output})
    assert coarser(case).end == 0.05
    cost = plan(case, 1)
    assert cost["steps"] > 50
    assert (
        "the run ends when g.pressure is at least 1e+09 or mass_out is at least 1e+09" in cost["remarks"][-1]
    )


def test_stability_takes_no_sinks():
    with pytest.raises(CaseError, match="stability follows every particle to the end: leave out sinks"):
        trace(parse_case(copy.deepcopy(OPENING)), 0.5)


def test_a_drain_in_the_scene_takes_what_comes_into_it():
    simulation = Simulation(parse_case(copy.deepcopy(COLUMN) | {"sinks": {"drain": DRAIN}}))
    for _ in range(150):
        simulation.advance()
    p = simulation.particles
    assert simulation.ledger.mass_out[0] > 0
    assert p.position[:, 0].max() < 0.22
    assert len(np.unique(p.number)) == len(p)


@pytest.mark.parametrize(
    ("sink", "sentence"),
    [
        (
            {"kind": "face", "face": "x_max"},
            "sinks.s: face is 'x_max', which is closed; only an open face lets",
        ),
        (
            {"kind": "face", "face": "y_max"},
            "sinks.s: face is 'y_max'; it must be one of x_min, x_max, z_min",
        ),
        ({"kind": "fac", "face": "z_max"}, 'did you mean "face"?'),
        (
            {"kind": "box", "lower": [0, 0, 0], "upper": [1, 1, 1]},
            "the space plane-strain needs 2 numbers (x, z)",
        ),
        ({"kind": "box", "lower": [0, 1], "upper": [1, 0]}, "lower must be below upper along each axis"),
    ],
)
def test_a_wrong_sink_has_its_sentence(sink, sentence):
    with pytest.raises(CaseError) as error:
        parse_case(copy.deepcopy(OPENING) | {"sinks": {"s": sink}})
    assert sentence in str(error.value)


class Rows(Sink):
    name, citation, api_version = "rows", "none", 2

    def takes(self, x, t, domain):
        return np.flatnonzero(x[:, -1] < 0)


def test_a_faulty_sink_is_named():
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered("sink", Rows, "tests", "1", "rows")], [])
    simulation = Simulation(parse_case(copy.deepcopy(OPENING) | {"sinks": {"s": "rows"}}, registry=registry))
    with pytest.raises(
        GuardStop, match=r"'rows' \(sink\) returned .* from takes; it must be an array of True"
    ):
        simulation.advance()
