"""Steady viscoplastic flow down a plane: the exact profiles, and the scene that must reproduce them.

A wall at z = 0 and, a half gap H above it, either the mirror plane of a plane Poiseuille flow or the free
surface of a film. The flow along x is driven by G = rho g_x, Pa/m, so that the shear stress is G (H - z).
All of it is periodic along x and two cells long.

The profile does not depend on x, and a row of equally spaced particles is seen by every node in the same
way wherever the row stands. So nothing crosses the layers, and what is tested is the shear alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from accurate_setup import bingham, herschel_bulkley

import mpmkit
from mpmkit.registry import installed

STANDARD_GRAVITY = 9.81


@dataclass(frozen=True)
class Fluid:
    """tau = tau0 + k γ̇^n: Bingham's plastic for n = 1, Newton's fluid for tau0 = 0 as well."""

    yield_stress: float
    consistency: float
    flow_index: float = 1.0
    density: float = 1.0

    def speed(self, drive: float, height: float, z: np.ndarray | float) -> np.ndarray:
        """u(z) = n/(n+1) (G/k)^(1/n) [(H - y0)^(1+1/n) - max(H - z - y0, 0)^(1+1/n)], y0 = tau0/G."""
        n, plug = self.flow_index, min(self.yield_stress / drive, height)
        depth = np.maximum(height - np.asarray(z) - plug, 0.0)
        factor = n / (n + 1) * (drive / self.consistency) ** (1 / n)
        return factor * ((height - plug) ** (1 + 1 / n) - depth ** (1 + 1 / n))

    def plug_speed(self, drive: float, height: float) -> float:
        return float(self.speed(drive, height, height))

    def half_discharge(self, drive: float, height: float) -> float:
        """Q/2 = u_plug [H - n/(2n+1) (H - y0)], m²/s."""
        n = self.flow_index
        sheared = height - self.yield_stress / drive
        return self.plug_speed(drive, height) * (height - n / (2 * n + 1) * sheared)

    def exponent(self, drive: float, height: float, excess: float) -> float:
        """Papanastasiou's m, s, whose surface excess tau0/(G m) is this fraction of the plug's speed.

        The excess: where tau < tau0 the regularised fluid creeps at γ̇ = -ln(1 - tau/tau0)/m (k is nothing
        there), and the integral of that over the plug, 0 < tau < tau0, is tau0/(G m).
        """
        return self.yield_stress / (drive * excess * self.plug_speed(drive, height))

    def regularised_speed(self, drive: float, height: float, z: np.ndarray, m: float) -> np.ndarray:
        """The exact profile of the regularised fluid, ∫ γ̇(G (H - z)) dz, by quadrature."""
        rate = np.concatenate([[0.0], np.geomspace(1e-12, 1e6, 40_001)])
        stress = -self.yield_stress * np.expm1(-m * rate) + self.consistency * rate**self.flow_index
        edges = np.linspace(0.0, height, 20_001)
        middle = (edges[1:] + edges[:-1]) / 2
        slope = np.interp(drive * (height - middle), stress, rate)
        speed = np.concatenate([[0.0], np.cumsum(slope * np.diff(edges))])
        return np.interp(z, edges, speed)

    def material(self, m: float | None = None, **more: Any) -> dict[str, Any]:
        """Material as a case file writes it, with the simplest law that describes it; without m, the yield
        stress is exact."""
        common = {"density": self.density, **more}
        if self.yield_stress == 0 and self.flow_index == 1:
            return {"law": "newtonian", "viscosity": self.consistency, **common}
        if m is None:
            if self.flow_index == 1:
                return bingham(self.yield_stress, self.consistency, **common)
            return herschel_bulkley(self.yield_stress, self.consistency, self.flow_index, **common)
        common |= {"yield_stress": self.yield_stress, "regularisation": m}
        if self.flow_index == 1:
            return {"law": "bingham", "plastic_viscosity": self.consistency, **common}
        return {
            "law": "herschel-bulkley",
            "consistency": self.consistency,
            "flow_index": self.flow_index,
            **common,
        }


class Channel:
    """The scene, and the quantities that are measured in it."""

    def __init__(
        self,
        fluid: Fluid,
        height: float,
        drive: float,
        *,
        cells: int = 10,
        m: float | None = None,
        sound_speed: float = 1.0,
        normal_gravity: float = 0.0,
        free_surface: bool = False,
        fraction: float = 0.5,
        shear_modulus: float | None = None,
        **scheme: Any,
    ) -> None:
        dx = height / cells
        elastic = {} if shear_modulus is None else {"shear_modulus": shear_modulus}
        headroom = 2 * dx if free_surface else 0.0
        self.fluid, self.height, self.drive, self.m = fluid, height, drive, m
        self.normal_gravity, self.sound_speed = normal_gravity, sound_speed
        self.simulation = mpmkit.Simulation(
            mpmkit.parse_case(
                {
                    "space": "plane-strain",
                    "until": 1.0,
                    "gravity": [drive / fluid.density, -normal_gravity],
                    "grid": {
                        "cell_size": dx,
                        "domain": {"x": [0.0, 2 * dx], "z": [0.0, height + headroom]},
                        "faces": {
                            "x_min": "periodic",
                            "x_max": "periodic",
                            "z_min": "stick",
                            "z_max": "open" if free_surface else "slip",
                        },
                    },
                    "bodies": [
                        {
                            "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [2 * dx, height]},
                            "material": fluid.material(m, sound_speed=sound_speed, **elastic),
                        }
                    ],
                    "scheme": {
                        "velocity": "flip",
                        "volumetric": "own",
                        "time_step": {"fraction": fraction},
                        **scheme,
                    },
                }
            )
        )
        self.particles = self.simulation.particles
        if normal_gravity:
            self._settle()

    def _settle(self) -> None:
        """Put the film under its own weight, so that it need not sink, slowly, as a stiff fluid does.

        J p = rho g (H - z) holds every node, and p = rho c² (1/J - 1) then gives J. The layers themselves
        stay where they are, g H/c² too far apart at the wall, and the shear stress that holds the film is
        wrong by as much of G H: by 2e-4 for c = 50 m/s and H = 50 mm. The film on 10°, which has only 0.14
        G H above its yield stress, feels that as 0.3 % of its speed, u ~ (G H - tau0)^(1 + 1/n).
        """
        p = self.particles
        weight = self.normal_gravity * (self.height - p.position[:, 1])
        p.volume_ratio[:] = 1 - weight / self.sound_speed**2
        p.volume[:] = p.volume_ratio * p.initial_volume
        p.pressure[:] = self.fluid.density * weight / p.volume_ratio

    # --- Changes while it flows ---------------------------------------------------------------------------

    def space_unevenly(self, amplitude: float) -> None:
        """Make layers thicker and thinner by up to this part, in one wave; they still fill the gap.

        As sampled, no particle's box reaches over a node, and cpGIMP cannot be told from linear MPM.
        """
        p, H = self.particles, self.height
        z, half = p.position[:, 1].copy(), p.half_size[:, 1].copy()
        lower, upper = (
            e + amplitude * H / (2 * np.pi) * np.sin(2 * np.pi * e / H) for e in (z - half, z + half)
        )
        for extensive in (p.mass, p.volume, p.initial_volume):
            extensive *= (upper - lower) / (2 * half)
        p.position[:, 1] = (lower + upper) / 2
        p.half_size[:, 1] = p.box[:, 1] = (upper - lower) / 2

    def start_with(self, speed: np.ndarray) -> None:
        """Give the particles this velocity along x."""
        self.particles.velocity[:, 0] = speed

    def sharpen(self, m: float) -> None:
        """Continue the run with another Papanastasiou exponent m, s."""
        group = self.particles.groups[0]
        group.law = group.law.model_copy(update={"regularisation": m})
        self.m = m
        self.simulation.choose_time_step()

    def set_drive(self, drive: float) -> None:
        self.simulation.operations.forces.acceleration[0, 0] = drive / self.fluid.density

    def run(self, seconds: float) -> None:
        end = self.simulation.time + seconds
        while end - self.simulation.time > 1e-9 * seconds:
            self.simulation.advance(end - self.simulation.time)
        self.simulation.check()

    def run_until_steady(self, within: float, interval: float, at_most: float) -> None:
        """Run until the momentum changes by less than ``within`` of what the drive alone would change.

        Twice running: what relaxes at several speeds may pass through balance without being at rest.
        """
        end, calm = self.simulation.time + at_most, 0
        while calm < 2:
            imbalance = self.imbalance(interval)
            calm = calm + 1 if abs(imbalance) < within else 0
            if self.simulation.time > end:
                raise AssertionError(f"not steady after {at_most} s: the imbalance is {imbalance:.2g}")

    def imbalance(self, interval: float) -> float:
        """Rate of change of the momentum along x over the drive, in the next ``interval`` seconds."""
        before = self.discharge()
        self.run(interval)
        gained = self.fluid.density * (self.discharge() - before) / interval
        return gained / (self.drive * self.height)

    # --- What is measured ---------------------------------------------------------------------------------

    @property
    def z(self) -> np.ndarray:
        return self.particles.position[:, 1]

    @property
    def speed(self) -> np.ndarray:
        return self.particles.velocity[:, 0]

    def discharge(self) -> float:
        """∫ u dz over the half gap, m²/s."""
        p = self.particles
        return self.height * float(np.sum(p.mass * p.velocity[:, 0]) / np.sum(p.mass))

    def plug_speed(self) -> float:
        """Speed of the uppermost particles, m/s."""
        return float(self.speed[self.z > self.z.max() - 1e-3 * self.height].mean())

    def error(self, exact: np.ndarray) -> float:
        """Relative L2 distance of the particles' velocities to these."""
        return float(np.linalg.norm(self.speed - exact) / np.linalg.norm(exact))


def observed_order(cells: list[int], errors: list[float]) -> float:
    """Slope of the error over the cell size, fitted to all of them."""
    return -float(np.polyfit(np.log(cells), np.log(errors), 1)[0])


def names(kind: str) -> list[str]:
    """Names of all registered plug-ins of a kind."""
    return list(installed().of_kind(kind))


def down_slope(density: float, degrees: float) -> tuple[float, float]:
    """Drive along a slope, Pa/m, and gravity across it, m/s²."""
    angle = math.radians(degrees)
    return density * STANDARD_GRAVITY * math.sin(angle), STANDARD_GRAVITY * math.cos(angle)
