"""A cone of yield-stress material stands by itself if tau0/(rho g H) is above a threshold.

For the cone of the slump test, 0.1 and 0.2 m wide and 0.3 m high, the threshold is 0.266 on a stick floor and
0.320 on a slip floor. The cone is released at once. A cone that does not flow is still elastic: it sags by
rho g H/(3 G) of its height, half a per cent with G = 5e5 Pa, and oscillates about this for a while.
"""

from __future__ import annotations

import numpy as np
import pytest
from accurate_setup import bingham, scheme
from bands import above, below
from clock import at

import mpmkit

pytestmark = pytest.mark.section(4)

HEIGHT, DENSITY, G = 0.3, 2574.0, 9.81
WEIGHT = DENSITY * G * HEIGHT
THRESHOLDS = {"stick": 0.266, "slip": 0.320}
VISCOSITY = 300.0  # slow against waves, so that it flows without inertia
TIMES = np.linspace(0, 0.5, 51)


def slump(floor: str, number: float, cell_size: float = 0.01) -> np.ndarray:
    """Slump over the height of the cone at ``TIMES``, for tau0/(rho g H) = number."""
    material = bingham(
        number * WEIGHT, VISCOSITY, density=DENSITY, sound_speed={"factor": 10}, shear_modulus=5e5
    )
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "axisymmetric",
                "until": 1.0,
                "grid": {
                    "cell_size": cell_size,
                    "domain": {"r": [0.0, 0.24], "z": [0.0, 0.32]},
                    "faces": {"z_min": floor},
                },
                "bodies": [
                    {
                        "shape": {
                            "kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": HEIGHT,
                        },
                        "material": material,
                    }
                ],
                "scheme": scheme(),
            }
        )
    )  # fmt: skip
    measured = (simulation.measures(simulation.particles)["slump"] for _ in at(simulation, TIMES))
    return np.array(list(measured)) / HEIGHT


def still_going(slumped: np.ndarray) -> float:
    """Increase of the slump over the height from about 0.2 s to about 0.45 s, both means over 0.1 s."""
    early, late = (np.abs(TIMES - t) <= 0.05 for t in (0.2, 0.45))
    return float(slumped[late].mean() - slumped[early].mean())


@pytest.mark.parametrize("floor", THRESHOLDS)
def test_cone_stands_or_flows(validate, floor):
    """At 1.15 times the threshold the cone does not flow on; at 0.85 times it flows."""
    title = "A cone let go, about the yield stress at which it stands"
    chart = validate.figure(f"cone_{floor}", f"{title}, {floor} floor", x="time (s)", y="slump over height")
    for part in (0.85, 1.15):
        slumped = slump(floor, part * THRESHOLDS[floor])
        chart.line(f"{part:g} times the threshold", TIMES, slumped)
        going, name = still_going(slumped), f"Cone on a {floor} floor, {part:g} times the threshold of tau0"
        band = below(5e-4, "0") if part > 1 else above(0.01, "flows")
        validate(f"{name}: slump that goes on, of H", going, band)
