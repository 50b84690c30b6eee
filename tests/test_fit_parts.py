"""The parts of a fit, each against known numbers."""

import numpy as np
import pytest
import xarray
from fits import CASE, VISCOSITY, YIELD_STRESS

from mpmkit.case import load_case, parse_case
from mpmkit.errors import CaseError
from mpmkit.fitting import parse_fit
from mpmkit.fitting.coordinates import Coordinates
from mpmkit.fitting.first_guess import yield_stress_of_spread
from mpmkit.fitting.measurements import Measured, end_of, predicted
from mpmkit.fitting.misfit import Misfit
from mpmkit.fitting.model import Parameter
from mpmkit.fitting.profiles import Likelihood, critical, widening
from mpmkit.fitting.quantities import Quantity, crossing
from mpmkit.fitting.run_fit import prepared
from mpmkit.fitting.surrogate import Surrogate


def test_the_time_of_a_level_and_what_a_change_of_lengths_does_to_it():
    time = np.linspace(0, 2, 401)
    # D = 0.2 + 0.3 t reaches 0.5 at 1 s; 1 % more of it all reaches it 0.01 · 0.5/0.3 s earlier.
    assert crossing(time, 0.2 + 0.3 * time, 0.5) == pytest.approx((1.0, 0.5 / 0.3))
    early, _ = crossing(time, 1.01 * (0.2 + 0.3 * time), 0.5)
    assert early == pytest.approx(1.0 - 0.01 * 0.5 / 0.3, rel=2e-4)
    falling, _ = crossing(time, 1 - 0.5 * time, 0.25)
    assert falling == pytest.approx(1.5)


def test_a_level_that_is_never_reached_comes_after_the_end():
    time = np.linspace(0, 2, 401)
    near, far = (crossing(time, np.full(401, level), 0.5)[0] for level in (0.49, 0.40))
    assert 2 < near < far


def test_a_wall_and_a_component_are_picked_by_name():
    torque = xarray.DataArray(
        np.arange(12.0).reshape(3, 2, 2),
        {"time": [0.0, 1.0, 2.0], "wall": ["bob", "cup"], "component": ["y", "t"]},
        ("time", "wall", "component"),
    )
    history = xarray.Dataset({"wall_torque": torque})
    quantity = Quantity("wall_torque", (0.5, 2.0), of=(("component", "t"), ("wall", "cup")))
    value, _ = quantity.of_run({}, history)
    assert value == pytest.approx([5.0, 11.0])


def test_coordinates_are_even_along_the_scale():
    box = Coordinates({"a": Parameter(low=10, high=1000), "b": Parameter(low=-1, high=3, scale="linear")})
    assert box.values(np.array([0.5, 0.5])) == {"a": 100.0, "b": 1.0}
    assert box.coordinate(0, 100) == pytest.approx(0.5)
    step = box.steps(np.array([0.25, 0.75]))
    assert box.value(0, 0.25 + step[0]) == pytest.approx(1.1 * box.value(0, 0.25))
    assert step[1] < 0


def test_an_error_of_the_model_does_not_vanish_over_many_rows():
    """With 400 rows of 1 % the mean is known to 0.05 %; a model that is off by 1 % is still off by 1 %."""
    time = tuple(np.linspace(0, 1, 400))
    rows = np.ones(400)
    one = Measured("here", Quantity("spread_diameter", time), rows, 0.01 * rows)

    def deviation(error):
        whitened = Misfit([one], error * rows).whitened(rows)
        return 1 / np.sqrt(whitened @ whitened)

    assert deviation(0.0) == pytest.approx(0.01 / 20)
    # An error that keeps its sign over half of the curve: the best mean of it has the variance 1/(1 + 1/2T),
    # T = 1/2, of one that keeps it over all.
    assert deviation(0.01) == pytest.approx(0.01 * np.sqrt(1 / 2), rel=0.02)


def test_residuals_are_those_of_the_covariance():
    a = Measured("a", Quantity("final_spread"), np.array([1.0]), np.array([0.3]))
    b = Measured("b", Quantity("t500"), np.array([2.0]), np.array([0.5]))
    misfit = Misfit([a, b], np.array([0.4, 1.2]))
    assert misfit.total == pytest.approx([0.5, 1.3])
    assert misfit.residuals(np.array([2.0, 0.7])) == pytest.approx([2.0, -1.0])


def test_a_cubic_is_found_exactly_and_a_straight_line_is_no_more_than_that():
    random = np.random.default_rng(0)
    u = random.random((20, 2))
    cubic = np.stack([1 + u[:, 0] ** 3 - u[:, 0] * u[:, 1] ** 2, u[:, 1]], axis=1)
    found = Surrogate(u, cubic, cubic, np.ones(20), np.ones(2))
    at = np.array([0.3, 0.7])
    assert found.degree == 3
    assert found(at) == pytest.approx([1 + 0.027 - 0.3 * 0.49, 0.7], abs=1e-9)
    assert found.slopes(at) == pytest.approx(np.array([[0.27 - 0.49, -0.42], [0, 1]]), abs=1e-6)
    noisy = u[:, :1] + 0.05 * random.standard_normal((20, 1))
    straight = Surrogate(u, noisy, noisy, np.ones(20), np.ones(1))
    assert straight.degree == 1
    assert straight.error[0] == pytest.approx(0.05, rel=0.3)


def test_a_power_is_a_straight_line_over_decades():
    """D = 0.6 (100/τ)^0.2, τ from 20 to 1000 Pa: no polynomial of D, but a line of ln D against ln τ."""
    u = np.linspace(0, 1, 6)[:, None]
    spread = 0.6 * (100 / (20 * 50**u)) ** 0.2
    found = Surrogate(u, spread, spread, np.ones(6), np.ones(1))
    assert found.degree == 1
    assert found(np.array([0.47])) == pytest.approx(0.6 * (100 / (20 * 50**0.47)) ** 0.2, rel=1e-9)
    assert found.error[0] < 1e-9


def test_a_bound_counts_only_where_the_surface_violates_it():
    u = np.linspace(0, 1, 7)[:, None]
    exact = 1 - u
    low, high = exact.copy(), exact.copy()
    low[:2], high[:2] = 0.5, np.inf  # at least 0.5, where the line through the others gives 1 and 5/6
    found = Surrogate(u, low, high, np.ones(7), np.ones(1))
    assert found(np.array([0.0])) == pytest.approx([1.0], abs=1e-6)
    low[0] = 1.5  # a bound that the line violates: the surface rises towards it
    raised = Surrogate(u, low, high, np.ones(7), np.ones(1))
    assert raised(np.array([0.0])) > 1.1
    nothing = np.full((7, 1), -np.inf), np.full((7, 1), np.inf)
    known = [np.where(np.arange(7)[:, None] < 3, none, exact) for none in nothing]
    assert Surrogate(u, *known, np.ones(7), np.ones(1))(np.array([0.0])) == pytest.approx([1.0], abs=1e-6)


def test_a_spline_bends_where_the_runs_do():
    """A valley with a kink: a cubic through it is 3/32 too high there, by least squares over the range."""
    random = np.random.default_rng(2)
    u = random.random((40, 2))
    y = (np.abs(u[:, :1] - 0.5) + 0.2 * u[:, 1:]) - 0.5
    found = Surrogate(u, y, y, np.ones(40), np.ones(1))
    assert found.kind.smoothing is not None
    assert found(np.array([0.5, 0.5])) == pytest.approx([-0.4], abs=0.05)


def test_what_a_run_says_that_material_left():
    time = np.linspace(0, 1, 11)
    series = xarray.DataArray(0.2 + 0.5 * time, {"time": time}, ("time",))
    history = xarray.Dataset({"spread_diameter": series, "height": series})
    summary = {"stopped_because": "particle-outside", "t500": 0.6}

    def said(quantity):
        return [bound.tolist() for bound in quantity.of_stopped_run(summary, history)]

    # The last row may hold a particle that was thrown out; the last but one is valid: 0.65 m at 0.9 s.
    least, most = said(Quantity("spread_diameter", (0.5, 2.0)))
    assert least == pytest.approx([0.45, 0.65])
    assert most == pytest.approx([0.45, np.inf])
    assert said(Quantity("final_spread")) == [[pytest.approx(0.65)], [np.inf]]
    assert said(Quantity("t500")) == [[0.6], [0.6]]
    assert said(Quantity("spread_diameter", reaches=0.9)) == [[0.9], [np.inf]]
    assert said(Quantity("final_height")) == [[-np.inf], [np.inf]]
    assert said(Quantity("height", (2.0,))) == [[-np.inf], [np.inf]]


def test_the_profile_of_a_plane_is_that_of_its_covariance():
    """y = (a, a + b): b is known worse than a, and the interval is 1.645 deviations wide to both sides."""
    u = np.random.default_rng(3).random((12, 2))
    y = np.stack([u[:, 0], u.sum(axis=1)], axis=1)
    surrogate = Surrogate(u, y, y, np.ones(12), np.ones(2))
    measured = [
        Measured(name, Quantity(name), np.array([value]), np.array([0.02]))
        for name, value in (("final_spread", 0.5), ("final_height", 1.0))
    ]
    box = Coordinates({"a": Parameter(low=1, high=10), "b": Parameter(low=1, high=10)})
    likelihood = Likelihood(surrogate, Misfit(measured, np.zeros(2)), box)
    best = likelihood.minimum(np.array([0.1, 0.9]))
    assert best == pytest.approx([0.5, 0.5], abs=1e-6)
    for index, deviation in ((0, 0.02), (1, 0.02 * np.sqrt(2))):
        interval = likelihood.interval(index, best, critical(0.9))
        assert interval.high - 0.5 == pytest.approx(1.6449 * deviation, rel=0.01)
        assert 0.5 - interval.low == pytest.approx(1.6449 * deviation, rel=0.01)
        assert not interval.low_open
    # Along the valley of b, a makes up for half: a + b stays.
    assert interval.high_at == pytest.approx([0.5 - 1.6449 * 0.02 / np.sqrt(2), interval.high], abs=1e-3)


def test_critical_values_and_birges_ratio():
    assert critical(0.9) == pytest.approx(2.7055, abs=1e-4)
    assert critical(0.6827) == pytest.approx(1.0, abs=1e-3)
    assert widening(12.0, 10) == 1.0
    assert widening(40.0, 10) == pytest.approx(4.0)


def test_the_closed_forms_of_a_spread_at_rest():
    """The seed's concrete: 0.470 m on a floor that sticks by Roussel and Coussot (targets, section 3)."""
    case = load_case("cases/slump_fast.json", ["grid.faces.z_min=stick"])
    assert yield_stress_of_spread(case, 0.470)[0] == pytest.approx(188.91, rel=0.01)
    case = load_case("cases/slump_fast.json")
    stress, _ = yield_stress_of_spread(case, 0.56)
    thickness = 2 * np.sqrt(3) * stress / (2574 * 9.81)
    assert np.pi * 0.28**2 * thickness == pytest.approx(np.pi * 0.3 * 0.0175 / 3, rel=1e-6)
    plane = CASE | {
        "space": "plane-strain",
        "grid": CASE["grid"] | {"domain": {"x": [-1, 1], "z": [0, 0.32]}},
    }
    assert yield_stress_of_spread(parse_case(plane), 0.5) is None


def test_names_of_the_parameters():
    from mpmkit.fitting.words import Names

    names = Names([YIELD_STRESS, VISCOSITY], parse_case(CASE))
    assert names.label(YIELD_STRESS) == "yield stress (Pa)"
    assert names.said(VISCOSITY, 5, 80) == "between 5 and 80 Pa s"


def test_a_run_without_a_value():
    history = xarray.Dataset({"spread_diameter": ("time", [0.2, 0.3])}, {"time": [0.0, 1.0]})
    rest = Measured("there", Quantity("at_rest_since"), np.ones(1), np.ones(1))
    assert predicted([rest], {"at_rest_since": None}, history, 4.0).value == [4.0]  # it still moved
    flow_time = Measured("there", Quantity("flow_time", own_unit="s"), np.ones(1), np.ones(1))
    with pytest.raises(CaseError, match="there: a run gave no flow time, so that it cannot be fitted"):
        predicted([flow_time], {"flow_time": None}, history, 4.0)


LABORATORY = {
    "tests": {
        "slump flow": {
            "case": "cases/lab/slump_flow.json",
            "measurements": [{"variable": "final_spread", "value": 0.65, "uncertainty": 0.01}],
        },
        "funnel": {
            "case": "cases/lab/v_funnel.json",
            "measurements": [{"variable": "flow_time", "value": 8, "uncertainty": 0.5}],
            "stages": [{}],
        },
    },
    "parameters": {
        "parameters.yield_stress": {"low": 10, "high": 300},
        "parameters.plastic_viscosity": {"low": 5, "high": 100},
    },
}


def test_tests_of_one_material_share_the_parameters_at_the_top_of_their_cases():
    ((_, tests),) = prepared(parse_fit(LABORATORY)).values()
    for test in tests:
        case = (
            test.stages[-1].member({"parameters.yield_stress": 70, "parameters.plastic_viscosity": 30}).case
        )
        law = case.bodies[0].material.constitutive_law
        assert (law.yield_stress, law.plastic_viscosity) == (70, 30)
        assert test.stages[-1].units["parameters.yield_stress"] == "Pa"
    slump, funnel = tests
    coarse, fine = slump.stages[0].case, slump.stages[-1].case
    assert coarse.grid.cell_size > fine.grid.cell_size
    # Other numbers of the case follow from the size of its cells.
    thickness = [case.walls["mould"].surface.thickness / case.grid.cell_size for case in (coarse, fine)]
    assert thickness[0] == pytest.approx(thickness[1])
    (flow_time,) = funnel.measured
    assert flow_time.quantity.unit == "s"
    assert flow_time.quantity.of_run({"flow_time": 7.5}, xarray.Dataset())[0] == pytest.approx([7.5])
    assert funnel.stages[0].case.until.variables.keys() == {"mass_out"}


def test_a_number_deep_in_a_case_with_formulas_can_be_fitted():
    path = "bodies.0.material.yield_stress"
    one = LABORATORY | {"tests": {"slump flow": LABORATORY["tests"]["slump flow"]}}
    ((_, (test,)),) = prepared(parse_fit(one | {"parameters": {path: {"low": 10, "high": 300}}})).values()
    law = test.stages[-1].member({path: 70}).case.bodies[0].material.constitutive_law
    assert law.yield_stress == 70


def test_a_run_ends_with_the_last_row_or_at_rest():
    case = load_case("cases/slump_fast.json")
    curve = Measured("a", Quantity("spread_diameter", (0.1, 1.6)), np.array([0.3, 0.5]), np.ones(2))
    assert end_of(case, [curve]) == {"rest": True, "at_most": 1.6}
    number = Measured("b", Quantity("final_spread"), np.array([0.5]), np.ones(1))
    assert end_of(case, [curve, number]) == {"rest": True, "at_most": 4.0}
    assert end_of(load_case("cases/slump_fast.json", ["until=4"]), [curve]) == 1.6
