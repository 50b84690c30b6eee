"""The chart: errors by their definitions, each kind of reference, Pareto's front, and bad options."""

import numpy as np
import pytest
import xarray
from studies import one_line, status

from mpmkit.errors import CaseError
from mpmkit.study.chart import Chart, Point, chart

TIME = np.linspace(0.0, 1.0, 11)
EXACT = 1.0 + TIME
ERRORS = [0.2, 0.1, 0.05, 0.08, 0.0]
WALL = [1.0, 2.0, 4.0, 8.0, 16.0]
NAMES = ["a", "b", "c", "d", "fine"]


@pytest.fixture
def dataset():
    """Five members that finished, each off by a known part of the largest value, and three that did not."""
    count = len(NAMES)
    names = [*NAMES, "stopped", "broken", "waiting"]
    spread = np.full((len(names), len(TIME)), np.nan)
    spread[:count] = EXACT + 2.0 * np.array(ERRORS)[:, None] * TIME  # of 2 m, at the end
    spread[count, :4] = EXACT[:4]
    pad = [np.nan] * 3
    fate = ["finished"] * count + ["particle-outside", "failed", ""]
    return xarray.Dataset(
        {
            "spread_diameter": (("member", "time"), spread, {"units": "m"}),
            "t500": ("member", [0.6, 0.5, 0.55, np.nan, 0.5, *pad], {"units": "s"}),
            "slump": (("member", "time"), np.full_like(spread, np.nan), {"units": "m"}),
            "wall_seconds": ("member", [*WALL, 0.1, 0.1, np.nan]),
            "cpu_seconds": ("member", [5.0, 4.0, 3.0, 2.0, 1.0, *pad]),
            "particle_steps": ("member", [1.0, 2.0, 3.0, 4.0, 5.0, 100.0, *pad[:2]]),
            "steps": ("member", [1.0, 1.0, 2.0, 2.0, 4.0, *pad]),
            "fate": ("member", np.array(fate, dtype=object)),
            "sentence": ("member", np.array([""] * len(names), dtype=object)),
        },
        {"member": names, "time": ("time", TIME, {"units": "s"})},
        {"title": "synthetic"},
    )


def errors(found):
    return {point.title: point.error for point in found.points}


def test_the_finest_member_is_the_default_reference(dataset):
    found = chart(dataset, "spread_diameter")
    assert found.against == "the finest member, fine"
    assert errors(found) == pytest.approx(dict(zip(NAMES[:4], ERRORS, strict=False)))
    assert [point.title for point in found.front] == ["a", "b", "c"]


def test_the_front_goes_with_the_cost(dataset):
    by_cpu = chart(dataset, "spread_diameter", cost="cpu_seconds")
    assert [point.title for point in by_cpu.front] == ["d", "c"]
    by_steps = chart(dataset, "spread_diameter", cost="steps")
    assert [(point.title, point.cost) for point in by_steps.front] == [("b", 1.0), ("c", 2.0)]


def test_the_front_has_the_points_that_no_other_point_dominates():
    rng = np.random.default_rng(3)
    points = [Point(str(n), *map(float, rng.integers(1, 30, 2))) for n in range(200)]
    front = Chart("x", "steps", "y", points).front

    def beaten(one):
        return any(
            other.cost <= one.cost
            and other.error <= one.error
            and (other.cost, other.error) != (one.cost, one.error)
            for other in points
        )

    expected = sorted({(point.cost, point.error) for point in points if not beaten(point)})
    assert [(point.cost, point.error) for point in front] == expected


def test_a_number_is_compared_with_the_last_value(dataset):
    found = chart(dataset, "spread_diameter", "2.0")
    assert found.against == "2"
    assert errors(found) == pytest.approx(dict(zip(NAMES, ERRORS, strict=True)), abs=1e-12)
    assert [point.title for point in found.front] == ["a", "b", "c", "fine"]


def test_a_figure_is_compared_with_a_number_or_with_that_of_the_finest(dataset):
    assert errors(chart(dataset, "t500", "0.5")) == pytest.approx(
        {"a": 0.2, "b": 0.0, "c": 0.1, "fine": 0.0}, abs=1e-12
    )
    assert errors(chart(dataset, "t500")) == pytest.approx({"a": 0.2, "b": 0.0, "c": 0.1}, abs=1e-12)


def write(path, time, values, column="spread_diameter_m"):
    rows = [f"{t!r},{v!r}" for t, v in zip(map(float, time), map(float, values), strict=True)]
    path.write_text("\n".join(["# what it is", f"time_s,{column}", *rows]) + "\n", encoding="utf-8")
    return str(path)


@pytest.mark.parametrize("rows", [2, 7, 11, 101])
def test_a_file_is_taken_at_its_own_times(dataset, tmp_path, rows):
    """The reference is interpolated linearly between its rows, also if it has as many rows as the dataset."""
    time = np.linspace(0, 1, rows) ** 2
    found = chart(dataset, "spread_diameter", write(tmp_path / "exact.csv", time, 1.0 + time))
    assert found.against == "exact.csv"
    assert errors(found) == pytest.approx(dict(zip(NAMES, ERRORS, strict=True)), abs=1e-12)


def test_a_file_counts_where_both_have_values(dataset, tmp_path):
    """Only the common times count: half of the time, half of the error, and the largest value of that
    half."""
    found = chart(dataset, "spread_diameter", write(tmp_path / "half.csv", [-1, 0.5], [0.0, 1.5]))
    expected = {name: 2 * error * 0.5 / 1.5 for name, error in zip(NAMES, ERRORS, strict=True)}
    assert errors(found) == pytest.approx(expected, abs=1e-12)


BAD = [
    ("time_s,spread_diameter_mm\n0,200\n1,400\n", "it must be a number, 'finest', or a CSV file with the"),
    ("time_s,spread_diameter_m\n0,1\n0,2\n", "time_s, which grows from row to row"),
    ("time_s,spread_diameter_m\n0,1\n1,nan\n", "all of them finite numbers"),
    ("time_s,spread_diameter_m\n0,1\n1\n", "and spread_diameter_m, all of them"),
    ("time_s,spread_diameter_m\n0,1,5\n1,two\n", "a CSV file"),
    ("time_s,spread_diameter_m\n", "a CSV file"),
    ("", "a CSV file"),
]


@pytest.mark.parametrize(("text", "sentence"), BAD)
def test_a_bad_file_is_one_sentence(dataset, tmp_path, text, sentence):
    (tmp_path / "r.csv").write_text(text)
    with pytest.raises(CaseError) as error:
        chart(dataset, "spread_diameter", str(tmp_path / "r.csv"))
    assert sentence in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (
            ["--variable", "sprad"],
            "--variable sprad: the study has no such variable; it has spread_diameter,",
        ),
        (["--variable", "time"], "--variable time: the study has no such variable"),
        (["--variable", "fate"], "--variable fate: the study has no such variable"),
        (["--cost", "money"], "--cost money: it must be one of wall_seconds, cpu_seconds, steps"),
        (["--reference", "gone.csv"], "--reference gone.csv: it cannot be read: No such file"),
        (["--reference", "."], "--reference .: it cannot be read: Is a directory"),
        (["--reference", "nan"], "--reference nan: it must be finite and not 0"),
        (["--reference", "0"], "--reference 0: it must be finite and not 0"),
        (["--variable", "t500", "--reference", "r.csv"], "'t500' is one number per member; it must be"),
        (
            ["--variable", "slump"],
            "no member that finished has a slump to compare with the finest member",
        ),
        (
            ["--reference", "late.csv"],
            "has a spread_diameter to compare with late.csv",
        ),
    ],
)
def test_bad_options_are_status_2(dataset, tmp_path, monkeypatch, capsys, options, sentence):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s").mkdir()
    dataset.to_netcdf(tmp_path / "s" / "results.nc")
    write(tmp_path / "r.csv", [0, 1], [1, 2], "t500_s")
    write(tmp_path / "late.csv", [5, 6], [1, 2])
    assert status("chart", "s", *options) == 2
    assert sentence in one_line(capsys)
    assert not list(tmp_path.glob("**/*.png"))


def test_a_study_without_finished_members_has_no_chart(dataset):
    with pytest.raises(CaseError, match="no member of the study has finished"):
        chart(dataset.isel(member=slice(5, None)), "spread_diameter")


@pytest.mark.parametrize("holds", ["nothing", "text", "another", "half of one"])
def test_a_directory_without_a_study_is_status_2(dataset, tmp_path, monkeypatch, capsys, recwarn, holds):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s").mkdir()
    if holds == "text":
        (tmp_path / "s" / "results.nc").write_text("no NetCDF")
    if holds == "half of one":
        dataset.to_netcdf(tmp_path / "s" / "results.nc")
        whole = (tmp_path / "s" / "results.nc").read_bytes()
        (tmp_path / "s" / "results.nc").write_bytes(whole[: len(whole) // 2])
    if holds == "another":
        xarray.Dataset({"x": ("y", [1.0])}).to_netcdf(tmp_path / "s" / "results.nc")
    assert status("chart", "s") == 2
    assert "'s' must be the directory of a study that was run" in one_line(capsys)
    assert [str(warning.message) for warning in recwarn] == []


def test_the_front_is_printed_and_drawn(dataset, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s").mkdir()
    dataset.to_netcdf(tmp_path / "s" / "results.nc")
    assert status("chart", "s") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines == [
        "| Pareto's front | wall_seconds | error of spread_diameter against the finest member, fine |",
        "|---|---|---|",
        "| a | 1 | 20 % |",
        "| b | 2 | 10 % |",
        "| c | 4 | 5 % |",
        "",
        "of 4 members; picture in s/chart.png",
    ]
    picture = (tmp_path / "s" / "chart.png").read_bytes()
    assert picture.startswith(b"\x89PNG")
    assert len(picture) > 10_000
    assert status("chart", "s", "--reference", "2.0", "--out", "there.png") == 0
    there = tmp_path / "there.png"
    assert there.stat().st_size > 10_000
    there.write_bytes(b"of somebody else")
    capsys.readouterr()
    assert status("chart", "s", "--out", "there.png") == 2
    assert "'there.png' exists: give --overwrite to replace it" in one_line(capsys)
    assert there.read_bytes() == b"of somebody else"
    assert status("chart", "s", "--out", "there.png", "--overwrite") == 0
    assert there.stat().st_size > 10_000
    capsys.readouterr()
    assert status("chart", "s", "--out", "no/where.png") == 4
    assert "cannot write 'no/where.png'" in one_line(capsys)
