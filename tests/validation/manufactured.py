"""A manufactured solution: an elastic body that a body force makes move in a known way.

A bar of unit period along x, periodic, of Young's modulus E, Poisson's ratio nu and density rho0, in uniaxial
strain between planes of symmetry, with X the position at rest and c = √(E/rho0):

    u(X, t) = A sin(2πX) sin(2πct),   F = 1 + ∂u/∂X = 1 + 2πA cos(2πX) sin(2πct).

The neo-Hookean law has along x the nominal stress P = G (F - 1/F) + λ ln F / F. Balance of momentum in the
undeformed bar, rho0 ü = ∂P/∂X + rho0 b, then gives the body force per unit of mass that must act:

    b(X, t) = -(2πc)² u - P'(F) ∂F/∂X / rho0,
    P'(F) = G (1 + 1/F²) + λ (1 - ln F)/F²,   ∂F/∂X = -4π²A sin(2πX) sin(2πct).

How it acts in a step: the weak form has ∫ rho b·w, which on particles is f_I = Σ m_p b_p N_Ip, as gravity,
f_I = Σ m_p g N_Ip, with a g of each particle. ``particles_to_nodes(b, "mass")`` is
Σ m b N / Σ m N, so that its product with the nodal mass is that force, folded at the faces as any other; it
is added right before the momentum equation, whatever the update order.

How it starts: in every order x ← x + Δt v with the v that the step's force has just changed, which makes
the scheme a leapfrog, positions at t, velocities at t - Δt/2. Starting with the velocity of t = 0 would shift
the whole motion by half a step. USF stretches with the velocity that the step before had moved the particles
with, so that F comes one step after x: before the first step it is that of t = -Δt. With F = 1 instead it
keeps an offset of Δt ∂u̇/∂X for ever, an error of first order.
"""

from __future__ import annotations

import math

import numpy as np

import mpmkit

MODULUS, POISSON, DENSITY = 1e7, 0.3, 1000.0
SHEAR = MODULUS / (2 * (1 + POISSON))
LAME = MODULUS * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
SPEED = math.sqrt(MODULUS / DENSITY)
PERIOD = 1 / SPEED
K = 2 * math.pi


def displacement(X: np.ndarray, t: float, A: float) -> np.ndarray:
    return A * np.sin(K * X) * math.sin(K * SPEED * t)


def velocity(X: np.ndarray, t: float, A: float) -> np.ndarray:
    return K * SPEED * A * np.sin(K * X) * math.cos(K * SPEED * t)


def stretch(X: np.ndarray, t: float, A: float) -> np.ndarray:
    """F = 1 + ∂u/∂X."""
    return 1 + K * A * np.cos(K * X) * math.sin(K * SPEED * t)


def body_force(X: np.ndarray, t: float, A: float) -> np.ndarray:
    """b, m/s²."""
    swing = math.sin(K * SPEED * t)
    F = stretch(X, t, A)
    slope = -(K**2) * A * np.sin(K * X) * swing
    stiffness = SHEAR * (1 + 1 / F**2) + LAME * (1 - np.log(F)) / F**2
    return -((K * SPEED) ** 2) * displacement(X, t, A) - stiffness * slope / DENSITY


class Bar:
    """The scene, and its error against the solution."""

    def __init__(
        self, cells: int, amplitude: float, fraction: float = 0.1, particles: int = 2, **scheme
    ) -> None:
        self.amplitude = amplitude
        dx = 1 / cells
        self.simulation = mpmkit.Simulation(
            mpmkit.parse_case(
                {
                    "space": "plane-strain",
                    "until": PERIOD,
                    "gravity": [0.0, 0.0],
                    "grid": {
                        "cell_size": dx,
                        "domain": {"x": [0.0, 1.0], "z": [0.0, dx]},
                        "faces": {
                            "x_min": "periodic",
                            "x_max": "periodic",
                            "z_min": "symmetry",
                            "z_max": "symmetry",
                        },
                    },
                    "bodies": [
                        {
                            "shape": {"kind": "box", "lower": [0.0, 0.0], "upper": [1.0, dx]},
                            "material": {
                                "law": "neo-hookean",
                                "density": DENSITY,
                                "youngs_modulus": MODULUS,
                                "poisson_ratio": POISSON,
                            },
                            "particles_per_cell": [particles, 1],
                        }
                    ],
                    "scheme": {"velocity": "flip", "time_step": {"fraction": fraction}, **scheme},
                }
            )
        )
        simulation = self.simulation
        simulation.guards.watches_energy = False  # the body force does work
        simulation.guards.watches_density = False  # how wrong it becomes is what is measured
        self.particles, self.operations = simulation.particles, simulation.operations
        start = np.empty(len(self.particles))
        start[self.particles.number] = self.particles.position[:, 0]
        self._start = start
        self.particles.velocity[:, 0] = velocity(self.rest, -simulation.time_step / 2, amplitude)
        if scheme.get("order") == "usf":
            self._stretch(-simulation.time_step)
        self._solve = self.operations.solve_momentum
        self.operations.solve_momentum = self._solve_with_body_force  # type: ignore[method-assign]

    @property
    def rest(self) -> np.ndarray:
        """X of every particle, in the present order of the arrays."""
        return self._start[self.particles.number]

    def _stretch(self, t: float) -> None:
        """Give the particles the deformation of this time."""
        p = self.particles
        F = stretch(self.rest, t, self.amplitude)
        p.deformation_gradient[:, 0, 0] = p.volume_ratio[:] = F
        p.volume[:] = F * p.initial_volume

    def _solve_with_body_force(self, dt: float) -> None:
        force = body_force(self.rest, self.simulation.time, self.amplitude)
        nodes, along_x = self.operations.window.nodes, 1 + self.particles.dim
        nodes[:, along_x] += nodes[:, 0] * self.operations.particles_to_nodes(force, "mass")
        self._solve(dt)

    def error(self) -> float:
        """Root mean square error of the displacement over A, now."""
        exact = displacement(self.rest, self.simulation.time, self.amplitude)
        off = self.particles.position[:, 0] - self.rest - exact
        off -= np.rint(off)
        return float(np.sqrt(np.mean(off**2))) / self.amplitude

    def largest_error(self, until: float = PERIOD) -> float:
        """Largest of these errors during the run; infinite if the run diverges."""
        simulation, largest = self.simulation, 0.0
        dt = simulation.time_step
        with np.errstate(all="ignore"):
            for _ in range(round(until / dt)):
                try:
                    simulation.advance()
                except mpmkit.errors.GuardStop:
                    return math.inf
                largest = max(largest, self.error())
        return largest
