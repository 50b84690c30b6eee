"""The scenes of viscous.py: a block at rest, and a channel that should only creep."""

from __future__ import annotations

import numpy as np

import mpmkit

DENSITY, YIELD, PLASTIC, SOUND = 2574.0, 188.91, 45.65, 10.0
STEPS = 8000
PART = 0.5
"""Of the yield stress: what the channel's wall bears."""
SPAN = 1000
"""Steps of one at the limit that a block is watched for."""


def limit(dx: float, m: np.ndarray | float) -> np.ndarray | float:
    """0.375 rho dx²/mu with mu at rest, s."""
    return 0.375 * DENSITY * dx**2 / (YIELD * m + PLASTIC)


def block(dx: float, m: float, form: str, scheme: dict) -> mpmkit.case.Case:
    """Eight cells square, its faces on nodes, at rest but for a nudge that is too small to make it yield."""
    material = {"density": DENSITY, "yield_stress": YIELD, "plastic_viscosity": PLASTIC, "sound_speed": SOUND}
    law = {"law": "bingham-evp"} if form == "exact" else {"law": "bingham", "form": form, "regularisation": m}
    step = min(dx / SOUND, limit(dx, m)) if form == "explicit" else dx / SOUND
    nudge = 1e-3 * dx / max(m, 1.0)
    return mpmkit.parse_case(
        {
            "space": "plane-strain",
            "until": SPAN * step,
            "gravity": [0, 0],
            "grid": {"cell_size": dx, "domain": {"x": [0, 10 * dx], "z": [0, 10 * dx]}},
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [dx, dx], "upper": [9 * dx, 9 * dx]},
                    "material": law | material,
                    "velocity": {"amplitude": [nudge, nudge], "wave_vector": [2.7 / dx, 1.9 / dx]},
                }
            ],
            "scheme": {"volumetric": "own", "redistribution": "none", **scheme},
        }
    )


def creep(ratio: float, scheme: dict) -> float:
    """Discharge of a channel that should only creep, over what it should be, at this part of the limit."""
    dx, m, cells = 0.005, 1000.0, 8
    height = cells * dx
    case = mpmkit.parse_case(
        {
            "space": "plane-strain",
            "until": 1.0,
            "gravity": [PART * YIELD / (DENSITY * height), 0],
            "grid": {
                "cell_size": dx,
                "domain": {"x": [0, 4 * dx], "z": [0, height]},
                "faces": {"x_min": "periodic", "x_max": "periodic", "z_min": "stick", "z_max": "slip"},
            },
            "bodies": [
                {
                    "shape": {"kind": "box", "lower": [0, 0], "upper": [4 * dx, height]},
                    "material": {
                        "law": "bingham",
                        "density": DENSITY,
                        "yield_stress": YIELD,
                        "plastic_viscosity": PLASTIC,
                        "regularisation": m,
                        "sound_speed": 20.0,
                    },
                    "velocity": {"amplitude": [1e-3 * dx, 1e-3 * dx], "wave_vector": [2.7 / dx, 1.9 / dx]},
                }
            ],
            "scheme": {"volumetric": "own", "time_step": {"fraction": 1, "ignore": ["viscous"]}, **scheme},
        }
    )
    simulation = mpmkit.Simulation(case)
    simulation.choose_time_step = lambda: None  # type: ignore[method-assign]
    simulation.time_step = ratio * limit(dx, m)
    p, found = simulation.particles, []
    for step in range(STEPS):
        simulation.advance()
        if step >= STEPS // 2:
            found.append(np.average(p.velocity[:, 0], weights=p.mass))
    # Below yield γ̇ = -ln(1 - τ/τ0)/m, τ = PART τ0 (1 - z/H); the mean velocity is ∫ γ̇ (1 - z/H) dz.
    s = (np.arange(2000) + 0.5) / 2000
    return float(np.mean(found) / (height * np.mean(-np.log(1 - PART * s) / m * s)))
