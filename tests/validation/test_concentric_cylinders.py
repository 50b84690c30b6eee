"""Two round walls, one of which turns: the torque of Reiner and Riwlin."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bands import close_to
from clock import at
from turned import filled, lattice
from wall_scenes import grid

from mpmkit.rheology.rotation import coaxial_torque

pytestmark = pytest.mark.section(6)
INNER, OUTER, TALL, VISCOSITY = 0.0635, 0.143, 0.127, 20.0


def torque_of_reiner(rate: float, yield_stress: float) -> float:
    return coaxial_torque(INNER, OUTER, TALL, rate, yield_stress, VISCOSITY)


@pytest.mark.parametrize(
    ("turns", "yield_stress", "exact"),
    [
        (0.05, 50, 0.303),
        (0.25, 50, 0.565),
        (0.5, 50, 0.829),
        (0.05, 100, 0.511),
        (0.25, 100, 0.828),
        (0.5, 100, 1.130),
    ],
)
def test_the_torque_of_reiner_is_that_of_the_table(turns, yield_stress, exact):
    assert torque_of_reiner(2 * math.pi * turns, yield_stress) == pytest.approx(exact, abs=6e-4)


def cylinders(turns, yield_stress, times, cell=0.005):
    """Torques of both walls on the material, N m for a height of ``TALL``, and power of the inner wall, W.

    All are means from each of the times to the next.
    """
    rate, middle = 2 * math.pi * turns, np.array([0.15, 0.15])
    area = math.pi * (OUTER**2 - INNER**2)
    sample = lattice(
        cell / 2, lambda a, b: (np.hypot(a, b) > INNER) & (np.hypot(a, b) < OUTER), middle, reach=0.16
    )
    sample.volume[:] = area / len(sample.volume)

    def ring(radius, side, **more):
        shape = {"kind": "sphere", "radius": radius, "centre": middle.tolist()}
        return {"surface": {"kind": "body", "shape": shape, "side": side, **more}, "contact": "stick"}

    turning = {"kind": "rotation", "point": middle.tolist(), "rate": rate}
    simulation = filled(
        {
            "until": 5.0,
            "gravity": [0, 0],
            "grid": grid(cell, [0, 0], [0.3, 0.3]),
            "walls": {"inner": ring(INNER, "outside", motion=turning), "outer": ring(OUTER, "inside")},
            "bodies": [
                {
                    "material": {
                        "law": "bingham-evp",
                        "density": 2300,
                        "yield_stress": yield_stress,
                        "plastic_viscosity": VISCOSITY,
                        "sound_speed": 4.0,
                    }
                }
            ],
        },
        sample,
    )
    rows, last, since = [], simulation.wall_sums(), 0.0
    for time in at(simulation, times):
        sums = simulation.wall_sums()
        mean, last = (sums - last) / (time - since), sums
        since = time
        # about the axis of the cylinders: M - (z F_x - x F_z)
        moment = mean[:, 2] - (middle[1] * mean[:, 0] - middle[0] * mean[:, 1])
        rows.append([*moment * TALL, mean[0, 3] * TALL])
        assert abs(mean[1, 3]) == 0.0  # a wall at rest does no work
    return np.array(rows)


def hold_torque(validate, turns, yield_stress, times):
    found, rate = cylinders(turns, yield_stress, times), 2 * math.pi * turns
    np.testing.assert_allclose(found[:, 2], rate * np.abs(found[:, 0]), rtol=1e-10)
    inner, outer = np.abs(found[-1, :2])
    exact = torque_of_reiner(rate, yield_stress)
    assert np.prod(np.sign(found[-1, :2])) == -1
    name = f"Concentric cylinders, {yield_stress:g} Pa, {turns:g} rev/s"
    validate(f"{name}: torque of the inner one", inner, close_to(exact, rel=0.03), unit="N m")
    validate(f"{name}: torque of the outer one", outer, close_to(exact, rel=0.03), unit="N m")
    validate(f"{name}: one torque over the other", outer / inner, close_to(1.0, rel=0.02))


def test_torque_of_cylinders(validate):
    hold_torque(validate, 0.25, 100, [0.3, 0.45])


@pytest.mark.slow
@pytest.mark.parametrize("yield_stress", [50, 100])
@pytest.mark.parametrize("turns", [0.05, 0.25, 0.5])
def test_steady_torque_of_cylinders(validate, turns, yield_stress):
    hold_torque(validate, turns, yield_stress, [0.75, 1.0])
