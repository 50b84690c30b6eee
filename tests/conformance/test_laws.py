"""What every registered law must do, and what the built-in ones must do besides.

A law is driven through its contract alone. Its parameters come from a table by the names of its fields; for
a name that is not there, its default, or some value that its constraints allow. So a law that is registered
tomorrow is tested without a word here, and gets a line in ``PARAMETERS`` if its names are its own.
"""

from __future__ import annotations

from typing import Any, Literal, get_args, get_origin

import numba
import numpy as np
import pytest

from mpmkit.contracts import REST_SHEAR_RATE, ConstitutiveLaw, ElastoviscoplasticLaw, Motion
from mpmkit.registry import installed

DENSITY, SOUND_SPEED = 2574.0, 20.0
PARAMETERS = {
    "yield_stress": 188.91,
    "consistency": 45.65,
    "flow_index": 1.33,
    "plastic_viscosity": 45.65,
    "viscosity": 45.65,
    "regularisation": 1000.0,
    "youngs_modulus": 1e4,
    "poisson_ratio": 0.3,
    "shear_modulus": 1e4,
    "bulk_modulus": 2e4,
}
SWEPT = {"flow_index": [0.5, 1.0, 1.33], "form": ["explicit", "relaxed"]}
"""Fields that are tried with several values."""

LAWS = installed().of_kind("law")


@pytest.fixture(autouse=True)
def _one_thread():
    numba.set_num_threads(1)


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


def remembers(law: ConstitutiveLaw) -> bool:
    """Whether the stress depends on the last one."""
    return isinstance(law, ElastoviscoplasticLaw) or getattr(law, "form", None) == "relaxed"


def is_hyperelastic(law: ConstitutiveLaw) -> bool:
    """Whether its whole stress is a function of F."""
    return law.needs_deformation_gradient and not law.state and not law.uses_equation_of_state


EVERY = variants()
FLUIDS = [p for p in EVERY if getattr(p.values[0], "form", None) == "explicit"]
HYPERELASTIC = [p for p in EVERY if is_hyperelastic(p.values[0])]
every_law = pytest.mark.parametrize("law", EVERY)
every_fluid = pytest.mark.parametrize("law", FLUIDS)
every_elastic_law = pytest.mark.parametrize("law", HYPERELASTIC)


# --- Driving laws -----------------------------------------------------------------------------------------


class Specimens:
    """Particles of one law, each in a homogeneous motion of its own."""

    def __init__(self, law: ConstitutiveLaw, n: int) -> None:
        self.law = law
        self.F = np.tile(np.eye(3), (n, 1, 1))
        self.voigt = np.zeros((n, 6))
        self.state = {
            name: np.full((n, *variable.shape), variable.initial, dtype=float)
            for name, variable in law.state.items()
        }
        self.work = np.zeros(n)

    def motion(self, L: np.ndarray) -> Motion:
        F = self.F if self.law.needs_deformation_gradient else None
        J = np.linalg.det(self.F)
        return Motion(np.ascontiguousarray(L), J, np.zeros(len(L)), DENSITY, F, SOUND_SPEED)

    def drive(self, L: np.ndarray, duration: float, steps: int) -> np.ndarray:
        """Move at these velocity gradients ``(n, 3, 3)`` and return the stress at the end, ``(n, 3, 3)``."""
        dt = duration / steps
        A = dt * L
        increment = np.eye(3) + A + A @ A / 2 + A @ A @ A / 6 + A @ A @ A @ A / 24  # exp(dt L)
        before = self.power(L)
        for _ in range(steps):
            self.F = increment @ self.F
            self.law.update_stress(self.motion(L), self.state, dt, self.voigt)
            now = self.power(L)
            self.work += dt * (before + now) / 2
            before = now
        return self.stress

    def power(self, L: np.ndarray) -> np.ndarray:
        """Power of the stress per initial volume, J sigma:L, W/m³."""
        return np.linalg.det(self.F) * np.einsum("pij,pij->p", self.stress, L)

    @property
    def stress(self) -> np.ndarray:
        return self.voigt[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


def respond(law: ConstitutiveLaw, L: np.ndarray, duration: float = 0.1, steps: int = 10) -> np.ndarray:
    return Specimens(law, len(L)).drive(L, duration, steps)


def random_gradients(n: int, seed: int = 0, isochoric: bool = False) -> np.ndarray:
    """Velocity gradients, 1/s, over four decades of magnitude."""
    rng = np.random.default_rng(seed)
    L = rng.standard_normal((n, 3, 3)) * 10 ** rng.uniform(-3, 1, (n, 1, 1))
    if isochoric:
        L -= np.einsum("pii->p", L)[:, None, None] / 3 * np.eye(3)
    return L


def random_rotations(n: int, seed: int = 1) -> np.ndarray:
    Q, upper = np.linalg.qr(np.random.default_rng(seed).standard_normal((n, 3, 3)))
    Q = Q * np.sign(np.einsum("pii->pi", upper))[:, None, :]
    Q[:, :, 0] *= np.linalg.det(Q)[:, None]
    return Q


def simple_shear(rates: np.ndarray, along: int, across: int) -> np.ndarray:
    L = np.zeros((len(rates), 3, 3))
    L[:, along, across] = rates
    return L


def close(actual: np.ndarray, expected: np.ndarray, rel: float = 1e-9) -> bool:
    """Relative to the largest component of each tensor."""
    scale = np.abs(expected).max(axis=(1, 2), keepdims=True)
    return bool(np.all(np.abs(actual - expected) <= rel * scale + 1e-12))


# --- Every law --------------------------------------------------------------------------------------------


def test_there_are_laws():
    assert EVERY
    assert FLUIDS
    assert HYPERELASTIC


@every_law
@pytest.mark.parametrize(("along", "across"), [(0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1)])
def test_simple_shear_gives_a_shear_stress(law, along, across):
    """Against the motion, symmetric, no less at a higher rate. Yield on normal components gives none."""
    rates = np.array([0.1, 1.0, 5.0])
    stress = respond(law, simple_shear(rates, along, across))
    shear = stress[:, along, across]
    assert np.all(shear > 0)
    assert np.all(np.diff(shear) >= 0)
    assert np.array_equal(shear, stress[:, across, along])
    back = respond(law, simple_shear(-rates, along, across))
    assert back[:, along, across] == pytest.approx(-shear, rel=1e-9)


@every_law
def test_work_is_stored_or_dissipated_never_gained(law):
    """∫ J sigma:D dt ≥ the strain energy, zero for a viscous fluid, whose stress does work at every rate.

    The spring of a law that relaxes is that of a nearly incompressible material, and is tried without change
    of volume.
    """
    isochoric = remembers(law)
    L = random_gradients(200, isochoric=isochoric)
    L *= np.minimum(1.0, 2.0 / np.linalg.norm(L, axis=(1, 2)))[:, None, None]
    specimens, peak = Specimens(law, len(L)), np.zeros(len(L))
    for part in (L, -L, random_gradients(200, 5, isochoric) * 0.05):
        specimens.drive(part, 0.2, 200)
        peak = np.maximum(peak, np.abs(specimens.work))
        stored = np.broadcast_to(
            law.strain_energy(specimens.motion(part), specimens.state, specimens.voigt), len(L)
        )
        slack = 1e-4 * peak + 1e-12  # of the quadrature over time, and of rounding
        assert np.all(stored >= -slack)
        assert np.all(specimens.work >= stored - slack)


@every_law
def test_objective_under_rotation(law):
    """R L Rᵀ, and with it F → R F Rᵀ, gives R sigma Rᵀ."""
    L, R = random_gradients(200), random_rotations(200)
    turned = R @ L @ R.transpose(0, 2, 1)
    stress = respond(law, L)
    assert np.abs(stress).max() > 0
    assert close(respond(law, turned), R @ stress @ R.transpose(0, 2, 1))


@every_law
def test_spin_alone_gives_no_stress(law):
    """A turn by up to 1 rad; what a finite step makes of it shrinks with the step for an elastic law."""
    W = random_gradients(100)
    W = W - W.transpose(0, 2, 1)
    W /= np.linalg.norm(W, axis=(1, 2), keepdims=True)
    scale = np.abs(respond(law, simple_shear(np.array([1.0]), 0, 2))).max()
    assert np.abs(respond(law, W, 1.0, 100)).max() < 1e-6 * scale


@every_law
def test_at_rest_it_is_finite_and_free_of_stress(law):
    specimens = Specimens(law, 3)
    if not remembers(law):
        specimens.voigt[:] = np.nan
    still = np.zeros((3, 3, 3))
    assert np.all(specimens.drive(still, 0.1, 3) == 0)
    energy = law.strain_energy(specimens.motion(still), specimens.state, specimens.voigt)
    assert np.all(np.isfinite(energy))


@every_law
def test_finite_at_extreme_rates(law):
    rates = np.array([1e-300, 1e-30, REST_SHEAR_RATE, 1e-6, 1.0, 1e3, 1e6])
    stress = np.abs(respond(law, simple_shear(rates, 0, 2), 1e-6, 1))[:, 0, 2]
    assert np.all(np.isfinite(stress))
    assert np.all(np.diff(stress) >= 0)


@every_law
def test_particles_do_not_know_each_other(law):
    """In another order, or alone, each gets the same stress to the bit."""
    L = random_gradients(300)  # more than one chunk of the kernels
    order = np.random.default_rng(2).permutation(300)
    stress = respond(law, L)
    assert np.array_equal(respond(law, L[order]), stress[order])
    for one in (0, 7, 299):
        assert np.array_equal(respond(law, L[one : one + 1])[0], stress[one])


@every_law
def test_extra_stress_leaves_the_pressure_to_the_equation_of_state(law):
    """Swelling gives no extra stress; a law without an equation of state resists it by itself."""
    swelling = np.tile(0.1 * np.eye(3), (1, 1, 1))
    stress = respond(law, swelling)[0]
    if law.uses_equation_of_state:
        assert np.trace(stress) == pytest.approx(0.0, abs=1e-6)
    else:
        assert np.trace(stress) > 0


@every_law
def test_wave_speed(law):
    """Positive, and at least the sound speed of the equation of state where there is one."""
    given = SOUND_SPEED if law.uses_equation_of_state else None
    speed = law.wave_speed(DENSITY, given)
    assert np.isfinite(speed)
    assert speed > 0
    if given is not None:
        assert speed >= given


@every_law
def test_remarks_are_sentences_that_name_the_law(law):
    remarks = law.remarks(DENSITY, SOUND_SPEED if law.uses_equation_of_state else None)
    assert all(law.name in sentence and "nan" not in sentence for sentence in remarks)
    assert bool(remarks) == remembers(law)


@every_law
def test_case_file_form_round_trips(law):
    assert type(law).model_validate(law.model_dump()) == law


# --- Generalised Newtonian fluids -------------------------------------------------------------------------


@every_fluid
def test_dissipation_of_a_fluid(law):
    """sigma':D = mu γ̇² > 0 at every instant."""
    L = random_gradients(1000)
    stress = respond(law, L, 1e-3, 1)
    assert np.all(np.einsum("pij,pij->p", stress, L) > 0)
    assert np.trace(stress, axis1=1, axis2=2) == pytest.approx(0.0, abs=1e-9 * np.abs(stress).max())


@every_fluid
def test_largest_viscosity_bounds_the_apparent_one(law):
    """The law is sampled, so that a maximum between two samples may be higher by a thousandth."""
    for fastest in (1e-3, 1.0, 37.0, 1e4):
        rates = np.geomspace(REST_SHEAR_RATE, max(fastest, 1.0), 5000)
        bound = law.largest_viscosity(fastest)
        assert np.isfinite(bound)
        assert np.all(law.apparent_viscosity(rates) <= bound * (1 + 1e-3))


def shear_stress(law, rates) -> np.ndarray:
    return respond(law, simple_shear(np.asarray(rates, dtype=float), 0, 2), 1e-3, 1)[:, 0, 2]


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
    """What it lacks of tau0 is tau0 exp(-m γ̇): it shrinks exponentially with m, and with γ̇."""
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


# --- Elastic laws -----------------------------------------------------------------------------------------


def deformations(n: int, size: float, seed: int = 3) -> np.ndarray:
    return np.eye(3) + size * np.random.default_rng(seed).uniform(-1, 1, (n, 3, 3))


def elastic_motion(F: np.ndarray) -> Motion:
    F = np.ascontiguousarray(F)
    return Motion(np.zeros_like(F), np.linalg.det(F), np.zeros(len(F)), DENSITY, F)


def elastic_energy(law, F: np.ndarray) -> np.ndarray:
    return law.strain_energy(elastic_motion(F), {}, np.full((len(F), 6), np.nan))


def elastic_stress(law, F: np.ndarray) -> np.ndarray:
    voigt = np.full((len(F), 6), np.nan)
    law.update_stress(elastic_motion(F), {}, 1e-3, voigt)
    return voigt[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


@every_elastic_law
def test_stress_is_the_derivative_of_the_strain_energy(law):
    """sigma = 1/J dW/dF Fᵀ, by central differences."""
    F, h = deformations(50, 0.25), 1e-5
    P = np.empty_like(F)
    for i in range(3):
        for j in range(3):
            step = np.zeros((3, 3))
            step[i, j] = h
            above, below = (elastic_energy(law, F + s * step) for s in (1, -1))
            P[:, i, j] = (above - below) / (2 * h)
    sigma = P @ F.transpose(0, 2, 1) / np.linalg.det(F)[:, None, None]
    assert close(elastic_stress(law, F), sigma, rel=1e-6)


@every_elastic_law
def test_undeformed_and_turned_bodies_hold_no_stress(law):
    R = random_rotations(50)
    assert np.abs(elastic_stress(law, R)).max() < 1e-9
    assert elastic_energy(law, R) == pytest.approx(0.0, abs=1e-9)


@every_elastic_law
def test_frame_indifference_of_a_deformed_body(law):
    """R F gives R sigma Rᵀ and the same energy; F R, an isotropic body turned before, changes nothing."""
    F, R = deformations(100, 0.25), random_rotations(100)
    sigma, turned = elastic_stress(law, F), R.transpose(0, 2, 1)
    assert close(elastic_stress(law, R @ F), R @ sigma @ turned)
    assert close(elastic_stress(law, F @ R), sigma)
    energy = elastic_energy(law, F)
    assert elastic_energy(law, R @ F) == pytest.approx(energy, rel=1e-9)


def test_neo_hookean_is_hooke_at_small_strain():
    """sigma = 2 G ε + lambda tr(ε) I, with an error of the order of the strain."""
    law = make(LAWS["neo-hookean"])
    E, nu = law.youngs_modulus, law.poisson_ratio
    G, lame = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    errors = []
    for size in (1e-3, 1e-4):
        F = deformations(50, size)
        strain = (F + F.transpose(0, 2, 1)) / 2 - np.eye(3)
        hooke = 2 * G * strain + lame * np.einsum("pii->p", strain)[:, None, None] * np.eye(3)
        errors.append(np.abs(elastic_stress(law, F) - hooke).max() / np.abs(hooke).max())
    assert errors[0] < 1e-2
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.1)


def test_neo_hookean_bar_has_youngs_modulus():
    """Stretched by a little and free at its sides, which draw in by nu, it pulls back with E."""
    law, e = make(LAWS["neo-hookean"]), 1e-6
    F = np.diag([1 + e, 1 - law.poisson_ratio * e, 1 - law.poisson_ratio * e])[None]
    sigma = elastic_stress(law, F)[0]
    assert sigma[0, 0] == pytest.approx(law.youngs_modulus * e, rel=1e-5)
    assert sigma[1, 1] == pytest.approx(0.0, abs=1e-5 * sigma[0, 0])
    fastest = law.wave_speed(1000.0, None)
    assert fastest**2 * 1000.0 == pytest.approx(
        law.youngs_modulus * (1 - 0.3) / ((1 + 0.3) * (1 - 0.6)), rel=1e-9
    )
