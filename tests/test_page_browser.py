"""The page of a run in a real browser: it plays, turns, reads values, and needs no network."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from browser import Window, window

from mpmkit.case import load_case
from mpmkit.output import RunDirectory
from mpmkit.output.netcdf import read_dataset
from mpmkit.report.page import MOST_BYTES
from mpmkit.running.runner import run

CASES = Path(__file__).parents[1] / "cases"
SECTION = [
    "grid.cell_size=0.04",
    'grid.domain={"r": [0, 0.36], "z": [0, 0.32]}',
    "walls.mould.surface.thickness=0.04",
    "until=0.2",
]
SOLID = [
    "grid.cell_size=0.05",
    'grid.domain={"x": [0, 0.4], "y": [0, 0.4], "z": [0, 0.35]}',
    "bodies.0.particles_per_cell=8",
    "until=0.05",
]
PICTURE = "return document.querySelector('canvas.{}').toDataURL()"
PLAYER = "mpmkit.page.player"


def a_run(directory: Path, case: str, changes: list[str]) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mpmkit.report.draw_pictures", lambda directory: [])  # they take longer than all else
        run(load_case(CASES / case, changes), directory, threads=1)
    return directory


@pytest.fixture(scope="module")
def section(tmp_path_factory) -> Path:
    """A slump with its mould, axisymmetric."""
    return a_run(tmp_path_factory.mktemp("section") / "run", "slump_lifted.json", SECTION)


@pytest.fixture(scope="module")
def browser():
    with window() as opened:
        yield opened


@pytest.fixture
def page(browser: Window, section: Path) -> Window:
    browser.look(1200)
    browser.open(RunDirectory(section).page)
    return browser


@pytest.fixture(autouse=True)
def nothing_goes_wrong(browser: Window):
    """Whatever is done to a page: no error in the console, and nothing asked of a network."""
    yield
    assert browser.errors() == []
    assert browser.requests() == []


def test_the_slider_moves_the_material_and_the_wall(page: Window):
    def at(value: int) -> tuple[str, str, str]:
        page.run(
            "const slider = document.querySelector('.time'); slider.value = arguments[0];"
            "slider.dispatchEvent(new Event('input'))",
            value,
        )
        return (
            page.run(PICTURE.format("material")),
            page.run(PICTURE.format("over")),
            page.find(".clock").text,
        )

    begin, end = at(0), at(1000)
    assert begin[0] != end[0]
    assert begin[1] != end[1]
    assert (begin[2], end[2]) == ("t = 0.000 s", "t = 0.200 s")


def test_the_picture_is_of_the_material(page: Window):
    """There is material above the floor and at the top, and none beside the cone."""
    page.run(f"{PLAYER}.seek(0)")
    pixel = (
        "const [x, y] = arguments, view = mpmkit.page.player.view, gl = view.surface.gl;"
        "const [px, py] = view.place(x, y), bytes = new Uint8Array(4);"
        "gl.readPixels(px, gl.canvas.height - py, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);"
        "return [...bytes]"
    )
    assert page.run(pixel, 0.05, 0.02)[3] == 255
    assert page.run(pixel, -0.05, 0.02)[3] == 255  # its mirror image
    assert page.run(pixel, 0.0, 0.28)[3] == 255
    assert page.run(pixel, 0.09, 0.2)[3] == 0  # beside the cone, whose radius is 67 mm there
    assert page.run(pixel, 0.0, 0.31)[3] == 0


def test_play_advances_and_stops(page: Window):
    page.run(f"{PLAYER}.seek(0)")
    page.run(f"{PLAYER}.paces.selectedIndex = 0")  # the slowest: a busy machine must not come to the end
    page.find(".play").click()
    page.until(f"{PLAYER}.time > 0")
    assert page.find(".play").get_attribute("aria-label") == "Pause"
    page.find(".play").click()
    page.until(f"!{PLAYER}.playing")  # a busy machine takes its time for a click
    assert page.find(".play").get_attribute("aria-label") == "Play"
    time = page.run(f"return {PLAYER}.time")
    page.run("return new Promise((done) => setTimeout(done, 150))")
    assert page.run(f"return {PLAYER}.time") == time


def test_each_quantity_has_its_colours_and_its_bar(page: Window):
    page.run(f"{PLAYER}.seek(0.1)")
    pictures, bars = set(), set()
    for name in ("speed", "shear_rate", "yielded", "pressure"):
        page.find(f"[name=colour][value={name}]").click()
        pictures.add(page.run(PICTURE.format("material")))
        bars.add(page.run("return document.querySelector('.bar canvas').toDataURL()"))
    assert len(pictures) == len(bars) == 4
    assert page.find(".meaning").text.startswith("Pressure (Pa): ")


def test_the_pointer_reads_the_material(page: Window):
    page.run(f"{PLAYER}.seek(0)")
    place = page.run(f"return {PLAYER}.view.place(0.03, 0.1)")
    stage = page.find(".stage")
    page.run("arguments[0].scrollIntoView({ block: 'center' })", stage)  # or its middle were that of a part
    box = stage.rect
    page.actions().move_to_element_with_offset(
        stage, place[0] - box["width"] / 2, place[1] - box["height"] / 2
    ).perform()
    reading = page.find(".reading").text
    value, r, z = re.fullmatch(r"(\S+) m/s · r = (\S+) mm, z = (\S+) mm", reading).groups()
    assert float(value) == 0
    assert (float(r), float(z)) == pytest.approx((30, 100), abs=2)  # a pixel


def test_a_chart_reads_the_value_of_the_history(page: Window, section: Path):
    """With the keys: the 101st row, whose spread is that of the history to the digits that are shown."""
    history = read_dataset(section / "history.nc")
    plot = page.find("[data-chart=shape] .plot")
    page.run("arguments[0].focus()", plot)
    page.run("mpmkit.page.charts[0].moveTo(100)")
    text = page.find("[data-chart=shape] .values").text
    assert f"spread {1e3 * float(history.spread_diameter[100]):.1f} mm" in " ".join(text.split())
    from selenium.webdriver.common.keys import Keys

    plot.send_keys(Keys.ARROW_RIGHT)
    text = page.find("[data-chart=shape] .values").text
    assert f"spread {1e3 * float(history.spread_diameter[101]):.1f} mm" in " ".join(text.split())
    plot.send_keys(Keys.ENTER)  # sets the player to the time of the row
    assert page.run(f"return {PLAYER}.time") == pytest.approx(float(history.time[101]), rel=1e-5)


def test_charts_show_curves(page: Window):
    """Each chart has pixels of the colour of its first curve."""
    drawn = page.run(
        "return mpmkit.page.charts.map(({ u }) => { const { width, height } = u.ctx.canvas;"
        "const bytes = u.ctx.getImageData(0, 0, width, height).data; let count = 0;"
        "for (let k = 0; k < bytes.length; k += 4) {"
        "if (Math.abs(bytes[k]) < 8 && Math.abs(bytes[k + 1] - 114) < 8 && Math.abs(bytes[k + 2] - 178) < 8)"
        "count++; } return count; })"
    )
    assert len(drawn) >= 6
    assert min(drawn) > 50


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [390, 1200])
def test_nothing_scrolls_sideways(page: Window, width: int, dark: bool):
    page.look(width, dark=dark)
    page.until(f"innerWidth === {width}")
    assert page.run("return document.documentElement.scrollWidth") <= width
    background = page.run("return getComputedStyle(document.body).backgroundColor")
    lightness = np.mean([int(channel) for channel in background[4:-1].split(",")])
    assert lightness < 60 if dark else lightness > 200


def test_newer_data_are_taken_over_and_the_player_stays_at_its_time(page: Window, section: Path):
    page.run(f"{PLAYER}.seek(0.123)")
    page.find("[name=colour][value=pressure]").click()
    page.run("return mpmkit.take(arguments[0])", RunDirectory(section).page.read_text(encoding="utf-8"))
    assert page.run(f"return [{PLAYER}.time, {PLAYER}.name]") == [0.123, "pressure"]
    assert page.run("return document.querySelectorAll('.uplot').length") == page.run(
        "return document.querySelectorAll('[data-chart]').length"
    )


def test_a_scene_in_three_dimensions_turns_and_comes_nearer(browser: Window, tmp_path: Path):
    directory = a_run(tmp_path / "run", "slump_quarter.json", SOLID)
    path = RunDirectory(directory).page
    assert path.stat().st_size < MOST_BYTES
    browser.look(1200)
    browser.open(path)
    before = browser.run(PICTURE.format("material"))
    stage = browser.find(".stage")
    browser.actions().move_to_element(stage).click_and_hold().move_by_offset(120, 40).release().perform()
    turned = browser.run(PICTURE.format("material"))
    assert turned != before
    assert browser.run(f"return {PLAYER}.view.turn") == pytest.approx(-0.9 - 0.008 * 120)
    from selenium.webdriver.common.keys import Keys

    browser.run("arguments[0].focus()", stage)
    stage.send_keys("+")
    assert browser.run(PICTURE.format("material")) != turned
    stage.send_keys(Keys.ARROW_LEFT)
    assert browser.run(f"return {PLAYER}.view.turn") == pytest.approx(-0.9 - 0.96 + 0.1)


def test_a_chart_shows_the_time_of_the_player_also_where_a_part_is_enlarged(page: Window):
    page.run(f"{PLAYER}.seek(0.1)")
    place = (
        "const { u, now } = mpmkit.page.charts[0];"
        "return [now.style.display, new DOMMatrix(now.style.transform).e / u.over.clientWidth]"
    )
    assert page.run(place) == ["block", pytest.approx(0.5, abs=0.01)]
    page.run("mpmkit.page.charts[0].u.setScale('x', { min: 0.08, max: 0.16 })")
    page.until("Math.abs(mpmkit.page.charts[0].u.scales.x.min - 0.08) < 1e-9")
    page.run("return new Promise((done) => setTimeout(done, 50))")
    assert page.run(place) == ["block", pytest.approx(0.25, abs=0.01)]
    page.run("mpmkit.page.charts[0].u.setScale('x', { min: 0.12, max: 0.16 })")
    page.run("return new Promise((done) => setTimeout(done, 50))")
    assert page.run(place)[0] == "none"
