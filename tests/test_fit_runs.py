"""Fits of runs: of a tiny scene by default, and of a slump that other codes computed where there is time."""

from pathlib import Path

import pytest
from fits import VISCOSITY_OF_A_BLOCK as VISCOSITY
from fits import block_of
from studies import Now

import mpmkit
from mpmkit.fitting import load_fit, parse_fit

FITS = Path(__file__).parents[1] / "cases/fits"
REFERENCE = Path(__file__).parent / "validation/reference"
YIELD_STRESS, CONSISTENCY = "bodies.0.material.yield_stress", "bodies.0.material.consistency"


def test_the_viscosity_of_a_block_that_flows_apart():
    found = mpmkit.fit(parse_fit(block_of(300)), executor=Now()).parameters[VISCOSITY]
    assert found.value == pytest.approx(300, rel=0.03)
    assert found.low < 300 < found.high
    assert found.identifiable
    assert found.unit == "Pa s"


@pytest.mark.parametrize("path", sorted(FITS.glob("*.json")), ids=lambda path: path.stem)
def test_a_shipped_fit_is_valid(path):
    from mpmkit.fitting.run_fit import prepared

    fit = load_fit(path)
    assert fit.description
    assert prepared(fit)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["spread_curve", "two_tests"])
def test_the_seeds_concrete_comes_from_the_curves_of_other_codes(name, tmp_path):
    """tau0 188.91 Pa within 3 % and k 45.65 Pa s^n within 10 %, from D(t) by finite elements."""
    result = mpmkit.fit(FITS / f"{name}.json", tmp_path / "out")
    for path, truth, band in ((YIELD_STRESS, 188.91, 0.03), (CONSISTENCY, 45.65, 0.1)):
        found = result.parameters[path]
        assert found.value == pytest.approx(truth, rel=band)
        assert found.low < truth < found.high
        assert found.identifiable


@pytest.mark.slow
def test_from_a_final_spread_alone_the_consistency_is_not_known(tmp_path):
    fit = load_fit(FITS / "final_spread.json")
    both = fit.model_dump(mode="json")
    both["parameters"][CONSISTENCY] = {"low": 5, "high": 500}
    result = mpmkit.fit(both, tmp_path / "out")
    assert not result.parameters[CONSISTENCY].identifiable
    assert any("does not depend on the consistency" in sentence for sentence in result.sentences)
    assert result.parameters[YIELD_STRESS].low < 188.91 < result.parameters[YIELD_STRESS].high
