import numpy as np
import pytest
from mpmkit_casson import Casson

from mpmkit.contracts import Motion


@pytest.mark.parametrize("rate", [0.5, 5.0, 50.0])
def test_simple_shear_follows_the_flow_curve(rate):
    law = Casson(yield_stress=20.0, casson_viscosity=0.8, regularisation=1e6)
    gradient = np.zeros((1, 3, 3))
    gradient[0, 0, 1] = rate
    stress = np.zeros((1, 6))
    law.update_stress(Motion(gradient, np.ones(1), np.zeros(1), 1000.0), {}, 1e-3, stress)
    assert np.sqrt(stress[0, 5]) == pytest.approx(np.sqrt(20.0) + np.sqrt(0.8 * rate), rel=1e-6)
    assert np.abs(np.delete(stress[0], 5)).max() == 0


def test_finite_at_rest():
    law = Casson(yield_stress=20.0, casson_viscosity=0.8, regularisation=100.0)
    assert law.largest_viscosity(10.0) == pytest.approx((np.sqrt(20.0 * 100.0) + np.sqrt(0.8)) ** 2, rel=1e-6)
