"""Longest stable step: measured by trial, and from the largest eigenvalue of the grid's operator."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import mpmkit

FLIP = {"velocity": "flip", "volumetric": "own"}
SIZE = 1e-6  # of the velocities tried, m/s: everything stays linear, and nothing moves


def block(
    space: str,
    material: dict[str, Any],
    per_cell: list[int],
    cells: int = 8,
    faces: str = "periodic",
    **scheme,
) -> mpmkit.Simulation:
    """A full box of unit cells; in an axisymmetric scene a cylinder about its axis."""
    axes = {"plane-strain": "xz", "axisymmetric": "rz", "3d": "xyz"}[space]
    lengths = [float(cells) if axis != "z" or space == "3d" else 1.0 for axis in axes]
    if space == "plane-strain" and len(per_cell) == 2 and per_cell[1] > 1:
        lengths = [float(cells)] * 2
    named = {f"{axis}_{side}": faces for axis in axes for side in ("min", "max") if axis != "r"}
    if lengths[-1] == 1.0:
        named |= {"z_min": "symmetry", "z_max": "symmetry"}
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": space,
                "until": 1e9,
                "gravity": [0.0] * len(axes),
                "grid": {
                    "cell_size": 1.0,
                    "domain": {
                        axis: [0.0, n + (2 if axis == "r" else 0)]
                        for axis, n in zip(axes, lengths, strict=True)
                    },
                    "faces": named,
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0.0] * len(axes), "upper": lengths},
                        "material": material,
                        "particles_per_cell": per_cell,
                    }
                ],
                "scheme": FLIP | scheme,
            }
        )
    )


def free_bar(
    material: dict[str, Any], shape: str, poke: float, per_cell: int = 2, **scheme
) -> mpmkit.Simulation:
    """A bar of four cells that pokes a little into a fifth.

    With boxes it is the last box that reaches over the node, by ``poke`` of a cell; with points the last
    particle itself, which then gives the next node as much of its mass.
    """
    simulation = mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": 1e9,
                "gravity": [0.0, 0.0],
                "grid": {
                    "cell_size": 1.0,
                    "domain": {"x": [0.0, 9.0], "z": [0.0, 1.0]},
                    "faces": {"z_min": "symmetry", "z_max": "symmetry"},
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [2.0, 0.0], "upper": [6.0, 1.0]},
                        "material": material,
                        "particles_per_cell": [per_cell, 1],
                    }
                ],
                "scheme": FLIP | {"shape": shape} | scheme,
            }
        )
    )
    simulation.particles.position[:, 0] += poke + (0.5 / per_cell if shape == "linear" else 0.0)
    return simulation


def critical_step(make: Callable[[], mpmkit.Simulation], limit: float, high: float = 4.5) -> float:
    """The longest step, over ``limit``, with which random velocities do not grow, by bisection."""
    low = 0.1
    while high - low > 2e-3 * high:
        middle = (low + high) / 2
        if grows(make(), middle * limit):
            high = middle
        else:
            low = middle
    return (low + high) / 2


def grows(simulation: mpmkit.Simulation, dt: float, steps: int = 600) -> bool:
    p = simulation.particles
    p.velocity[:] = SIZE * np.random.default_rng(0).standard_normal(p.velocity.shape)
    simulation.choose_time_step = lambda: None  # type: ignore[method-assign]
    simulation.time_step = dt
    sizes = []
    with np.errstate(all="ignore"):
        for _ in range(steps):
            try:
                simulation.advance()
            except mpmkit.errors.GuardStop:
                return True
            sizes.append(float(np.abs(p.velocity).max()))
    return not max(sizes[steps // 2 :]) < 20 * max(sizes[: steps // 10])


def largest_eigenvalue(simulation: mpmkit.Simulation, guess: float, iterations: int = 400) -> float:
    """Of the grid's own operator, from nodal velocity to minus the nodal acceleration that it causes.

    By power iteration on 1 - t A, with t = 4/guess, so that the largest eigenvalue wins if it is more than
    half of the guess. The stress is what the law answers to a velocity gradient, or to a strain of that size
    if it is elastic, and -K tr for a fluid with a sound speed.
    """
    ops, dim = simulation.operations, simulation.grid.dim
    ops.begin()
    ops.map_to_grid(forces=False)
    nodes = ops.window.nodes
    mass = nodes[:, 0].copy()
    velocity, force = slice(1, 1 + dim), slice(1 + dim, 1 + 2 * dim)
    nodes[:, velocity] = np.random.default_rng(1).standard_normal((len(nodes), dim)) * (mass > 0)[:, None]
    t, size = 4 / guess, 0.0
    nodes[:, force] = 0.0
    ops.solve_momentum(t)  # fills the ghosts
    for _ in range(iterations):
        size = np.linalg.norm(nodes[mass > 0, velocity])
        nodes[:, velocity] /= size
        ops.update_velocity_gradient()
        respond(simulation)
        nodes[:, force] = 0.0
        ops.map_forces()
        ops.solve_momentum(t)
    return (1 + np.linalg.norm(nodes[mass > 0, velocity])) / t


def respond(simulation: mpmkit.Simulation) -> None:
    """The stress that answers to the present velocity gradients."""
    p = simulation.particles
    for group in p.groups:
        law, part = group.law, group.part
        if law.needs_deformation_gradient:  # elastic: a strain of 1e-7 of the velocity gradient
            p.deformation_gradient[part] = np.eye(3) + 1e-7 * p.velocity_gradient[part]
            p.volume_ratio[part] = np.linalg.det(p.deformation_gradient[part])
            law.update_stress(p.kinematics(group), group.state, 1.0, p.stress[part])
            p.stress[part] *= 1e7
        else:
            law.update_stress(p.kinematics(group), group.state, 1.0, p.stress[part])
            stiffness = group.density * group.sound_speed**2
            p.stress[part][:, :3] += (
                stiffness * np.trace(p.velocity_gradient[part], axis1=1, axis2=2)[:, None]
            )
