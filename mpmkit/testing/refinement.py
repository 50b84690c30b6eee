"""What every refinement must do: no harm to what there is, and an end to it."""

from __future__ import annotations

import numpy as np

from ..contracts import Refinement
from ..solver.simulation import Simulation
from .redistribution import disorder
from .scenes import block, simulate
from .violation import require, require_all, require_close, require_same
from .volumetric import OIL

ROUNDS = 30
"""Times that a scene is thrown into disorder, each followed by a refinement."""
MOST = 10
"""Particles for each one at the start that no flow needs, beside two full cells for each of the domain."""
STRETCH = 3.0
"""Largest factor of a box's side in a round."""
SUMS = ("portion", "mass", "initial_volume", "volume")
"""What particles have together, and keep."""


def heap(space: str, author: Refinement) -> Simulation:
    """A block of oil with nothing around it."""
    lower, upper, domain = block(space)
    simulation = simulate(space, {"refinement": author}, [(lower, upper, OIL, None)], domain)
    simulation.operations.begin()
    return simulation


def draw_out(simulation: Simulation, seed: int) -> None:
    """Put the particles into disorder, with random velocities; make boxes longer and thinner at random."""
    disorder(simulation)
    p, rng = simulation.particles, np.random.default_rng(seed)
    p.box *= STRETCH ** rng.uniform(-1.0, 1.0, p.box.shape)
    p.velocity[:] = rng.standard_normal(p.velocity.shape)


def refine(simulation: Simulation) -> None:
    """Refine once, as a run does every few steps."""
    if simulation.refiner.refine():
        simulation.operations.allocate()
    lost = simulation.operations.begin()
    require(lost is None, "a particle was put outside of the grid")


def as_they_begin(space: str, author: Refinement) -> None:
    """Particles in their places, with the boxes that they have at the start, are left alone."""
    simulation = heap(space, author)
    before = {name: array.copy() for name, array in simulation.particles.arrays().items()}
    refine(simulation)
    found = simulation.particles.arrays()
    count, at_first = len(found["number"]), len(before["number"])
    require(
        count == at_first,
        f"{at_first} particles in their places became {count}; nothing is to be done there",
    )
    for name, array in before.items():
        require_same(found[name], array, lambda *at, name=name: f"{name} of particle {at[0]}, in its place,")


def keeps_what_there_is(space: str, author: Refinement) -> None:
    """Splits and merges keep mass, volume, momentum and centre of mass."""
    simulation = heap(space, author)
    for seed in range(3):
        draw_out(simulation, seed)
        p = simulation.particles
        held, momentum = {name: getattr(p, name).sum() for name in SUMS}, p.mass @ p.velocity
        scale = float(np.abs(p.mass[:, None] * p.velocity).sum())
        along = slice(space == "axisymmetric", None)  # a ring's centre is not at its radius
        moment = p.mass @ p.position[:, along]
        refine(simulation)
        for name, total in held.items():
            what = f"the sum of {name} over all particles"
            require_close(np.array([getattr(p, name).sum()]), total, 1e-12 * total, lambda _, w=what: w)
        require_close(
            p.mass @ p.velocity, momentum, 1e-12 * scale, lambda a: f"component {a} of the momentum", "kg m/s"
        )
        found = p.mass @ p.position[:, along]
        require_close(found, moment, 1e-12 * moment.max(), lambda a: f"component {a} of Σ m x", "kg m")
        for name, array in p.arrays().items():
            finite = np.isfinite(array).reshape(len(array), -1).all(axis=1)
            require_all(finite, lambda q, name=name: f"{name} of particle {q} is not finite")


def ends(space: str, author: Refinement) -> None:
    """However often particles are thrown into disorder and drawn out, their number comes to an end."""
    simulation = heap(space, author)
    begun, grid = len(simulation.particles), simulation.grid
    most = MOST * begun + 2 * 2**grid.dim * int(np.prod(grid.cells))
    for turn in range(1, ROUNDS + 1):
        draw_out(simulation, turn)
        refine(simulation)
        count = len(simulation.particles)
        require(
            count <= most,
            f"{begun} particles became {count} as they were drawn out {turn} times; no flow needs more than "
            f"{most}: {MOST} for each of them, and what fills all cells of the domain twice",
        )


def repeatable(space: str, author: Refinement) -> None:
    """The same particles are refined in the same way, to the bit."""
    found = []
    for _ in range(2):
        simulation = heap(space, author)
        draw_out(simulation, 7)
        refine(simulation)
        found.append({name: array.copy() for name, array in simulation.particles.arrays().items()})
    counts = [len(arrays["number"]) for arrays in found]
    require(counts[0] == counts[1], f"the same particles became {counts[0]}, and done again {counts[1]}")
    for name, array in found[0].items():
        require_same(found[1][name], array, lambda *at, name=name: f"{name} of particle {at[0]}, done again,")
