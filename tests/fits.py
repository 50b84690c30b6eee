"""Fast fits: a closed form instead of runs, and a tiny block that spreads."""

import copy
import math
import tempfile
from concurrent.futures import Executor, Future
from pathlib import Path

import numpy as np
import xarray
from test_cli import CASE as BLOCK

import mpmkit
from mpmkit.fitting import parse_fit
from mpmkit.study.work import Outcome

CASE = {
    "space": "axisymmetric",
    "until": 4.0,
    "grid": {
        "cell_size": 0.02,
        "domain": {"r": [0, 0.6], "z": [0, 0.32]},
        "faces": {"z_min": "slip"},
    },
    "bodies": [
        {
            "shape": {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": 0.3},
            "material": {
                "law": "bingham-evp",
                "density": 2500,
                "yield_stress": 100,
                "plastic_viscosity": 50,
                "sound_speed": {"mach": 0.1},
            },
        }
    ],
    "scheme": {"shape": "cpgimp", "order": "usl", "velocity": "apic", "volumetric": "nodal-average"},
}
"""A slump that is never run."""
YIELD_STRESS, VISCOSITY = "bodies.0.material.yield_stress", "bodies.0.material.plastic_viscosity"
PARAMETERS = {YIELD_STRESS: {"low": 20, "high": 1000}, VISCOSITY: {"low": 5, "high": 500}}
FIRST = 0.2
"""Diameter at the start, m."""


def final_spread(tau0):
    """Final spread, m, by the formula of Roussel and Coussot; it does not depend on the viscosity."""
    return 0.6 * (100 / tau0) ** 0.2


def spread(time, tau0, stress):
    """D(t), m: exponential approach to the final spread, with a time that grows with the stress beyond
    yield."""
    end = final_spread(tau0)
    return end - (end - FIRST) * np.exp(-np.asarray(time) / time_scale(stress))


def time_scale(stress):
    """s"""
    return 0.05 + stress / 1000


def beyond_yield(material):
    """Stress beyond yield, Pa: mu of Bingham's plastic at 1 /s; k 2ⁿ/2 of Herschel and Bulkley's fluid."""
    if material["law"] == "bingham-evp":
        return material["plastic_viscosity"]
    return material["consistency"] * 2 ** (material["flow_index"] - 1)


COST = {"wall_seconds": 1.0}


class Pretend(Executor):
    """Gives at once what the closed form gives, and counts.

    Args:
        stopped: a function of a material that says whether a guard stops its run.
        offset: of a model with cells of h, as part of its spread: offset · h/20 mm.
        widest: diameter of the domain, m; a run ends where the material leaves it.
    """

    def __init__(self, stopped=lambda material: False, offset=0.0, widest=math.inf):
        self.ran = []
        self._stopped, self._offset, self._widest = stopped, offset, widest

    def submit(self, work, /, data, threads, page):
        self.ran.append(data)
        future = Future()
        future.set_result(self._outcome(data, b"" if page is None else page.title.encode()))
        return future

    def _outcome(self, data, page):
        material = data["bodies"][0]["material"]
        if self._stopped(material):
            return Outcome("energy", "it gained energy", {}, {}, b"")
        time = np.linspace(0, data["until"], 401)
        series = spread(time, material["yield_stress"], beyond_yield(material))
        series = series * (1 + self._offset * data["grid"]["cell_size"] / 0.02)
        left = bool((series > self._widest).any())
        if left:
            inside = int(np.argmax(series > self._widest)) + 1
            time, series = time[:inside], series[:inside]
        above = series >= 0.5
        t500 = float(np.interp(0.5, series, time)) if above.any() else None
        summary = {"t500": t500, "final_spread": float(series[-1]), "final_slump": 0.2, "final_height": 0.1}
        fate = "particle-outside" if left else "finished"
        if left:
            summary |= {"final_spread": None, "final_slump": None, "final_height": None}
        summary["stopped_because"] = fate
        fields = {
            "spread_diameter": ("time", series, {"units": "m"}),
            "height": ("time", 0.02 / series**2, {"units": "m"}),
        }
        if data["output"]["particle_history"]:
            shear = np.geomspace(0.01, 10, 401)[:, None] * np.ones((1, 3))
            fields["shear_rate"] = (("time", "particle"), shear)
            fields["yielded"] = (("time", "particle"), np.ones_like(shear))
        with tempfile.TemporaryDirectory() as place:
            path = Path(place) / "history.nc"
            xarray.Dataset(fields, {"time": ("time", time, {"units": "s"})}).to_netcdf(path, engine="netcdf4")
            return Outcome(fate, "it left" if left else "", summary, COST, path.read_bytes(), page)


def a_fit(measurements, parameters=PARAMETERS, changes=None, **keys):
    """A fit of the case that is never run."""
    case = copy.deepcopy(CASE)
    test = {"case": case, "measurements": measurements, "stages": [{}], "model_error": 0.0} | (changes or {})
    return parse_fit({"name": "slump", "tests": {"slump": test}, "parameters": parameters} | keys)


ROWS = np.linspace(0.1, 2.0, 40)
"""Times of a measured curve, s."""


def curve(path, tau0, stress, noise=0.0, seed=0, time=ROWS):
    """Write a measured curve, and return its measurement."""
    value = spread(time, tau0, stress)
    value = value * (1 + noise * np.random.default_rng(seed).standard_normal(len(time)))
    lines = ["# made by a closed form", "time_s,spread_diameter_m"]
    lines += [f"{t:.6f},{d:.8f}" for t, d in zip(time, value, strict=True)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    part = max(noise, 1e-3)
    return {"variable": "spread_diameter", "file": str(path), "relative_uncertainty": part}


def bound_of_a_curve(time, tau0, viscosity, noise):
    """Least standard deviations of ln τ0 and ln μ from D(t) with independent relative noise (Cramér and Rao).

    The covariance of any unbiased estimate is at least noise² (Jᵀ J)⁻¹, J = ∂ ln D/∂(ln τ0, ln μ) by row:

        ∂D/∂ln τ0 = −E/5 (1 − e), ∂D/∂ln μ = −(E − D0) e t/T² ∂T/∂ln μ, e = exp(−t/T), ∂T/∂ln μ = μ/1000.
    """
    time, end, scale = np.asarray(time), final_spread(tau0), time_scale(viscosity)
    decay = np.exp(-time / scale)
    of_stress = -end / 5 * (1 - decay)
    of_viscosity = -(end - FIRST) * decay * time / scale**2 * viscosity / 1000
    slopes = np.stack([of_stress, of_viscosity], axis=1) / spread(time, tau0, viscosity)[:, None] / noise
    return np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))


def t500(tau0, stress):
    """s"""
    end = final_spread(tau0)
    return time_scale(stress) * math.log((end - FIRST) / (end - 0.5))


VISCOSITY_OF_A_BLOCK = "bodies.0.material.viscosity"


def block_of(viscosity):
    """The content of a fit file: the spread of a tiny block at two times, from a run with this viscosity."""
    case = copy.deepcopy(BLOCK) | {"until": 0.2}
    truth = copy.deepcopy(case)
    truth["bodies"][0]["material"]["viscosity"] = viscosity
    spread = mpmkit.run(mpmkit.parse_case(truth)).spread_diameter
    measured = [
        {
            "variable": "spread_diameter",
            "time": time,
            "value": float(spread.interp(time=time)),
            "relative_uncertainty": 0.005,
        }
        for time in (0.1, 0.2)
    ]
    test = {"case": case, "measurements": measured, "stages": [{}], "model_error": 0}
    return {
        "name": "block",
        "tests": {"block": test},
        "parameters": {VISCOSITY_OF_A_BLOCK: {"low": 100, "high": 2000}},
        "pages": False,
    }
