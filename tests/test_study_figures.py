"""The figures of a study: the base of differences, labels of curves, and distinct styles."""

import numpy as np
import pytest
import xarray
from matplotlib.figure import Figure
from studies import CASE

import mpmkit
from mpmkit.study import chart_figure, figures
from mpmkit.study.chart import Chart, Point
from mpmkit.study.labels import short_names, unit_of
from mpmkit.study.table import table

YIELD, ORDER = "bodies.0.material.yield_stress", "scheme.order"
TIME = np.linspace(0, 1, 21)


@pytest.fixture
def dataset():
    """A grid of 4 × 3 members, of which the first failed at 0.05 s."""
    stresses, orders = ["300", "400", "500", "600"], ["usl", "usf", "musl"]
    dims, shape = (YIELD, ORDER), (4, 3)
    number = np.arange(12.0).reshape(4, 3, 1)
    series = {name: ((*dims, "time"), 1 + number * TIME, {"units": "m"}) for name in figures.SHOWN}
    series["spread_diameter"][1][0, 0, 2:] = np.nan
    fate = np.full(shape, "finished", dtype=object)
    fate[0, 0] = "energy"
    numbers = {
        name: (dims, np.full(shape, 0.2))
        for name in ("t500", "final_spread", "final_slump", "final_height", "particles", "steps")
    }
    numbers |= {
        name: (dims, np.ones(shape))
        for name in ("wall_seconds", "cpu_seconds", "memory_bytes", "simulated_time")
    }
    coordinates = {YIELD: (YIELD, stresses, {"units": "Pa"}), ORDER: (ORDER, orders)}
    return xarray.Dataset(
        series | numbers | {"fate": (dims, fate)},
        coordinates | {"time": ("time", TIME)},
        {"title": "grid"},
    )


def test_differences_are_from_a_member_that_finished(dataset):
    figure = figures._figure(dataset, differences=True)
    assert figure.get_suptitle() == "grid: histories, less those of yield stress 300 Pa, order usf"
    (slump,) = [axes for axes in figure.axes if axes.get_ylabel() == "difference in slump (mm)"]
    ends = {line.get_label(): line.get_ydata()[-1] for line in slump.lines}
    assert ends["yield stress 300 Pa, order musl"] == pytest.approx(1e3)
    assert ends["yield stress 600 Pa, order musl"] == pytest.approx(10e3)
    assert "yield stress 300 Pa, order usf" not in ends


def test_there_are_no_differences_where_none_has_finished(dataset):
    dataset["fate"][:] = "energy"
    assert figures._figure(dataset, differences=True) is None


def test_curves_have_names_with_units_and_can_be_told_apart(dataset):
    figure = figures._figure(dataset, differences=False)
    lines = figure.axes[0].lines
    assert len(lines) == 12
    looks = {(line.get_color(), line._dash_pattern[1] and tuple(line._dash_pattern[1])) for line in lines}
    assert len(looks) == 12
    of_stress = {line.get_label().split(",")[0]: line.get_color() for line in lines}
    assert len(set(of_stress.values())) == 4  # a colour for each yield stress, dashes for the orders
    (legend,) = [axes.get_legend() for axes in figure.axes if axes.get_legend()] or figure.legends
    assert legend.get_texts()[4].get_text() == "yield stress 400 Pa, order usf"


def test_few_members_have_a_colour_each(dataset):
    colours = [colour for colour, _ in figures._styles((2, 4))]
    assert len(set(colours)) == 8


def test_the_table_has_the_slump(dataset):
    heading, _, row, *_ = table(dataset).splitlines()
    assert "| slump, mm |" in heading
    column = heading.split("|").index(" slump, mm ")
    assert row.split("|")[column] == " 200.0 "


@pytest.mark.parametrize("low", [0.1, 0.01, 1e-5])
@pytest.mark.parametrize("span", [1.3, 4.0, 30.0, 1e5])
def test_ticks_of_the_chart_are_numbers_that_differ(low, span, tmp_path, monkeypatch):
    drawn = []
    save = Figure.savefig

    def keep(self, *arguments, **options):
        drawn.append(self)
        save(self, *arguments, **options)

    monkeypatch.setattr(Figure, "savefig", keep)
    points = [Point("a", 1.0, low * span), Point("b", 1.9, low)]
    chart_figure.draw(Chart("height", "wall_seconds", "1", points), "grid", tmp_path / "chart.png")
    axes = drawn[0].axes[0]
    bottom, top = axes.get_ylim()
    axis = axes.yaxis
    shown = [t for t in axis.get_majorticklocs() if bottom <= t <= top]
    texts = [axis.get_major_formatter()(tick, 0) for tick in shown]
    assert len(texts) >= 2
    assert len(set(texts)) == len(texts)
    assert [float(text) for text in texts] == pytest.approx(shown)
    assert not any(axis.get_minor_formatter()(tick, 0) for tick in axis.get_minorticklocs())


def test_dimensions_are_called_by_what_tells_them_apart():
    assert short_names([YIELD, ORDER]) == {YIELD: "yield stress", ORDER: "order"}
    both = ["bodies.0.velocity", "bodies.1.velocity", "scheme.velocity"]
    assert list(short_names(both).values()) == ["0 velocity", "1 velocity", "scheme velocity"]


def test_units_are_those_of_the_case():
    case = mpmkit.parse_case(CASE)
    assert unit_of(case, "bodies.0.material.viscosity") == "Pa s"
    assert unit_of(case, "grid.cell_size") == unit_of(case, "grid.domain.x") == "m"
    assert unit_of(case, "scheme.time_step.fraction") == "1"
    assert unit_of(case, "scheme.order") is None
    assert unit_of(case, "bodies.7.velocity") is None
