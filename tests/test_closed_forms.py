"""The closed forms that docs/comparisons draws beside slumps, against numbers, integrals and limits."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "docs" / "figures" / "comparisons"))
import closed_forms as forms
import thin_film

DENSITY, YIELD = 2574.0, 188.91
WEIGHT = DENSITY * forms.GRAVITY
STRESSES = np.array([1.0, 20.0, 188.91, 1000.0, 2000.0])


def integral(values, over):
    return np.sum((values[1:] + values[:-1]) / 2 * np.diff(over))


@pytest.mark.parametrize(
    ("form", "expected", "to"),
    [
        (forms.slump_of_layers, 0.228, 5e-4),
        (forms.slump_of_roussel, 0.242, 5e-4),
        (forms.spread_stick, 0.470, 5e-4),
        (forms.height_slip, 0.0259, 5e-5),
    ],
)
def test_the_concrete_of_the_slump_case(form, expected, to):
    assert form(YIELD, DENSITY) == pytest.approx(expected, abs=to)


def slump_of_cylinder(stress, density, criterion=forms.TRESCA):
    return forms.slump_of_cylinder(stress, density, forms.HEIGHT, criterion)


@pytest.mark.parametrize("criterion", [forms.TRESCA, forms.MISES])
@pytest.mark.parametrize(("form", "top"), [(forms.slump_of_layers, 0.05), (slump_of_cylinder, 0.1)])
def test_squeezed_layers_against_their_integral(form, top, criterion):
    """Each layer thins to the part yield stress over stress of what it was, if it carries too much."""
    depth = np.linspace(0, forms.HEIGHT, 400_001)[1:]
    radius = top + (0.1 - top) * depth / forms.HEIGHT
    carried = WEIGHT * depth * (top**2 + top * radius + radius**2) / (3 * radius**2) / criterion
    for stress in STRESSES:
        expected = forms.HEIGHT - np.sum(np.minimum(1, stress / carried)) * (depth[1] - depth[0])
        assert form(stress, DENSITY, criterion) == pytest.approx(expected, abs=2e-6)


@pytest.mark.parametrize(("form", "part"), [(forms.slump_of_layers, 7 / 24), (slump_of_cylinder, 1 / 2)])
def test_what_carries_itself_does_not_slump(form, part):
    """The cone's base carries 7/24 of rho g H in shear, the cylinder's a half, after Tresca."""
    at = part * WEIGHT * forms.HEIGHT
    assert form(at, DENSITY) == pytest.approx(0, abs=1e-12)
    assert form(1.5 * at, DENSITY) == pytest.approx(0, abs=1e-12)
    assert form(0.99 * at, DENSITY) > 0


def test_sheets_hold_the_volume_of_the_cone():
    radius = np.linspace(0, forms.spread_stick(YIELD, DENSITY) / 2, 200_001)
    height = np.sqrt(2 * YIELD * (radius[-1] - radius) / WEIGHT)
    assert height[0] == pytest.approx(forms.height_stick(YIELD, DENSITY), rel=1e-12)
    assert integral(2 * np.pi * radius * height, radius) == pytest.approx(forms.VOLUME, rel=1e-6)
    slip = np.pi * forms.spread_slip(YIELD, DENSITY) ** 2 / 4 * forms.height_slip(YIELD, DENSITY)
    assert slip == pytest.approx(forms.VOLUME, rel=1e-12)
    assert pytest.approx(5.4978e-3, rel=1e-5) == forms.VOLUME


def test_time_of_a_sheet_that_thins():
    """Against the balance of forces, integrated; and the limits of no yield stress and of too much."""
    end = forms.VOLUME / (np.pi * 0.25**2)
    height = np.geomspace(forms.HEIGHT, end, 200_001)
    rate = (WEIGHT * height / 2 - np.sqrt(3) * 100.0) / (6 * 50.0)  # e, with mu = 50 Pa s, tau0 = 100 Pa
    expected = integral(-1 / (2 * rate * height), height)
    assert forms.t500_slip(50.0, 100.0, DENSITY) == pytest.approx(expected, rel=1e-6)
    newton = 6 * 50.0 / WEIGHT * (1 / end - 1 / forms.HEIGHT)
    assert forms.t500_slip(50.0, 0.0, DENSITY) == pytest.approx(newton, rel=1e-12)
    assert forms.t500_slip(50.0, 1e-6, DENSITY) == pytest.approx(newton, rel=1e-6)
    assert np.isinf(forms.t500_slip(50.0, 250.0, DENSITY))  # the sheet rests at 34 mm, short of 500 mm


def test_huppert_is_inverted():
    time = float(forms.t500_stick(50.0, DENSITY))
    assert 0.894 * (WEIGHT * forms.VOLUME**3 * time / (3 * 50.0)) ** (1 / 8) == pytest.approx(0.25, rel=1e-12)


def test_the_film_without_a_yield_stress_is_hupperts():
    assert thin_film.t500_film(0.0, DENSITY) == pytest.approx(float(forms.t500_stick(1.0, DENSITY)), rel=0.01)
    assert thin_film.t500_film(50.0, DENSITY) > thin_film.t500_film(20.0, DENSITY) > 0.03


def test_correlations_of_sedran_and_de_larrard():
    """600 mm in 2 s, by hand."""
    viscosity = WEIGHT / 1e4 * (0.026 * 600 - 2.39) * 2.0
    assert forms.t500_of_sedran(viscosity, 0.6, DENSITY) == pytest.approx(2.0, rel=1e-12)
    assert forms.spread_of_sedran(WEIGHT / 11740 * 208, DENSITY) == pytest.approx(0.6, rel=1e-12)
