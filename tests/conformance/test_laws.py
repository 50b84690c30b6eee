"""Requirements on every registered law, and further ones on the built-in laws.

Every law passes the conformance kit for third parties. Its parameters come from a table, by the names of its
fields. For a name that is not in the table, the default is used, or a value within its constraints. So a new
law is tested without a change here; it needs a line in ``PARAMETERS`` only if its parameters have new names.
"""

from __future__ import annotations

from functools import partial
from typing import Any, Literal, get_args, get_origin

import numpy as np
import pytest

from mpmkit.contracts import REST_SHEAR_RATE, ConstitutiveLaw, ElastoviscoplasticLaw
from mpmkit.registry import installed
from mpmkit.testing import Check, elastic, law_checks
from mpmkit.testing.law_subject import LawSubject
from mpmkit.testing.specimens import DENSITY, random_gradients, random_rotations, simple_shear

PARAMETERS = {
    "yield_stress": 188.91,
    "consistency": 45.65,
    "flow_index": 1.33,
    "plastic_viscosity": 45.65,
    "viscosity": 45.65,
    "regularisation": 1000.0,
    "youngs_modulus": 1e4,
    "poisson_ratio": 0.3,
    "shear_modulus": 1e5,
    "bulk_modulus": 2e4,
}
SWEPT = {"flow_index": [0.5, 1.0, 1.33], "form": ["explicit", "relaxed"]}
"""Fields that are tried with several values."""

LAWS = installed().of_kind("law")


# --- Making laws ------------------------------------------------------------------------------------------


def some_value(name: str, field: Any) -> Any:
    """A value that a parameter may have."""
    if name in PARAMETERS:
        return PARAMETERS[name]
    if not field.is_required():
        return field.get_default(call_default_factory=True)
    if get_origin(field.annotation) is Literal:
        return get_args(field.annotation)[0]
    limits = {
        key: getattr(m, key) for m in field.metadata for key in ("ge", "gt", "le", "lt") if hasattr(m, key)
    }
    low = limits.get("ge", limits.get("gt"))
    high = limits.get("le", limits.get("lt"))
    if low is not None and high is not None:
        value = (low + high) / 2
    elif high is not None:
        value = high - 1.0
    else:
        value = 1.0 if low is None else low + 1.0
    return int(value) if field.annotation is int else float(value)


def make(law: type[ConstitutiveLaw], **chosen: Any) -> ConstitutiveLaw:
    values = {name: some_value(name, field) for name, field in law.model_fields.items()}
    return law(**values | chosen)


def variants() -> list:
    found = []
    for name, law in LAWS.items():
        swept = [field for field in SWEPT if field in law.model_fields]
        if not swept:
            found.append(pytest.param(make(law), id=name))
        for field in swept:
            found += [pytest.param(make(law, **{field: v}), id=f"{name}-{field}={v}") for v in SWEPT[field]]
    return found


CURVES = {
    "newtonian": lambda law, rate: law.viscosity * rate,
    "bingham": lambda law, rate: law.yield_stress + law.plastic_viscosity * rate,
    "herschel-bulkley": lambda law, rate: law.yield_stress + law.consistency * rate**law.flow_index,
}
"""Flow curves written again here, by the name of the law; other laws are compared with their own."""


def checks_of(law: ConstitutiveLaw) -> list[Check]:
    curve = CURVES.get(law.name.removesuffix("-evp"))
    return law_checks(law, flow_curve=None if curve is None else partial(curve, law))


EVERY = variants()
FLUIDS = [p for p in EVERY if getattr(p.values[0], "form", None) == "explicit"]
every_law = pytest.mark.parametrize("law", EVERY)
every_fluid = pytest.mark.parametrize("law", FLUIDS)


@pytest.mark.parametrize(
    "check",
    [pytest.param(check, id=f"{p.id}: {check.name}") for p in EVERY for check in checks_of(p.values[0])],
)
def test_conformance(check):
    check()


@every_law
def test_laws_that_relax_say_how_fast(law):
    relaxes = isinstance(law, ElastoviscoplasticLaw) or getattr(law, "form", None) == "relaxed"
    assert bool(law.remarks(DENSITY, LawSubject(law).given_sound_speed)) == relaxes


# --- Generalised Newtonian fluids -------------------------------------------------------------------------


@every_fluid
def test_dissipation_of_a_fluid(law):
    """sigma':D = mu γ̇² > 0 at every instant."""
    L = random_gradients(1000)
    stress = LawSubject(law).respond(L, 1e-3, 1)
    assert np.all(np.einsum("pij,pij->p", stress, L) > 0)
    assert np.trace(stress, axis1=1, axis2=2) == pytest.approx(0.0, abs=1e-9 * np.abs(stress).max())


def shear_stress(law, rates) -> np.ndarray:
    return LawSubject(law).respond(simple_shear(np.asarray(rates, dtype=float)), 1e-3, 1)[:, 0, 2]


RATES = np.geomspace(1e-5, 1e3, 60)


def test_herschel_bulkley_with_index_1_is_bingham():
    hb = make(LAWS["herschel-bulkley"], flow_index=1.0)
    bingham = make(LAWS["bingham"], plastic_viscosity=hb.consistency)
    assert shear_stress(hb, RATES) == pytest.approx(shear_stress(bingham, RATES), rel=1e-12)


@pytest.mark.parametrize("n", [0.5, 1.0, 1.33])
def test_herschel_bulkley_without_yield_stress_is_the_power_law(n):
    """tau = k γ̇^n; a thinning one is followed down to γ̇ = 1/m, below which its viscosity has a bound."""
    law = make(LAWS["herschel-bulkley"], yield_stress=0.0, flow_index=n, regularisation=1e6)
    rates = RATES[RATES > 1e-6]
    assert shear_stress(law, rates) == pytest.approx(law.consistency * rates**n, rel=1e-12)
    assert law.largest_viscosity(1.0) == pytest.approx(law.consistency * 1e6 ** max(1 - n, 0), rel=1e-2)


def test_bingham_without_yield_stress_is_newtonian():
    bingham, newtonian = make(LAWS["bingham"], yield_stress=0.0), make(LAWS["newtonian"])
    assert shear_stress(bingham, RATES) == pytest.approx(shear_stress(newtonian, RATES), rel=1e-12)


@pytest.mark.parametrize("name", ["bingham", "herschel-bulkley"])
def test_regularised_law_tends_to_the_exact_one(name):
    """The difference from the exact law is tau0 exp(-m γ̇)."""
    tau0, flowing = 188.91, make(LAWS[name], yield_stress=0.0)
    for m in (2.0, 4.0, 8.0, 16.0):
        law = make(LAWS[name], yield_stress=tau0, regularisation=m)
        for rate in (0.25, 0.5, 1.0):
            lacks = tau0 + shear_stress(flowing, [rate])[0] - shear_stress(law, [rate])[0]
            assert lacks == pytest.approx(tau0 * np.exp(-m * rate), rel=1e-6)


@pytest.mark.parametrize("name", ["bingham", "herschel-bulkley"])
def test_yield_viscosity_at_rest(name):
    """tau0 m, the one that limits the step."""
    law = make(LAWS[name])
    at_rest = law.apparent_viscosity(np.array([REST_SHEAR_RATE]))[0]
    own = make(LAWS[name], yield_stress=0.0).apparent_viscosity(np.array([REST_SHEAR_RATE]))[0]
    assert at_rest - own == pytest.approx(law.yield_stress * law.regularisation, rel=1e-6)


# --- Neo-Hooke's solid --------------------------------------------------------------------------------------


def test_neo_hookean_is_isotropic():
    """F R, a body turned before it is deformed, has the stress of F."""
    subject = LawSubject(make(LAWS["neo-hookean"]))
    F, R = elastic.deformations(100, 0.25), random_rotations(100)
    sigma = elastic.stress(subject, F)
    np.testing.assert_allclose(elastic.stress(subject, F @ R), sigma, rtol=0, atol=1e-9 * np.abs(sigma).max())


def test_neo_hookean_is_hooke_at_small_strain():
    """sigma = 2 G ε + lambda tr(ε) I, with an error of the order of the strain."""
    law = make(LAWS["neo-hookean"])
    E, nu = law.youngs_modulus, law.poisson_ratio
    G, lame = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    errors = []
    for size in (1e-3, 1e-4):
        F = elastic.deformations(50, size)
        strain = (F + F.transpose(0, 2, 1)) / 2 - np.eye(3)
        hooke = 2 * G * strain + lame * np.einsum("pii->p", strain)[:, None, None] * np.eye(3)
        errors.append(np.abs(elastic.stress(LawSubject(law), F) - hooke).max() / np.abs(hooke).max())
    assert errors[0] < 1e-2
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.1)


def test_neo_hookean_bar_has_youngs_modulus():
    """Under a small uniaxial strain with free sides, the stress is E times the strain, and the lateral strain
    -nu times it."""
    law, e = make(LAWS["neo-hookean"]), 1e-6
    F = np.diag([1 + e, 1 - law.poisson_ratio * e, 1 - law.poisson_ratio * e])[None]
    sigma = elastic.stress(LawSubject(law), F)[0]
    assert sigma[0, 0] == pytest.approx(law.youngs_modulus * e, rel=1e-5)
    assert sigma[1, 1] == pytest.approx(0.0, abs=1e-5 * sigma[0, 0])
    fastest = law.wave_speed(1000.0, None)
    assert fastest**2 * 1000.0 == pytest.approx(
        law.youngs_modulus * (1 - 0.3) / ((1 + 0.3) * (1 - 0.6)), rel=1e-9
    )
