"""Pages of studies and of stability maps: their content, also in a browser."""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest
import xarray
from browser import window

from mpmkit.stability import page as stability_page
from mpmkit.stability.trial import ROWS as TRIAL_ROWS
from mpmkit.stability.trial import Trace
from mpmkit.stability.trials import Trials
from mpmkit.study import page as study_page

TIME = np.linspace(0, 1, 21)
STEPS = np.linspace(0, 1, TRIAL_ROWS)
ORDERS = ["usl", "usf", "musl"]
ROWS = [
    {
        "order": "usl",
        "limit": "acoustic",
        "fraction": 0.5,
        "unstable": 0.6,
        "broken": "energy",
        "declared": 1.0,
    },
    {
        "order": "usf",
        "limit": "acoustic",
        "fraction": 2.0,
        "unstable": math.inf,
        "broken": None,
        "declared": 1.0,
    },
]


@pytest.fixture
def study(tmp_path):
    """A study of three orders: usl is the finest, usf is 10 % off, and musl stopped."""
    dims = ("scheme.order",)
    spread = np.stack([1 + TIME, 1 + 1.2 * TIME, np.where(TIME < 0.5, 1 + TIME, np.nan)])
    fields = {
        "spread_diameter": ((*dims, "time"), spread, {"units": "m"}),
        "fate": (dims, np.array(["finished", "finished", "energy"], dtype=object)),
        "sentence": (dims, np.array(["", "", ""], dtype=object)),
    }
    for name in ("t500", "final_spread", "final_slump", "final_height", "particles", "steps"):
        fields[name] = (dims, np.array([0.2, 0.3, np.nan]))
    for name in ("cpu_seconds", "memory_bytes", "simulated_time"):
        fields[name] = (dims, np.ones(3))
    fields["wall_seconds"] = (dims, np.array([8.0, 2.0, 1.0]))
    fields["particle_steps"] = (dims, np.array([1e6, 1e5, 1e4]))
    for name in ORDERS:
        member = tmp_path / "members" / f"order-{name}"
        member.mkdir(parents=True)
        (member / "member.json").write_text(json.dumps({"labels": {"scheme.order": name}}))
    dataset = xarray.Dataset(
        fields, {"scheme.order": ORDERS, "time": TIME}, {"title": "orders", "study": "{}"}
    )
    return study_page.write_page(dataset, tmp_path)


def data_of(path) -> dict:
    page = path.read_text(encoding="utf-8")
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)[1])


def test_the_page_of_a_study_has_error_against_cost_and_a_linked_table(study):
    page = study.read_text(encoding="utf-8")
    assert "2 of 3 members finished. 1 stopped before the end; the table says why." in page
    assert re.findall(r'href="(members/[^"]*)"', page) == [f"members/order-{name}/" for name in ORDERS]
    assert "energy at 1 s" in page
    cost = data_of(study)["cost"]["charts"]["cost"]
    assert (cost["names"], cost["x"]) == (["order usf"], [2.0])  # usl is what it is judged by
    assert cost["curves"][0]["values"] == pytest.approx([0.1])
    spread = data_of(study)["histories"]["charts"]["spread-diameter"]
    assert [curve["label"] for curve in spread["curves"]] == [f"order {name}" for name in ORDERS]
    assert spread["curves"][1]["values"][-1] == pytest.approx(2200)  # mm
    assert spread["curves"][2]["values"][-1] is None


def test_the_page_of_a_map_has_a_bar_and_a_row_for_each_combination(tmp_path):
    path = stability_page.write_page(ROWS, ["order"], "tank", tmp_path / "map")
    page = path.read_text(encoding="utf-8")
    assert page.count('class="stable"') == 2
    assert page.count('class="broken"') == 1  # usf has no unstable step
    assert "stable up to 0.5; creates energy at 0.6" in page
    widths = [float(width) for width in re.findall(r'class="stable"[^>]* width="([\d.]+)"', page)]
    per_decade = stability_page.WIDTH / math.log10(stability_page.MOST / stability_page.LEAST)
    assert widths[1] - widths[0] == pytest.approx(per_decade * math.log10(4), abs=0.2)


def trace(of: np.ndarray, rows: int = len(STEPS)) -> Trace:
    """A trial of one particle at ``of`` (rows,), with the energy of its place; fewer rows if it stopped."""
    position = of[:rows, None, None] * np.ones((1, 1, 2))
    one = np.ones(rows)
    stopped = None if rows == len(STEPS) else "energy"
    return Trace(STEPS[:rows], of[:rows], one, one[:, None], position, np.ones(1), stopped)


def test_the_page_of_a_map_shows_the_trials_at_the_limit(tmp_path):
    """Energies of all three; the distance of an unstable trial ends where a guard stopped it."""
    trials = [Trials(trace(0 * STEPS), trace(0.1 * STEPS), trace(STEPS, rows=20)), Trials(None, None, None)]
    path = stability_page.write_page(ROWS, ["order"], "tank", tmp_path / "map", trials)
    charts = data_of(path)["trials"]["charts"]
    assert list(charts) == ["energy-0", "apart-0"]  # usf has no fine solution
    labels = [curve["label"] for curve in charts["energy-0"]["curves"]]
    assert labels == ["fine solution", "largest stable step, 0.5", "smallest unstable step, 0.6"]
    fine, stable, unstable = (curve["values"] for curve in charts["apart-0"]["curves"])
    assert fine == [0.0] * TRIAL_ROWS
    assert stable[-1] == pytest.approx(0.1 * math.sqrt(2))
    assert unstable[19] == pytest.approx(STEPS[19] * math.sqrt(2))
    assert unstable[20:] == [None] * 20


def test_a_browser_shows_both(study, tmp_path):
    trials = [Trials(trace(0 * STEPS), trace(0.1 * STEPS), trace(STEPS, rows=20)), Trials(None, None, None)]
    path = stability_page.write_page(ROWS, ["order"], "tank", tmp_path / "map", trials)
    with window() as browser:
        browser.look(390)
        for page in (study, path):
            browser.open(page)
            assert browser.run("return document.documentElement.scrollWidth") <= 390
        browser.find("#trials summary").click()
        browser.until("mpmkit.page.charts.every(({ u }) => u.width > 250)")  # drawn when its place has a size
        browser.open(study)
        browser.run("mpmkit.page.charts[0].moveTo(0)")
        text = " ".join(browser.find("[data-chart=cost] .values").text.split())
        assert text == "order usf wall time of the run 2.000 s cheapest for its error 0.1000"
        assert browser.errors() == []
        assert browser.requests() == []
