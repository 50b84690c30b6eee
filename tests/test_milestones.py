"""T500 and rest: found from the steps, independently of the history; and the messages at the end of a run."""

import json
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray
from test_cli import status

import mpmkit
from mpmkit.running.lift import from_lift, lift_start
from mpmkit.running.milestones import LOOKS, Milestones
from mpmkit.running.setting import setting
from mpmkit.solver.simulation import Simulation

CASES = Path(__file__).parents[1] / "cases"
LIFTED = CASES / "slump_lifted.json"
CAKE = {
    "name": "cake",
    "space": "axisymmetric",
    "until": 0.2,
    "grid": {"cell_size": 0.02, "domain": {"r": [0, 0.4], "z": [0, 0.12]}, "faces": {"z_min": "slip"}},
    "bodies": [
        {
            "shape": {"kind": "cylinder", "radius": 0.24, "height": 0.1},
            "material": {
                "law": "bingham-evp", "density": 2000, "yield_stress": 50, "plastic_viscosity": 20,
                "sound_speed": {"factor": 10},
            },
        }
    ],
    "output": {"report": False},
}  # fmt: skip
"""A flat cylinder, 0.48 m wide, that spreads beyond 0.5 m within 0.1 s."""


def cake(**output):
    return mpmkit.parse_case(CAKE | {"output": {"report": False} | output})


def scripted(spread, speed=lambda t: 1.0, step=0.01, height=0.1, centre=lambda t: 0.0):
    """A stand-in for a simulation, whose spread, RMS speed and centre of mass follow functions of time; the
    material is as high at all times."""
    case = SimpleNamespace(height=height, space_=SimpleNamespace(radial=False))
    scene = SimpleNamespace(
        time=0.0, steps=0, case=case, settled=True, grid=SimpleNamespace(periodic=np.zeros(2, dtype=bool))
    )
    scene.particles = SimpleNamespace(mass=np.ones(3), velocity=np.zeros((3, 2)), position=np.zeros((3, 2)))
    scene.measures = SimpleNamespace(spread=lambda p: spread(scene.time), height=lambda p: height)
    milestones = Milestones(scene)

    def go(steps):
        for _ in range(steps):
            scene.particles.velocity[:, 0] = speed(scene.time)
            scene.particles.position[:, 0] = centre(scene.time)
            milestones.watch()
            scene.time += step
            scene.steps += 1
        scene.particles.velocity[:, 0] = speed(scene.time)
        milestones.watch()

    return scene, milestones, go


@pytest.fixture(scope="module")
def every_step():
    return mpmkit.run(cake(history_interval=1e-5 * 20))


class TestT500:
    @pytest.mark.parametrize("interval", [0.001, 0.01, 0.05, 0.2])
    def test_does_not_depend_on_what_is_recorded(self, every_step, interval):
        found = mpmkit.run(cake(history_interval=interval))
        assert found.attrs["t500"] == pytest.approx(every_step.attrs["t500"], abs=1e-12)
        for name in ("final_spread", "final_slump", "final_height", "final_spread_rate"):
            assert found.attrs[name] == every_step.attrs[name]

    def test_is_where_a_history_of_all_steps_rises_to_it(self, every_step):
        rows = every_step.spread_diameter.values
        after = int(np.argmax(rows >= 0.5))
        time = every_step.time.values[after - 1 : after + 1]
        assert np.diff(time) < 1.01 * every_step.time_step.values[after]  # two steps that follow each other
        assert every_step.attrs["t500"] == pytest.approx(np.interp(0.5, rows[after - 1 : after + 1], time))

    def test_is_linear_between_two_steps(self):
        _, milestones, go = scripted(lambda t: 0.4 + 0.1 * t)
        go(130)
        assert milestones.t500() == pytest.approx(1.0, abs=1e-12)

    def test_a_jump_between_two_checks_is_not_missed(self):
        _, milestones, go = scripted(lambda t: 0.3 if t < 0.55 else 0.7)
        go(2 * LOOKS * 3)
        assert 0.4 < milestones.t500() <= 0.6

    @pytest.mark.parametrize("spread", [lambda t: 0.6 + t, lambda t: 0.4, lambda t: np.nan])
    def test_without_a_crossing_there_is_no_t500(self, spread):
        _, milestones, go = scripted(spread)
        go(100)
        milestones.finish()
        assert milestones.t500() is None

    def test_a_crossing_after_the_last_check_of_the_guards_does_not_count(self):
        """The guards check every 20 steps; the crossing is in step 51, and the stop in step 55 or 65."""
        scene, milestones, go = scripted(lambda t: 0.4 if t < 0.505 else 9.0)
        go(40)
        milestones._seen.close = 1.0
        go(15)
        assert milestones.t500() is not None
        assert milestones.t500(trusted=False) is None
        scene.steps = 65
        assert milestones.t500(trusted=False) is not None

    def test_goes_on_from_a_checkpoint(self):
        """At any step, before and after the crossing: the same numbers as without a stop."""
        whole = mpmkit.run(cake()).attrs
        for stop in (31, 150, 333):
            simulation = Simulation(cake())
            milestones = Milestones(simulation)
            milestones.watch()
            while simulation.time < 0.2 * (1 - 1e-9):
                simulation.advance(0.2 - simulation.time)
                milestones.watch()
                if simulation.steps == stop:
                    state = {name: array.copy() for name, array in milestones.state().items()}
                    milestones = Milestones(simulation)
                    milestones.restore(state)
            milestones.finish()
            assert milestones.t500() == whole["t500"]
            assert milestones.spreading == whole["final_spread_rate"]


class TestRest:
    def test_is_when_neither_speed_nor_spread_go_on(self):
        """The speed falls below a hundredth of its largest at t = 1.84 s, the rate of the spread earlier."""
        speed = lambda t: min(1.0, 10 * t) * np.exp(-2.5 * t)  # noqa: E731
        _, milestones, go = scripted(lambda t: 0.3 + 0.1 * (1 - np.exp(-5 * t)), speed, step=1e-3)
        go(1800)
        assert milestones.at_rest_since is None
        go(600)
        largest = speed(0.1)
        slow = np.log(1 / (0.01 * largest)) / 2.5
        assert milestones.at_rest_since == pytest.approx(slow, abs=0.025)

    def test_creeping_material_is_not_at_rest(self):
        _, milestones, go = scripted(lambda t: 0.3 + 0.004 * t, lambda t: 1.0 if t < 0.5 else 1e-3, step=1e-3)
        go(5000)
        assert milestones.at_rest_since is None
        assert milestones.spreading == pytest.approx(0.004)

    def test_material_that_levels_in_a_channel_is_not_at_rest(self):
        """Its spread has reached both ends of the channel, and it moves at a 200th of its largest speed; its
        centre goes on with a rate that falls by e in 0.5 s, at first 5 mm/s."""
        centre = lambda t: -0.5 * 5e-3 * np.exp(-2 * t)  # noqa: E731
        _, milestones, go = scripted(
            lambda t: 0.8, lambda t: 1.0 if t < 0.01 else 5e-3 * np.exp(-2 * t), step=1e-3, centre=centre
        )
        go(300)
        assert milestones.at_rest_since is None
        go(700)
        # In h/U = 0.1 s it may go a 500th of 0.1 m; it is checked every 0.02 s.
        slow = np.log(2.5e-3 * (1 - np.exp(-0.2)) / 2e-4) / 2
        assert milestones.at_rest_since == pytest.approx(slow, abs=0.06)

    def test_an_elastic_oscillation_counts_as_rest(self):
        """The spread oscillates by 0.1 mm at 8 mm/s, after motion at 1 m/s."""
        _, milestones, go = scripted(
            lambda t: 0.3 + 1e-4 * np.sin(80 * t), lambda t: 1.0 if t < 0.5 else 4e-3, step=1e-3
        )
        go(1000)
        assert milestones.at_rest_since == pytest.approx(0.5, abs=0.025)

    def test_a_moment_without_motion_is_not_rest(self):
        """A vibration stands still twice in a period."""
        _, milestones, go = scripted(lambda t: 0.3, lambda t: np.cos(np.pi * t), step=1e-3, height=1.0)
        go(500)
        assert milestones.at_rest_since is None

    def test_of_a_slump(self):
        """It falls, and comes to rest long before the end; from then on hardly any energy is left."""
        changes = ["grid.cell_size=0.03", 'grid.domain={"r": [0, 0.36], "z": [0, 0.33]}', "until=2.6"]
        history = mpmkit.run(mpmkit.load_case(CASES / "slump.json", [*changes, "output.report=false"]))
        since = history.attrs["at_rest_since"]
        assert (
            1.2 < since < 2.0
        )  # it slows below a 100th of its fastest at 1.4 s, and must keep still for 0.5 s
        still = history.time.values >= since
        energy = history.kinetic_energy.values
        assert energy[still].max() <= 1.1e-4 * energy.max()
        spread = history.spread_diameter.values
        assert np.ptp(spread[still]) < 1.5e-3
        assert spread[still][0] > 0.5
        assert abs(history.attrs["final_spread_rate"]) < 1e-2

    def test_the_end_says_if_the_material_still_flows(self, every_step, tmp_path, capsys):
        (tmp_path / "cake.json").write_text(json.dumps(CAKE))
        arguments = ["--until", "0.1", "--out", tmp_path / "run"]
        assert status("run", tmp_path / "cake.json", *arguments) == 0
        summary = json.loads((tmp_path / "run" / "summary.json").read_text())
        assert summary["at_rest_since"] is None
        before = (every_step.time > 0.095) & (every_step.time < 0.1)
        rate = np.polyfit(every_step.time[before], every_step.spread_diameter[before], 1)[0]
        assert summary["final_spread_rate"] == pytest.approx(rate, rel=0.05)
        said = capsys.readouterr()
        sentence = f"still spreading, {summary['final_spread_rate'] * 1e3:.3g} mm/s"
        assert f"{summary['final_spread'] * 1e3:.1f} mm, {sentence}\n" in said.out
        assert sentence in (tmp_path / "run" / "run.log").read_text()


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    directory = tmp_path_factory.mktemp("said")
    (directory / "cake.json").write_text(json.dumps(CAKE | {"until": 0.1}))
    assert status("run", directory / "cake.json", "--out", directory / "run", "--quiet") == 0
    return directory / "run"


class TestWhatIsSaid:
    def test_the_log_has_command_versions_setting_and_results(self, run):
        log = (run / "run.log").read_text()
        summary = json.loads((run / "summary.json").read_text())
        assert f"mpmkit {mpmkit.__version__}, numpy {np.__version__}" in log
        assert "command: " in log
        assert "law bingham-evp (mpmkit " in log
        assert "floor: z_min is free slip" in log
        assert "a T500 measured in a laboratory also includes the time in which the cone is lifted" in log
        assert f"t500 = {summary['t500']:.6g} s, final_spread = {summary['final_spread']:.6g} m" in log
        assert log.index("command") < log.index("floor") < log.index("t500")

    def test_the_numbers_are_attributes_of_the_history(self, run):
        summary = json.loads((run / "summary.json").read_text())
        with xarray.open_dataset(run / "history.nc") as history:
            for name in summary["units"]:
                value = summary[name]
                assert history.attrs[name] == (pytest.approx(np.nan, nan_ok=True) if value is None else value)
        assert 0.02 < history.attrs["t500"] < 0.1

    @pytest.mark.parametrize(
        ("faces", "floor"),
        [
            ({"z_min": "stick"}, "stick, so that the material does not slide on it"),
            ({"z_min": {"kind": "friction", "coefficient": 0.4}}, "friction, with the coefficient 0.4"),
            (
                {"z_min": {"kind": "stick", "releases": True}},
                "stick, so that the material does not slide on it, and releases it where it would have to "
                "pull",
            ),
            ({}, None),
        ],
    )
    def test_each_floor_has_its_words(self, faces, floor):
        said = setting(mpmkit.parse_case(CAKE | {"grid": CAKE["grid"] | {"faces": faces}}))
        assert [line for line in said if line.startswith("floor")] == (
            [] if floor is None else [f"floor: z_min is {floor}"]
        )

    def test_a_mould_is_named_and_is_no_release_at_once(self):
        said = setting(mpmkit.load_case(LIFTED))
        held = "release: from t = 0 on the material is held by walls.mould alone; T500 counts from t = 0"
        assert held in said

    def test_a_mould_that_is_lifted_later_is_said_to_count_from_there(self):
        case = mpmkit.load_case(LIFTED, ["walls.mould.surface.motion.start=0.5"])
        assert any(
            line.endswith("T500 counts from t = 0, and t500_from_lift from the start of the lift, t = 0.5 s")
            for line in setting(case)
        )


LID = {"kind": "plane", "point": [0, 0.11], "normal": [0, -1]}


def rising(**motion):
    """A lid above the cake that moves, and so is taken for a mould."""
    motion = {"kind": "velocity", "velocity": [0, 0.1]} | motion
    return CAKE | {"walls": {"lid": {"surface": LID | {"motion": motion}, "contact": "slip"}}}


class TestFromTheLift:
    @pytest.mark.parametrize(
        ("motion", "start"),
        [
            ({"start": 0.03}, 0.03),
            ({}, 0.0),
            ({"start": -0.2, "end": -0.15}, None),
            ({"start": 5.0}, None),
            ({"velocity": [0, 0.0]}, None),
        ],
        ids=["later", "at once", "before the run", "after it", "never"],
    )
    def test_the_lift_starts_when_a_wall_begins_to_move(self, motion, start):
        assert lift_start(mpmkit.parse_case(rising(**motion))) == start

    def test_of_a_table_it_is_where_the_first_displacement_begins(self):
        table = {"kind": "table", "times": [0.0, 0.07, 0.1], "positions": [[0, 0], [0, 0], [0, 0.02]]}
        data = CAKE | {"walls": {"lid": {"surface": LID | {"motion": table}, "contact": "slip"}}}
        assert lift_start(mpmkit.parse_case(data)) == 0.07

    def test_of_two_walls_it_is_the_first(self):
        data = rising(start=0.05)
        data["walls"]["other"] = rising(start=0.02)["walls"]["lid"]
        data["walls"]["still"] = {"surface": LID, "contact": "slip"}
        assert lift_start(mpmkit.parse_case(data)) == 0.02

    def test_it_does_not_depend_on_the_length_of_the_run(self):
        data = rising(start=1 / 30)
        starts = {lift_start(mpmkit.parse_case(data | {"until": until})) for until in (0.2, 0.3, 1.7)}
        assert len(starts) == 1

    def test_a_case_without_a_moving_wall_has_none(self):
        assert lift_start(cake()) is None
        assert lift_start(mpmkit.load_case(LIFTED)) == 0.0

    @pytest.mark.parametrize(
        ("t500", "lifted", "expected"),
        [(0.9, 0.3, 0.6), (0.9, 0.0, 0.9), (None, 0.3, None), (0.2, 0.3, None), (0.2, None, None)],
    )
    def test_it_is_the_time_since_then(self, t500, lifted, expected):
        assert from_lift(t500, lifted) == (None if expected is None else pytest.approx(expected))

    def test_both_are_in_the_summary_and_said_where_they_differ(self, tmp_path, capsys):
        said = {}
        for start in (0.0, 0.03):
            (tmp_path / "case.json").write_text(json.dumps(rising(start=start)))
            out = tmp_path / f"run{start}"
            assert status("run", str(tmp_path / "case.json"), "--out", str(out)) == 0
            said[start] = capsys.readouterr().out
            summary = json.loads((out / "summary.json").read_text())
            assert summary["t500_from_lift"] == pytest.approx(summary["t500"] - start, abs=1e-12)
            assert summary["units"]["t500_from_lift"] == "s"
            attributes = xarray.open_dataset(out / "history.nc").attrs
            assert attributes["t500_from_lift"] == summary["t500_from_lift"]
            log = (out / "run.log").read_text()
            assert ("t500_from_lift = " in log) == (start > 0)
        assert "T500 from the lift" not in said[0.0]
        assert re.search(rf"T500 from the lift +{summary['t500_from_lift']:.3f} s", said[0.03])

    def test_without_a_mould_it_does_not_apply(self, every_step):
        assert np.isnan(every_step.attrs["t500_from_lift"])
        assert every_step.attrs["t500"] > 0

    @pytest.mark.parametrize(
        ("override", "place", "value"),
        [
            ("walls.mould.surface.motion.velocity.1=0.15", ("surface", "motion", "velocity"), [0, 0.15]),
            ("walls.mould.surface.motion.velocity=[0, 0.1]", ("surface", "motion", "velocity"), [0, 0.1]),
            ("walls.mould.surface.motion.start=0.5", ("surface", "motion", "start"), 0.5),
            ("walls.mould.contact=stick", ("contact", "name"), "stick"),
            ("walls.mould.contact.kind=stick", ("contact", "name"), "stick"),
        ],
    )
    def test_speed_delay_and_contact_of_the_mould_are_set_on_the_command_line(self, override, place, value):
        found = mpmkit.load_case(LIFTED, [override]).walls["mould"]
        for name in place:
            found = getattr(found, name)
        assert found == value

    def test_a_coulomb_mould_is_set_by_two_options(self):
        options = ["walls.mould.contact=coulomb", "walls.mould.contact.coefficient=0.2"]
        contact = mpmkit.load_case(LIFTED, options).walls["mould"].contact
        assert (contact.name, contact.coefficient) == ("coulomb", 0.2)
