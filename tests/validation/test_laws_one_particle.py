"""One particle in a known motion: the stress of the slump test's concrete, against its formula."""

from __future__ import annotations

import numpy as np
import pytest
from bands import close_to

from mpmkit.contracts import Kinematics
from mpmkit.registry import installed

pytestmark = pytest.mark.section(1)

TAU0, K, N = 188.91, 45.65, 1.33
BAND = 1e-6


def concrete(m: float):
    law = installed().of_kind("law")["herschel-bulkley"]
    return law(yield_stress=TAU0, consistency=K, flow_index=N, regularisation=m)


def stress_of(law, velocity_gradient: np.ndarray) -> np.ndarray:
    """Extra stress, ``(n, 3, 3)``, at velocity gradients ``(n, 3, 3)``."""
    n = len(velocity_gradient)
    voigt = np.full((n, 6), np.nan)
    kinematics = Kinematics(velocity_gradient, np.ones(n), np.zeros(n), density=2574.0)
    law.update_stress(kinematics, {}, 1e-3, voigt)
    return voigt[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


def simple_shear(rates, along: int = 0, across: int = 2) -> np.ndarray:
    L = np.zeros((len(rates), 3, 3))
    L[:, along, across] = rates
    return L


def uniaxial(rates, axis: int = 2) -> np.ndarray:
    """Velocity gradients of a compression along one axis at these rates, 1/s, without change of volume."""
    L = np.zeros((len(rates), 3, 3))
    L[:, range(3), range(3)] = np.asarray(rates)[:, None] / 2
    L[:, axis, axis] = -np.asarray(rates)
    return L


@pytest.mark.parametrize(("along", "across"), [(0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1)])
def test_simple_shear(validate, along, across):
    """tau = tau0 + k γ̇^n. With m = 1000 s the regularisation is short of it by tau0 exp(-1000)."""
    rates = np.array([1.0, 5.0, -1.0])
    stress = stress_of(concrete(1000.0), simple_shear(rates, along, across))
    exact = np.sign(rates) * (TAU0 + K * np.abs(rates) ** N)
    assert stress[:, along, across] == pytest.approx(exact, rel=BAND)
    assert stress[:, across, along] == pytest.approx(exact, rel=BAND)
    assert exact[:2] == pytest.approx([234.56, 577.12], abs=0.005)
    for rate, found, formula in zip(rates[:2], stress[:2, along, across], exact[:2], strict=True):
        name = f"Herschel–Bulkley, simple shear at {rate:g} /s"
        validate(name, found, close_to(formula, rel=BAND), unit="Pa")
    rest = stress.copy()
    rest[:, along, across] = rest[:, across, along] = 0
    assert np.all(rest == 0)


@pytest.mark.parametrize("axis", range(3))
def test_slip_squeeze(validate, axis):
    """sigma = √3 (tau0 + k (√3 e)^n): the force on a plate over its area, when its faces slip.

    γ̇ = √3 e, and the difference of the stresses along and across the axis is 3 mu e = √3 mu γ̇. The slowest,
    e = 0.1 /s, has γ̇ = 0.17 /s, and with m = 1000 s an error of exp(-170).
    """
    rates = np.array([0.1, 1.0, 5.0])
    stress = stress_of(concrete(1000.0), uniaxial(rates, axis))
    others = [other for other in range(3) if other != axis]
    for other in others:
        squeeze = stress[:, other, other] - stress[:, axis, axis]
        exact = np.sqrt(3) * (TAU0 + K * (np.sqrt(3) * rates) ** N)
        assert squeeze == pytest.approx([334.88, 491.37, 1723.30], abs=0.005)
        for rate, found, formula in zip(rates, squeeze, exact, strict=True):
            name = f"Herschel–Bulkley, slip squeeze at {rate:g} /s"
            validate(name, found, close_to(formula, rel=BAND), unit="Pa")
    assert np.trace(stress, axis1=1, axis2=2) == pytest.approx(0.0, abs=1e-9)


def test_what_the_regularisation_leaves_out(validate):
    """The regularisation lowers the stress by tau0 exp(-m γ̇): by tau0/e at γ̇ = 1/m, and by less than the
    band for m γ̇ > 14."""
    rate = 1.0
    exact = TAU0 + K * rate**N
    for m in (1.0, 2.0, 5.0, 10.0, 15.0):
        missing = exact - stress_of(concrete(m), simple_shear([rate]))[0, 0, 2]
        lack = close_to(TAU0 * np.exp(-m * rate), rel=BAND)
        validate(f"Herschel–Bulkley, stress that m = {m:g} s leaves out at 1 /s", missing, lack, unit="Pa")
        assert (missing / exact < BAND) == (m > 14)


def test_volume_change_gives_no_extra_stress():
    """The law depends on the deviator alone: expansion in addition to shear does not change the stress."""
    shear = simple_shear(np.array([1.0, 5.0]))
    swelling = shear + 0.7 * np.eye(3)
    law = concrete(1000.0)
    assert stress_of(law, swelling) == pytest.approx(stress_of(law, shear), rel=1e-12, abs=1e-9)
