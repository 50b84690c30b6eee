"""The page of a run: its ledger, what plug-ins measure, colours of their fields; pages of runs that stop."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from browser import window
from test_page import CASES, COARSE, a_slump, data_of, text_of
from test_particle_fields import case as two_laws
from test_particle_fields import registry  # noqa: F401

from mpmkit.case import load_case
from mpmkit.errors import GuardStop, Interrupted
from mpmkit.output import RunDirectory
from mpmkit.output.flow import read_flow
from mpmkit.output.netcdf import read_dataset
from mpmkit.report.page import page_of
from mpmkit.report.page.packing import LEVELS_8, Packed, Scale, unpacked
from mpmkit.running.runner import resume, run
from mpmkit.solver.simulation import Simulation

MEASURED = [
    'output.diagnostics={"gate": {"kind": "flux", "axis": "r", "at": 0.12}}',
    'output.fields={"viscosity": {"kind": "apparent-viscosity"}}',
    'measurements={"part": {"formula": "height / 0.3", "unit": "1", "description": "height over the first"}}',
]


@pytest.fixture(scope="module")
def slump(tmp_path_factory) -> Path:
    return a_slump(tmp_path_factory.mktemp("run") / "slump", *MEASURED)


@pytest.fixture(scope="module")
def aged(tmp_path_factory, registry) -> Path:  # noqa: F811
    """Two bodies side by side; only the law of the second has the state ``age``."""
    directory = tmp_path_factory.mktemp("run") / "aged"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mpmkit.report.draw_pictures", lambda directory: [])
        run(two_laws(registry, report=True), directory, threads=1)
    return directory


def rows_of_ledger(page: str) -> dict[str, list[float]]:
    """The entries of the table of causes, by cause."""
    table = re.search(r"<caption>What has changed.*?<tbody>(.*?)</tbody>", page, re.S)[1]
    found = {}
    for row in re.findall(r"<tr>(.*?)</tr>", table):
        cells = re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row)
        found[cells[0]] = [float(cell.replace("−", "-").replace("\u202f", "")) for cell in cells[1:]]
    return found


def test_the_table_of_causes_adds_up_and_is_that_of_the_history(slump):
    """Mass, momentum along z and energy: gravity pulls with m g t, and the floor carries the most of it."""
    history, rows = read_dataset(slump / "history.nc"), rows_of_ledger(page_of(slump))
    mass, end = float(history.total_mass[0]), float(history.time[-1])
    assert rows["gravity"][1] == pytest.approx(-mass * 9.81 * end, rel=1e-3)
    assert rows["walls"][1] == pytest.approx(
        float(history.ledger_momentum[-1].sel(cause="walls")[1]), rel=1e-3
    )
    total = rows.pop("sum: at the end")
    assert np.sum(list(rows.values()), axis=0) == pytest.approx(total, abs=2e-3 * mass * 9.81 * end)
    stored = sum(history[f"{kind}_energy"][-1] for kind in ("kinetic", "strain", "compressive"))
    assert total[2] == pytest.approx(float(stored), rel=1e-3)
    assert rows["rest"][:2] == [0.0, 0.0]


def test_the_energy_lost_is_what_gravity_released_and_the_material_does_not_hold(slump):
    history, text = read_dataset(slump / "history.nc"), text_of(page_of(slump))
    energies = ("potential_energy", "kinetic_energy", "strain_energy", "compressive_energy")
    start, end = (sum(float(history[name][row]) for name in energies) for row in (0, -1))
    lost = start - end + float(history.redistribution_energy[-1])
    assert float(re.search(r"Energy lost in the flow ([\d.]+) J", text)[1]) == pytest.approx(lost, rel=0.01)


def test_what_the_case_measures_is_on_the_page(slump):
    """A chart for each column of a diagnostic, and a result for each measurement."""
    history, page = read_dataset(slump / "history.nc"), page_of(slump)
    charts = data_of(page)["measured"]["charts"].values()
    curves = {curve["label"]: (chart, curve) for chart in charts for curve in chart["curves"]}
    assert list(curves) == ["gate.mass_flux", "gate.volume_flux", "part"]
    chart, curve = curves["gate.mass_flux"]
    assert (chart["title"], chart["unit"]) == ("Mass flux through r = 0.12 m", "kg/s")
    np.testing.assert_allclose(curve["values"], history["gate.mass_flux"], rtol=1e-6)
    part = float(history.part[-1])
    assert f"Part {part:.3f} height over the first, at the end" in text_of(page)


def test_a_field_of_the_case_is_among_the_colours(slump):
    flow = data_of(page_of(slump))["flow"]
    viscosity = next(quantity for quantity in flow["quantities"] if quantity["name"] == "viscosity")
    assert (viscosity["label"], viscosity["unit"]) == ("Viscosity", "Pa s")
    assert viscosity["gaps"]  # at the start nothing is sheared
    assert "grey where it has no value" in viscosity["meaning"]


def test_a_state_of_a_law_is_shown_where_the_material_has_it(aged):
    """The code is 0 in the other material; in its own, the age is the time of the moment."""
    flow = data_of(page_of(aged))["flow"]
    scale = next(quantity for quantity in flow["quantities"] if quantity["name"] == "law.age")
    moments = unpacked(Packed(flow["blob"], flow["packing"]))
    for moment, about in zip(moments, flow["packing"]["moments"], strict=True):
        own = moment["body"] == 1
        assert (moment["law.age"][~own] == 0).all()
        value = scale["low"] + (scale["high"] - scale["low"]) * (moment["law.age"][own] - 1.0) / (
            LEVELS_8 - 1
        )
        assert value == pytest.approx(about["time"], abs=(scale["high"] - scale["low"]) / LEVELS_8)


def test_a_record_of_the_flow_keeps_the_added_fields(aged):
    for moment in read_flow(RunDirectory(aged).flow):
        age = moment.added["law.age"]
        assert np.isnan(age[moment.body == 0]).all()
        assert age[moment.body == 1] == pytest.approx(moment.time)
        assert "law.back_stress" not in moment.added  # a tensor has no colour


def test_code_zero_is_for_particles_without_a_value():
    codes = Scale(1.0, 3.0, gaps=True).codes(np.array([np.nan, 1.0, 2.0, 3.0, 9.0]))
    assert codes.tolist() == [0, 1, 128, 255, 255]


def test_a_browser_shows_grey_where_a_law_has_no_such_state(aged):
    """Grey on the left, a colour on the right; the pointer's value says so too."""
    with window() as browser:
        browser.look(1200)
        browser.open(RunDirectory(aged).page)
        browser.find("[name=colour][value='law.age']").click()
        browser.run("mpmkit.page.player.seek(0.005)")
        pixel = (
            "const view = mpmkit.page.player.view, gl = view.surface.gl, bytes = new Uint8Array(4);"
            "const [px, py] = view.place(arguments[0], 0.05);"
            "gl.readPixels(px, gl.canvas.height - py, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);"
            "return [...bytes]"
        )
        assert browser.run(pixel, -0.1) == [0x98, 0xA2, 0xAB, 255]
        red, green, blue, _ = browser.run(pixel, 0.1)
        assert max(red, green, blue) - min(red, green, blue) > 60
        under = (
            "const { view, flow } = mpmkit.page.player;"
            "return view.under(flow, ...view.place(arguments[0], 0.05)).value"
        )
        assert browser.run(under, -0.1) == -1
        assert 0.3 < browser.run(under, 0.1) < 0.7  # half of the run has passed
        assert browser.errors() == []
        assert browser.requests() == []


def stopped_at(step: int, monkeypatch, what):
    """Let ``what`` happen to the simulation before a step."""
    advance = Simulation.advance

    def spoilt(self, *arguments):
        if self.steps == step:
            what(self)
        return advance(self, *arguments)

    monkeypatch.setattr(Simulation, "advance", spoilt)


def interrupt(simulation: Simulation) -> None:
    raise KeyboardInterrupt


def diverge(simulation: Simulation) -> None:
    simulation.particles.velocity[:] = np.nan


def test_an_interrupted_run_has_a_page_at_once(tmp_path, monkeypatch):
    directory = tmp_path / "run"
    with monkeypatch.context() as patch:
        stopped_at(120, patch, interrupt)
        with pytest.raises(Interrupted):
            a_slump(directory)
    page = RunDirectory(directory).page.read_text(encoding="utf-8")
    assert "The run was interrupted at t = " in text_of(page)
    assert "Spread so far" in text_of(page)
    assert data_of(page)["flow"]["packing"]["moments"]


def test_the_page_of_an_interrupted_run_says_how_to_continue_and_is_replaced_then(tmp_path, monkeypatch):
    directory, case = tmp_path / "run", load_case(CASES / "slump_fast.json", COARSE)
    monkeypatch.setattr("mpmkit.report.draw_pictures", lambda directory: [])
    with monkeypatch.context() as patch:
        stopped_at(120, patch, interrupt)
        with pytest.raises(Interrupted):
            run(case, directory, threads=1, checkpoint_every=0.01)
    continued = "To continue the run: mpmkit run --resume DIRECTORY."
    assert continued in text_of(RunDirectory(directory).page.read_text(encoding="utf-8"))
    resume(directory, threads=1)
    text = text_of(RunDirectory(directory).page.read_text(encoding="utf-8"))
    assert continued not in text
    assert "The run came to its end at t = 0.300 s" in text


@pytest.mark.parametrize("step", [0, 1, 60])
def test_a_run_that_diverges_has_a_page_at_once(tmp_path, monkeypatch, step):
    """Also in its first step, where its history has only the row of the start."""
    stopped_at(step, monkeypatch, diverge)
    with pytest.raises(GuardStop):
        a_slump(tmp_path / "run")
    page = RunDirectory(tmp_path / "run").page.read_text(encoding="utf-8")
    assert "A guard stopped the run" in text_of(page)
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["stopped_because"] == "non-finite"
