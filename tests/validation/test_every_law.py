"""Every registered law, one particle: steady shear and squeeze against the flow curve, and what any law owes.

A particle is driven at a constant velocity gradient L, F = exp(L t). Laws that are elastic below yield have
to be sheared until they flow; their steady stress is the flow curve's up to their elastic strain tau/G, which
is 2e-6 here and is added to the band.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from bands import above, below, close_to

from mpmkit.contracts import Motion
from mpmkit.registry import installed

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


class Specimens:
    """Particles of one law, each at its own velocity gradient."""

    def __init__(self, law, gradients) -> None:
        self.law, self.L = law, np.asarray(gradients, dtype=float)
        n = len(self.L)
        self.F, self.voigt = np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 6))
        self.state = {key: np.full((n, *v.shape), v.initial, dtype=float) for key, v in law.state.items()}

    def drive(self, duration: float, steps: int, direction: float = 1.0) -> np.ndarray:
        """Move on, and return the work per initial volume, ``(n,)``, J/m³, by the trapezium rule."""
        dt, L = duration / steps, direction * self.L
        A = dt * L
        step = np.eye(3) + A + A @ A / 2 + A @ A @ A / 6 + A @ A @ A @ A / 24
        power = [self._power(L)]
        for _ in range(steps):
            self.F = step @ self.F
            self.law.update_stress(self._motion(L), self.state, dt, self.voigt)
            power.append(self._power(L))
        return dt * (np.sum(power, axis=0) - (power[0] + power[-1]) / 2)

    def _motion(self, L) -> Motion:
        n, F = len(L), self.F if self.law.needs_deformation_gradient else None
        J = np.linalg.det(self.F)
        return Motion(np.ascontiguousarray(L), J, np.zeros(n), 2574.0, deformation_gradient=F)

    def _power(self, L) -> np.ndarray:
        return np.linalg.det(self.F) * np.einsum("pij,pij->p", self.stress, L)

    @property
    def stress(self) -> np.ndarray:
        return self.voigt[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


def shear(rates) -> np.ndarray:
    L = np.zeros((len(rates), 3, 3))
    L[:, 0, 2] = rates
    return L


def squeeze(rates) -> np.ndarray:
    return np.asarray(rates, dtype=float)[:, None, None] * np.diag([0.5, 0.5, -1.0])


def steady(law, gradients, strain: float = 1e-3) -> np.ndarray:
    """Stress at the end of a strain of this size in each."""
    found = []
    for L in gradients:
        one = Specimens(law, L[None])
        one.drive(strain / np.abs(L).max(), 200)
        found.append(one.stress[0])
    return np.array(found)


def shear_stress(law, rates) -> np.ndarray:
    return steady(law, shear(rates))[:, 0, 2]


def gradients(n: int) -> np.ndarray:
    """Without change of volume, over three decades."""
    rng = np.random.default_rng(0)
    L = rng.standard_normal((n, 3, 3)) * 10 ** rng.uniform(-2, 1, (n, 1, 1))
    return L - np.einsum("pii->p", L)[:, None, None] / 3 * np.eye(3)


@pytest.mark.parametrize("name", [name for name in LAWS if name.removesuffix("-evp") in FLOW_CURVES])
def test_flow_curve(validate, name):
    """Shear first: a law that yields on normal components alone has no stress there."""
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
    """No work out of a closed cycle, the same stress for any observer, and numbers at rest."""
    law = make(name)
    L = gradients(100)
    L /= np.linalg.norm(L, axis=(1, 2), keepdims=True)  # a strain of 0.2 each
    cycle = Specimens(law, L)
    there, back = cycle.drive(0.2, 1000), cycle.drive(0.2, 1000, -1.0)
    gained = float(np.min((there + back) / np.abs(there)))
    validate(
        "Every law: work put into a closed cycle, of that of its first half", gained, above(-1e-3, "≥ 0")
    )

    turned, _ = np.linalg.qr(np.random.default_rng(1).standard_normal((100, 3, 3)))
    R = turned * np.sign(np.linalg.det(turned))[:, None, None]
    one, other = Specimens(law, L), Specimens(law, R @ L @ R.transpose(0, 2, 1))
    one.drive(0.1, 10)
    other.drive(0.1, 10)
    off = np.abs(other.stress - R @ one.stress @ R.transpose(0, 2, 1)).max() / np.abs(one.stress).max()
    validate("Every law: stress seen by a turned observer, relative error", off, below(1e-9, "0"))

    still = Specimens(law, np.zeros((1, 3, 3)))
    still.drive(0.1, 3)
    validate("Every law: stress at zero rate, finite", np.abs(still.stress).max(), below(0.0, "0"), unit="Pa")


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
