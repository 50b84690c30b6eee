"""Every registered law, one particle: steady shear and squeeze against the flow curve, and general
properties.

The particle deforms at a constant velocity gradient L, F = exp(L t). Laws that are elastic below yield must
be sheared until they flow; their steady stress agrees with the flow curve up to their elastic strain tau/G,
which is 2e-6 here and is added to the band.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from bands import above, below, close_to

from mpmkit.registry import installed
from mpmkit.testing.specimens import Specimens, random_gradients, random_rotations, simple_shear

pytestmark = pytest.mark.section(1)

TAU0, K, N, M = 188.91, 45.65, 1.33, 1000.0
BAND = 1e-6
STIFF = 3e8
ELASTIC = 577.13 / STIFF
PARAMETERS = {
    "yield_stress": TAU0,
    "consistency": K,
    "flow_index": N,
    "plastic_viscosity": K,
    "viscosity": K,
    "casson_viscosity": K,
    "regularisation": M,
    "shear_modulus": STIFF,
    "youngs_modulus": 1e4,
    "poisson_ratio": 0.3,
}
"""By the names of a law's fields, so that a law that is registered tomorrow is tested without a word here."""
FLOW_CURVES = {
    "newtonian": lambda rate: K * rate,
    "bingham": lambda rate: TAU0 + K * rate,
    "herschel-bulkley": lambda rate: TAU0 + K * rate**N,
    "casson": lambda rate: (np.sqrt(TAU0) + np.sqrt(K * rate)) ** 2,
}
LAWS = installed().of_kind("law")
YIELDING = [
    pytest.param("", id="regularised"),
    pytest.param("-evp", id="exact"),
]


def make(name: str, **changed):
    law = LAWS[name]
    known = {field: PARAMETERS[field] for field in law.model_fields if field in PARAMETERS} | changed
    unknown = [key for key, field in law.model_fields.items() if field.is_required() and key not in known]
    if unknown:
        pytest.skip(f"no value here for {', '.join(unknown)} of {name}")
    return law(**known)


def squeeze(rates) -> np.ndarray:
    return np.asarray(rates, dtype=float)[:, None, None] * np.diag([0.5, 0.5, -1.0])


def steady(law, gradients, strain: float = 1e-3) -> np.ndarray:
    """Stress at each velocity gradient after a strain of this size, Pa."""
    found = []
    for L in gradients:
        found.append(Specimens(law, 1).drive(L[None], strain / np.abs(L).max(), 200)[0])
    return np.array(found)


def shear_stress(law, rates) -> np.ndarray:
    return steady(law, simple_shear(rates))[:, 0, 2]


@pytest.mark.parametrize("name", [name for name in LAWS if name.removesuffix("-evp") in FLOW_CURVES])
def test_flow_curve(validate, name):
    """Shear and squeeze, since a law that yields on normal components alone has no stress in shear."""
    curve, law = FLOW_CURVES[name.removesuffix("-evp")], make(name)
    band = BAND + (ELASTIC if name.endswith("-evp") else 0.0)
    rates = np.array([1.0, 5.0])
    for rate, found in zip(rates, shear_stress(law, rates), strict=True):
        validate(f"{name}: simple shear at {rate:g} /s", found, close_to(curve(rate), rel=band), unit="Pa")
    rates = np.array([0.1, 1.0, 5.0])
    for rate, stress in zip(rates, steady(law, squeeze(rates)), strict=True):
        exact = np.sqrt(3) * curve(np.sqrt(3) * rate)
        found = stress[0, 0] - stress[2, 2]
        validate(f"{name}: slip squeeze at {rate:g} /s", found, close_to(exact, rel=band), unit="Pa")


@pytest.mark.parametrize("name", LAWS)
def test_what_any_law_owes(validate, name):
    """A closed cycle gives no work, the stress is the same for every observer, and it is finite at rest."""
    law = make(name)
    L = random_gradients(100, isochoric=True)
    L /= np.linalg.norm(L, axis=(1, 2), keepdims=True)  # a strain of 0.2 each
    cycle = Specimens(law, 100)
    cycle.drive(L, 0.2, 1000)
    there = cycle.work.copy()
    cycle.drive(-L, 0.2, 1000)
    gained = float(np.min(cycle.work / np.abs(there)))
    validate(
        "Every law: work put into a closed cycle, of that of its first half", gained, above(-1e-3, "≥ 0")
    )

    R = random_rotations(100)
    Rt = R.transpose(0, 2, 1)
    one, other = Specimens(law, 100).drive(L, 0.1, 10), Specimens(law, 100).drive(R @ L @ Rt, 0.1, 10)
    off = np.abs(other - R @ one @ Rt).max() / np.abs(one).max()
    validate("Every law: stress seen by a turned observer, relative error", off, below(1e-9, "0"))

    still = np.abs(Specimens(law, 1).rest(0.1, 3)).max()
    validate("Every law: stress at zero rate, finite", still, below(0.0, "0"), unit="Pa")


@pytest.mark.parametrize("kind", YIELDING)
def test_limits_of_herschel_bulkley(validate, kind):
    """n = 1 is Bingham, tau0 = 0 the power law."""
    rates, name = np.array([0.1, 1.0, 5.0]), "herschel-bulkley" + kind
    off = shear_stress(make(name, flow_index=1.0), rates) / shear_stress(make("bingham" + kind), rates) - 1
    validate(f"{name}, n = 1, is Bingham: relative difference", np.abs(off).max(), below(BAND, "0"))
    for n in (0.5, 1.33):
        found = shear_stress(make(name, yield_stress=0.0, flow_index=n), rates)
        off = np.abs(found / (K * rates**n) - 1).max()
        band = BAND + (ELASTIC if kind else 0.0)
        validate(f"{name}, tau0 = 0, n = {n:g}, is the power law: relative difference", off, below(band, "0"))


@pytest.mark.parametrize("name", ["bingham", "herschel-bulkley"])
def test_regularised_tends_to_exact(validate, name):
    """At γ̇ = 0.5 /s the difference is tau0 exp(-m γ̇): it falls as m grows, to nothing."""
    rate = np.array([0.5])
    exact = shear_stress(make(f"{name}-evp"), rate)[0]
    lacks = [
        exact - shear_stress(make(name, regularisation=m), rate)[0] for m in (2.0, 4.0, 8.0, 16.0, 100.0)
    ]
    assert all(later < earlier for earlier, later in pairwise(lacks))
    row = f"{name}, regularised, m = 16 s: short of the exact law at 0.5 /s"
    validate(row, lacks[3], close_to(TAU0 * np.exp(-8.0), rel=0.02), unit="Pa")
    row = f"{name}, regularised, m = 100 s: off the exact law, relative"
    validate(row, abs(lacks[4] / exact), below(BAND + ELASTIC, "0"))
