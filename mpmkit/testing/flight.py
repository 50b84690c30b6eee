"""What every scheme must do to a body in free flight: keep its mass and momentum, and feed it no energy.

Each check takes a space and a scheme, whose entries are names or plug-ins.
"""

from __future__ import annotations

import numpy as np

from ..solver.simulation import Simulation
from .scenes import DX, RUBBER, SMALL_STEP, STIFFNESS, Scheme, block, by_number, free_block, shake, simulate
from .violation import require, require_close

GRAVITY = (0.8, 0.8, -9.81)


def _axial(space: str) -> slice:
    """Components of a sum over all particles that mean something; of a ring's, only the axial one."""
    return slice(1, None) if space == "axisymmetric" else slice(None)


def momentum(space: str, scheme: Scheme) -> None:
    """Σ m on particles and nodes, and Σ m v, of a body that deforms, without wall or gravity: to rounding."""
    simulation = free_block(space, scheme, (5.0, 4.0, 3.0), (0.0,) * 3, SMALL_STEP)
    shake(simulation)
    p = simulation.particles
    start = simulation.measures(p)
    scale = float(np.sum(p.mass * np.linalg.norm(p.velocity, axis=1)))
    mass = start["total_mass"]
    for step in range(40):
        simulation.advance()
        on_nodes = simulation.operations.window.nodes[:, 0].sum()
        require_close(
            on_nodes, mass, 1e-13 * mass, lambda step=step: f"the mass on the nodes in step {step}", "kg"
        )
    end = simulation.measures(p)
    require(float(end["strain_energy"]) > 1e-2, "a body that was shaken has no strain energy after 40 steps")
    require_close(
        np.ravel(end["momentum"])[_axial(space)],
        np.ravel(start["momentum"])[_axial(space)],
        1e-12 * scale,
        lambda axis: f"component {axis} of the momentum of a body in free flight, after 40 steps,",
        "kg m/s",
    )


def free_fall(space: str, scheme: Scheme) -> None:
    """The centre of mass of a deforming body falls as x0 + Σ dt v, v = v0 + Σ dt g, to rounding."""
    simulation = free_block(space, scheme, (3.0, 3.0, 3.0), GRAVITY, SMALL_STEP)
    shake(simulation)
    p, g = simulation.particles, simulation.case.gravity_vector
    v = p.mass @ p.velocity / p.mass.sum()
    x = p.mass @ p.position / p.mass.sum()
    for _ in range(40):
        dt = simulation.advance()
        v = v + dt * g
        x = x + dt * v
    for name, found, expected, unit in (
        ("velocity", p.mass @ p.velocity / p.mass.sum(), v, "m/s"),
        ("position", p.mass @ p.position / p.mass.sum(), x, "m"),
    ):
        require_close(
            found[_axial(space)],
            expected[_axial(space)],
            1e-12,
            lambda axis, n=name: f"component {axis} of the {n} of the centre of mass of a falling body",
            unit,
        )


def uniform_motion(space: str, scheme: Scheme) -> None:
    """A body in uniform motion is where it should be, and strains nothing."""
    velocity = (0.7, -0.4, 0.5)
    simulation = free_block(space, scheme, velocity, (0.0,) * 3, 0.4)
    start = by_number(simulation).copy()
    v = simulation.particles.velocity[0].copy()
    for _ in range(30):
        simulation.advance()
    require_close(
        by_number(simulation),
        start + simulation.time * v,
        1e-13,
        lambda p, axis: f"coordinate {axis} of particle {p} in uniform motion",
        "m",
    )
    require_close(
        simulation.particles.stress,
        0.0,
        1e-9 * STIFFNESS,
        lambda p, k: f"component {k} of the stress of a particle in uniform motion",
        "Pa",
    )


def fraction(space: str, scheme: Scheme) -> None:
    """The part of the acoustic limit that a velocity update says it bears is above 0, and 1 at most."""
    found = scheme["velocity"].acoustic_fraction
    is_number = isinstance(found, int | float) and not isinstance(found, bool)
    require(
        is_number and 0 < found <= 1,
        f"its acoustic_fraction is {found!r}; it must be a number above 0 and at most 1",
    )


def _oscillating_block(space: str, scheme: Scheme) -> Simulation:
    """A rubber block that is compressed and stretched along its height, in a standing wave."""
    lower, upper, domain = block(space, size=8)
    simulation = simulate(space, scheme, [(lower, upper, RUBBER, None)], domain, fraction=0.2)
    p = simulation.particles
    height = p.position[:, -1]
    p.velocity[:, -1] = -0.5 * np.sin(np.pi * (height - height.mean()) / (8 * DX))
    simulation.choose_time_step()
    return simulation


def no_energy_from_nowhere(space: str, scheme: Scheme) -> None:
    """The energy of an oscillating block does not exceed its initial value; a scheme may damp it.

    Within a few per cent, because the velocity of the particles differs from that of the nodes.
    """
    simulation = _oscillating_block(space, scheme)
    p = simulation.particles
    total = []
    for _ in range(60):
        measured = simulation.measures(p)
        total.append(float(measured["kinetic_energy"] + measured["strain_energy"]))
        simulation.advance()
    most = max(total) / total[0]
    require(
        most <= 1.07,
        f"the energy of an oscillating block comes to {most:.3g} of that at the start, in step "
        f"{int(np.argmax(total))} of 60; at most 1.07 is expected",
    )


def energy(space: str, scheme: Scheme) -> None:
    """An oscillating block stores its kinetic energy and gets it back; no energy is created.

    What the particles hold differs from what the nodes see by a few percent; a stress of the wrong sign or
    size, or at the wrong time, makes the energy grow, or keeps it from turning into the other kind.
    """
    simulation = _oscillating_block(space, scheme)
    p = simulation.particles
    kinetic, stored = [], []
    for _ in range(60):
        measured = simulation.measures(p)
        kinetic.append(float(measured["kinetic_energy"]))
        stored.append(float(measured["strain_energy"]))
        simulation.advance()
    of_start, in_store = np.array(kinetic) / kinetic[0], np.array(stored) / kinetic[0]
    require_close(
        of_start + in_store,
        0.97,
        0.1,
        lambda step: f"the energy of an oscillating block, in step {step} of 60, over that at the start,",
    )
    turn = int(np.argmin(of_start))
    require(
        in_store[turn] > 0.7,
        f"an oscillating block has stored {100 * in_store[turn]:.3g} % of its energy where it turns; at "
        "least 70 % is expected",
    )
    back = of_start[turn:].max()
    require(
        back > 0.5,
        f"an oscillating block has {100 * back:.3g} % of its motion back; at least 50 % is expected",
    )
