"""Fits of a closed form instead of runs: values, intervals, and parameters that cannot be known."""

import json
import re
import shutil

import numpy as np
import pytest
import xarray
from fits import (
    PARAMETERS,
    ROWS,
    VISCOSITY,
    YIELD_STRESS,
    Pretend,
    a_fit,
    bound_of_a_curve,
    curve,
    final_spread,
    t500,
)

import mpmkit
from mpmkit.errors import CaseError, GuardStop
from mpmkit.fitting.model import Budget

FINAL = {"variable": "final_spread", "value": final_spread(150), "uncertainty": 0.005}


@pytest.fixture
def undrawn(monkeypatch):
    """Fits without their figures, which take longer to draw than all else here."""
    monkeypatch.setattr("mpmkit.fitting.figures.draw", lambda result, directory: [])


@pytest.fixture(scope="module")
def of_a_curve(tmp_path_factory):
    """A fit to an exact curve: the fit, its directory, its result, and the runs that were made for it."""
    place, executor = tmp_path_factory.mktemp("fit"), Pretend()
    fit = a_fit([curve(place / "d.csv", 150, 40)])
    return fit, place / "out", mpmkit.fit(fit, place / "out", executor=executor), executor.ran


def test_both_parameters_come_from_a_spread_curve(of_a_curve):
    result = of_a_curve[2]
    found = result.parameters
    assert found[YIELD_STRESS].value == pytest.approx(150, rel=2e-3)
    assert found[VISCOSITY].value == pytest.approx(40, rel=5e-3)
    for path, truth in ((YIELD_STRESS, 150), (VISCOSITY, 40)):
        assert found[path].low < truth < found[path].high
        assert found[path].identifiable
        assert found[path].level == 0.9
    assert found[YIELD_STRESS].unit == "Pa"
    assert result.solution.survey.agrees


def test_the_interval_of_one_number_is_that_of_its_uncertainty():
    fit = a_fit([FINAL], {YIELD_STRESS: PARAMETERS[YIELD_STRESS]})
    found = mpmkit.fit(fit, executor=Pretend()).parameters[YIELD_STRESS]
    # D falls with the fifth root, and 90 % of a normal distribution are 1.645 deviations to both sides.
    for end, way in ((found.low, 1), (found.high, -1)):
        assert final_spread(end) == pytest.approx(final_spread(150) + way * 1.645 * 0.005, abs=2e-5)


def test_the_final_spread_alone_does_not_identify_the_viscosity():
    result = mpmkit.fit(a_fit([FINAL]), executor=Pretend())
    viscosity = result.parameters[VISCOSITY]
    assert not viscosity.identifiable
    assert (viscosity.low, viscosity.high) == pytest.approx((5, 500))
    assert "The final spread does not depend on the plastic viscosity between 5 and 500 Pa s." in (
        result.sentences
    )
    assert result.parameters[YIELD_STRESS].identifiable
    assert result.further[0].parameter == VISCOSITY
    assert result.further[0].left < 0.3
    assert any("most useful further measurement" in sentence for sentence in result.sentences)


def test_both_come_from_the_final_spread_and_t500():
    measured = [FINAL, {"variable": "t500", "value": t500(150, 40), "relative_uncertainty": 0.03}]
    found = mpmkit.fit(a_fit(measured), executor=Pretend()).parameters
    for path, truth in ((YIELD_STRESS, 150), (VISCOSITY, 40)):
        assert found[path].identifiable
        assert found[path].low < truth < found[path].high


@pytest.mark.usefixtures("undrawn")
def test_parameters_at_the_top_of_a_laboratory_case_are_found(tmp_path):
    measured = [FINAL, {"variable": "t500", "value": t500(150, 40), "relative_uncertainty": 0.03}]
    parameters = {f"parameters.{path.split('.')[-1]}": PARAMETERS[path] for path in PARAMETERS}
    fit = a_fit(measured, parameters, changes={"case": "cases/lab/slump_flow.json"})
    result = mpmkit.fit(fit, tmp_path, executor=Pretend())
    for (path, found), truth, unit in zip(result.parameters.items(), (150, 40), ("Pa", "Pa s"), strict=True):
        assert found.value == pytest.approx(truth, rel=0.02)
        assert found.unit == unit
        assert path.startswith("parameters.")
    (curve_found,) = result.curves
    assert curve_found.stress == pytest.approx(150 + 40 * curve_found.rate, rel=0.03)
    page = (tmp_path / "fit.html").read_text(encoding="utf-8")
    assert "yield stress (Pa)" in page


def test_a_prior_is_no_measurement():
    prior = {"value": 60, "deviation": 6}
    result = mpmkit.fit(
        a_fit([FINAL], PARAMETERS | {VISCOSITY: PARAMETERS[VISCOSITY] | {"prior": prior}}),
        executor=Pretend(),
    )
    found = result.parameters[VISCOSITY]
    assert found.value == pytest.approx(60, rel=0.02)
    assert found.high / found.low == pytest.approx(np.exp(2 * 1.645 * 0.1), rel=0.05)
    assert not found.identifiable


def test_the_coarser_model_only_gives_the_start_and_the_model_error(tmp_path):
    stages = {"stages": [{}, {"grid.cell_size": 0.01}], "model_error": None}
    fit = a_fit([curve(tmp_path / "d.csv", 150, 40, noise=0.01)], changes=stages)
    result = mpmkit.fit(fit, executor=Pretend(offset=0.02))
    # Half of 2 % is left at half of the cells, which the two stages tell: an interval has to cover it.
    assert result.solution.errors[0].part == pytest.approx(0.01, rel=0.05)
    for path, truth in ((YIELD_STRESS, 150), (VISCOSITY, 40)):
        assert result.parameters[path].low < truth < result.parameters[path].high
    exact = mpmkit.fit(a_fit([curve(tmp_path / "d.csv", 150, 40, noise=0.01)]), executor=Pretend())
    width = [
        np.log(r.parameters[YIELD_STRESS].high / r.parameters[YIELD_STRESS].low) for r in (result, exact)
    ]
    assert width[0] > 2 * width[1]


@pytest.mark.usefixtures("undrawn")
def test_runs_are_kept_and_reused(of_a_curve, tmp_path):
    fit, out, _, ran = of_a_curve
    assert len(ran) > 5
    again, before = Pretend(), (out / "fit.json").read_bytes()
    shutil.copytree(out, tmp_path / "out")
    mpmkit.fit(fit, tmp_path / "out", executor=again)
    assert not again.ran
    assert (tmp_path / "out/fit.json").read_bytes() == before


@pytest.mark.usefixtures("undrawn")
def test_a_fit_that_was_cut_off_goes_on_to_the_same_result(of_a_curve, tmp_path):
    fit, _, straight, ran = of_a_curve
    first, rest = Pretend(), Pretend()
    cut = mpmkit.fit(fit.model_copy(update={"budget": Budget(runs=8)}), tmp_path / "out", executor=first)
    assert any("budget was used up" in sentence for sentence in cut.sentences)
    assert 6 <= len(first.ran) <= 8
    resumed = mpmkit.fit(fit, tmp_path / "out", executor=rest, overwrite=True)
    assert resumed.parameters == straight.parameters
    assert not [data for data in rest.ran if data in first.ran]
    assert all(data in ran for data in rest.ran)


def test_the_directory_of_a_fit(of_a_curve):
    _, out, _, ran = of_a_curve
    made = {"asked.json", "fit.json", "runs.nc", "fit.html", "members"}
    pictures = {"fitted.png", "misfit.png", "flow_curve.png"}
    assert {path.name for path in out.iterdir()} - {".lock"} == made | pictures
    written = json.loads((out / "fit.json").read_text(encoding="utf-8"))
    entry = written["parameters"][YIELD_STRESS]
    assert {"value", "low", "high", "level", "identifiable"} <= entry.keys()
    assert written["runs"] == len(ran) - 1  # one more tells which shear rates were reached
    with xarray.open_dataset(out / "runs.nc") as runs:
        assert runs.sizes["run"] == written["runs"]
        best = runs.isel(run=int(np.argmin(runs.chi2.values)))
        assert float(best[YIELD_STRESS]) == pytest.approx(150, rel=0.01)
        assert float(best.spread_diameter.isel(time=0)) == pytest.approx(0.2)
    page = (out / "fit.html").read_text(encoding="utf-8")
    assert YIELD_STRESS in page
    assert page.count("data:image/png;base64,") == len(list(out.glob("*.png")))
    links = re.findall(r'<a href="(members/[^"]*)">slump</a>', page)
    assert len(links) == len(set(links)) == written["runs"]
    best = (out / links[0]).read_text(encoding="utf-8")  # those that fit best come first
    assert float(re.match(rf"{YIELD_STRESS} = ([\d.]+)", best)[1]) == pytest.approx(150, rel=0.01)


def test_the_flow_curve_has_the_band_of_its_parameters(of_a_curve):
    (found,) = of_a_curve[2].curves
    parameters = of_a_curve[2].parameters
    assert found.stress == pytest.approx(150 + 40 * found.rate, rel=2e-3)
    # Nine tenths of the rates that the run reached, from 0.01 to 10 /s, evenly in the logarithm.
    assert found.rate[[0, -1]] == pytest.approx([0.01 * 1000**0.05, 0.01 * 1000**0.95], rel=0.02)
    assert found.low[0] == pytest.approx(parameters[YIELD_STRESS].low + 40 * found.rate[0], rel=1e-3)
    assert np.all(found.low < found.stress)
    assert np.all(found.stress < found.high)


@pytest.mark.usefixtures("undrawn")
def test_another_fit_does_not_take_the_place_of_a_result(tmp_path):
    mpmkit.fit(a_fit([FINAL], {YIELD_STRESS: PARAMETERS[YIELD_STRESS]}), tmp_path, executor=Pretend())
    with pytest.raises(CaseError, match="holds the result of another fit"):
        mpmkit.fit(a_fit([FINAL]), tmp_path, executor=Pretend())


HERSCHEL_BULKLEY = {
    "changes": {"bodies.0.material.law": "herschel-bulkley-evp"},
    "parameters": {
        YIELD_STRESS: {"low": 20, "high": 1000},
        "bodies.0.material.consistency": {"low": 5, "high": 500},
        "bodies.0.material.flow_index": {"low": 0.5, "high": 2, "scale": "linear"},
    },
}


def test_of_two_equal_laws_the_simpler_one_is_better(tmp_path):
    measured = [curve(tmp_path / "d.csv", 150, 40, noise=0.01)]
    fit = a_fit(measured, laws={"Herschel-Bulkley": HERSCHEL_BULKLEY})
    result = mpmkit.fit(fit, executor=Pretend())
    bingham, other = result.evidence
    assert (bingham.law, other.law) == ("bingham-evp", "Herschel-Bulkley")
    # In the closed form the flow index only multiplies: a third parameter that explains nothing.
    assert other.chi2 == pytest.approx(bingham.chi2, abs=0.2)
    penalty = (2 * 3 + 24 / 36) - (2 * 2 + 12 / 37)
    assert other.aicc - bingham.aicc == pytest.approx(penalty, abs=0.2)
    assert any("'bingham-evp' describes the measurements better" in said for said in result.sentences)


def test_a_run_that_a_guard_stops_turns_the_search_back(tmp_path):
    start = PARAMETERS | {YIELD_STRESS: PARAMETERS[YIELD_STRESS] | {"start": 60}}
    fit = a_fit([curve(tmp_path / "d.csv", 150, 40)], start)
    result = mpmkit.fit(fit, executor=Pretend(stopped=lambda material: material["yield_stress"] > 400))
    assert result.parameters[YIELD_STRESS].value == pytest.approx(150, rel=5e-3)


def test_a_narrow_domain_does_not_change_the_interval():
    """Runs whose material leaves the domain say that their spread is at least the last one."""
    found, rough = [], FINAL | {"uncertainty": 0.05}
    for widest in (2.0, 0.62):
        executor = Pretend(widest=widest)
        result = mpmkit.fit(a_fit([rough]), executor=executor)
        stresses = [data["bodies"][0]["material"]["yield_stress"] for data in executor.ran]
        assert final_spread(min(stresses)) > 0.62  # at least one run leaves the narrow domain
        found.append(result.parameters[YIELD_STRESS])
        assert "The final spread does not depend on the plastic viscosity between 5 and 500 Pa s." in (
            result.sentences
        )
    wide, narrow = found
    assert (narrow.low, narrow.high) == pytest.approx((wide.low, wide.high), rel=0.02)


def test_a_stop_of_the_first_run_is_reported(tmp_path):
    fit = a_fit([curve(tmp_path / "d.csv", 150, 40)])
    with pytest.raises(GuardStop, match=r"with bodies.0.material.yield_stress = .* it gained energy"):
        mpmkit.fit(fit, executor=Pretend(stopped=lambda material: True))


def test_what_no_run_gives_is_refused():
    narrow = {YIELD_STRESS: {"low": 20, "high": 60}}
    with pytest.raises(CaseError) as refused:
        mpmkit.fit(a_fit([FINAL], narrow), executor=Pretend())
    assert str(refused.value) == (
        "tests.slump.measurements.0.value: no bodies.0.material.yield_stress from 20 to 60 gives a final "
        "spread of 0.5533 m; 0.6645 m is the nearest value, at the bound bodies.0.material.yield_stress = 60"
    )


def test_a_budget_that_does_not_even_begin_is_refused():
    with pytest.raises(CaseError, match="budget: it is too small for the first search"):
        mpmkit.fit(a_fit([FINAL], budget={"runs": 1}), executor=Pretend())


def test_missing_scipy_has_one_sentence(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "scipy", None)
    monkeypatch.setitem(__import__("sys").modules, "scipy.optimize", None)
    with pytest.raises(CaseError, match="needs scipy: pip install scipy"):
        mpmkit.fit(a_fit([FINAL]))


TRUTH = {YIELD_STRESS: 150, VISCOSITY: 40}
EARLY = np.linspace(0.02, 1.0, 80)
"""Times, s, most of which lie in the flow, which tells the viscosity."""


def repeated(folder, time):
    """Relative errors and intervals of fits to a hundred curves with noise of 1 %, by path."""
    curves = ([curve(folder / "d.csv", 150, 40, noise=0.01, seed=seed, time=time)] for seed in range(100))
    found = [mpmkit.fit(a_fit(measured, pages=False), executor=Pretend()).parameters for measured in curves]
    return {path: [one[path] for one in found] for path in TRUTH}


@pytest.fixture(scope="module")
def late(tmp_path_factory):
    return repeated(tmp_path_factory.mktemp("late"), ROWS)


@pytest.fixture(scope="module")
def early(tmp_path_factory):
    return repeated(tmp_path_factory.mktemp("early"), EARLY)


@pytest.mark.slow
@pytest.mark.parametrize("path", TRUTH)
@pytest.mark.parametrize(("rows", "time"), [("late", ROWS), ("early", EARLY)])
def test_intervals_hold_the_truth_as_often_as_they_say_and_are_no_wider_than_they_must(
    rows, time, path, request
):
    found, bound = request.getfixturevalue(rows)[path], bound_of_a_curve(time, 150, 40, 0.01)
    held = sum(one.low < TRUTH[path] < one.high for one in found)
    assert 82 <= held <= 98  # 90 of 100 with a standard deviation of 3
    width = np.median([np.log(one.high / one.low) for one in found])
    assert width == pytest.approx(2 * 1.645 * bound[list(TRUTH).index(path)], rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("path", TRUTH)
@pytest.mark.parametrize(("rows", "time"), [("late", ROWS), ("early", EARLY)])
def test_best_values_scatter_by_the_bound_of_cramer_and_rao(rows, time, path, request):
    """The noise of the curve alone: no unbiased estimate scatters less, and 100 draws tell it to 7 %."""
    errors = [np.log(one.value / TRUTH[path]) for one in request.getfixturevalue(rows)[path]]
    bound = bound_of_a_curve(time, 150, 40, 0.01)[list(TRUTH).index(path)]
    assert 0.8 < np.std(errors) / bound < 1.2
    assert abs(np.mean(errors)) < 0.3 * bound  # 3 standard deviations of a mean of 100


@pytest.mark.slow
@pytest.mark.parametrize(("path", "most"), [(YIELD_STRESS, 0.03), (VISCOSITY, 0.1)])
def test_best_values_are_near_the_truth_if_the_rows_lie_in_the_flow(early, path, most):
    """Targets, section 9. The bound is 0.7 % of the yield stress and 2.4 % of the viscosity."""
    assert max(abs(one.value / TRUTH[path] - 1) for one in early[path]) < most
