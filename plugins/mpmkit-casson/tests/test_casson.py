import pytest
from mpmkit_casson import Casson

from mpmkit.testing import law_tests


def flow_curve(rate):
    return (20.0**0.5 + (0.8 * rate) ** 0.5) ** 2


test_casson = law_tests(Casson(yield_stress=20.0, casson_viscosity=0.8), flow_curve=flow_curve)
test_relaxed = law_tests(
    Casson(yield_stress=20.0, casson_viscosity=0.8, form="relaxed"), flow_curve=flow_curve
)


def test_finite_at_rest():
    law = Casson(yield_stress=20.0, casson_viscosity=0.8, regularisation=100.0)
    assert law.largest_viscosity(10.0) == pytest.approx((2000.0**0.5 + 0.8**0.5) ** 2, rel=1e-6)
