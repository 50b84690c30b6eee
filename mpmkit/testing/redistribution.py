"""What every redistribution must do: nothing where there is no shear, no harm where there is."""

from __future__ import annotations

import math

import numpy as np

from ..contracts import Redistribution
from ..solver.simulation import Simulation
from .scenes import AXES, DX, block, by_number, simulate
from .violation import require, require_all, require_close, require_same
from .volumetric import OIL

MAY_CHANGE = ("position", "velocity", "volume_ratio", "volume", "quadrature", "expansion")
"""Particle fields that a redistribution changes, with its calls."""
KEPT = ("number", "mass", "initial_volume", "affine", "velocity_gradient", "stress", "pressure")
SHEAR_RATE, TIME = 1.0, 0.1
LARGE = 1e3
"""Shear after which every redistribution that does anything is due."""
LEAST_RATIO, MOST_RATIO = 0.5, 2.0
"""Volume ratios that a nearly incompressible fluid does not come to."""


def full(space: str, author: Redistribution) -> Simulation:
    """A closed domain, full of oil that shears, each particle in its place."""
    axes, side = AXES[space], 5
    dim = len(axes)
    faces = {
        f"{axis}_{end}": "slip" for axis in axes for end in ("min", "max") if (axis, end) != ("r", "min")
    }
    oil = ([0] * dim, [side] * dim, OIL, None)
    return _begun(simulate(space, {"redistribution": author}, [oil], [[0, side]] * dim, faces))


def heap(space: str, author: Redistribution) -> Simulation:
    """A block of oil with nothing around it, which shears."""
    lower, upper, domain = block(space)
    return _begun(simulate(space, {"redistribution": author}, [(lower, upper, OIL, None)], domain))


def _begun(simulation: Simulation) -> Simulation:
    simulation.operations.begin()
    simulation.particles.velocity_gradient[:, 0, 1] = SHEAR_RATE
    return simulation


def disorder(simulation: Simulation, amount: float = 0.2) -> None:
    """Move every particle by up to a part of its box, within the domain; give it a velocity."""
    p, rng = simulation.particles, np.random.default_rng(5)
    p.position += 2 * amount * p.box * rng.uniform(-1.0, 1.0, p.position.shape)
    np.clip(p.position, 1e-3 * DX, simulation.grid.extent - 1e-3 * DX, out=p.position)
    p.velocity[:] = rng.standard_normal(p.velocity.shape)
    p.affine[:] = rng.standard_normal(p.affine.shape)
    simulation.operations.sorting.sorts = 0
    simulation.operations.begin()


def redistribute(simulation: Simulation) -> None:
    """Let the redistribution do what is due for ``TIME`` seconds, if it ever does anything."""
    operations = simulation.operations
    operations.stage.shear, operations.stage.elapsed = LARGE, TIME
    operations.stage.redistribute_if_due(operations.window, operations.sorting)
    lost = operations.begin()
    require(lost is None, "a particle was moved out of the grid")


def is_due(author: Redistribution) -> None:
    """It answers with True or False, and is not due where there was no shear."""
    for shear in (0.0, LARGE):
        found = author.is_due(shear)
        require(isinstance(found, bool | np.bool_), f"is_due returned {found!r}; it must be True or False")
    require(not author.is_due(0.0), "it is due where there was no shear; at rest there is nothing to do")


def even_particles(space: str, author: Redistribution) -> None:
    """In a domain that is full, particles in their places stay there, with the volume that they have."""
    simulation = full(space, author)
    before = by_number(simulation).copy()
    redistribute(simulation)
    _require_unmoved(simulation, before, np.ones(len(before)), "of an even lattice")
    weights = by_number(simulation, "quadrature")
    require_close(weights, 1.0, 1e-9, lambda p: f"the weight of particle {p} of an even lattice")


def rest(space: str, author: Redistribution) -> None:
    """Without shear, at rest or in rigid rotation, no particle is moved, even from a disordered place."""
    simulation = heap(space, author)
    disorder(simulation)
    p = simulation.particles
    p.velocity_gradient[:] = 0.0
    if simulation.grid.dim == 3 or space == "plane-strain":
        p.velocity_gradient[:, 0, 1], p.velocity_gradient[:, 1, 0] = 2.0, -2.0
    before, ratio = by_number(simulation).copy(), by_number(simulation, "volume_ratio").copy()
    redistribute(simulation)
    _require_unmoved(simulation, before, ratio, "without shear")


def _require_unmoved(simulation: Simulation, position: np.ndarray, ratio: np.ndarray, where: str) -> None:
    moved = np.abs(by_number(simulation) - position).max(axis=1)
    require_close(moved, 0.0, 1e-9 * DX, lambda p: f"the way that particle {p} {where} was moved", "m")
    found = by_number(simulation, "volume_ratio")
    require_close(found, ratio, 1e-9, lambda p: f"the volume ratio of particle {p} {where}")


def mass_and_momentum(space: str, author: Redistribution) -> None:
    """Mass and momentum are kept, and so are all fields that a redistribution may not change."""
    simulation = heap(space, author)
    disorder(simulation)
    p = simulation.particles
    before = {name: by_number(simulation, name).copy() for name in KEPT}
    momentum, scale = p.mass @ p.velocity, float(np.abs(p.mass[:, None] * p.velocity).sum())
    redistribute(simulation)
    for name, array in before.items():
        require_same(by_number(simulation, name), array, lambda *at, name=name: f"{name} of particle {at[0]}")
    require_close(
        p.mass @ p.velocity, momentum, 1e-12 * scale, lambda a: f"component {a} of the momentum", "kg m/s"
    )


def disorder_decays(space: str, author: Redistribution) -> None:
    """Disordered particles in a closed domain come no closer, however often it is repeated."""
    simulation = full(space, author)
    disorder(simulation)
    p, grid = simulation.particles, simulation.grid
    crowding = [_unevenness(simulation)]
    for _ in range(8):
        p.velocity_gradient[:] = 0.0
        p.velocity_gradient[:, 0, 1] = SHEAR_RATE
        redistribute(simulation)
        for name in MAY_CHANGE:
            finite = np.isfinite(getattr(p, name)).reshape(len(p), -1).all(axis=1)
            require_all(finite, lambda q, name=name: f"{name} of particle {q} is not finite")
        inside = np.all((p.position >= 0) & (p.position <= grid.extent), axis=1)
        require_all(inside, lambda q: f"particle {q} was moved out of a closed domain, to {p.position[q]} m")
        sound = (p.volume_ratio > LEAST_RATIO) & (p.volume_ratio < MOST_RATIO)
        require_all(sound, lambda q: f"the volume ratio of particle {q} became {p.volume_ratio[q]:.4g}")
        crowding.append(_unevenness(simulation))
    require(
        crowding[-1] <= 1.01 * crowding[0],
        f"particles became less even: the number of them around each varies by {crowding[0]:.4g} of its mean "
        f"at first, and by {crowding[-1]:.4g} after {len(crowding) - 1} redistributions",
    )


def _unevenness(simulation: Simulation) -> float:
    """How far the mass around each particle, within its own spacing, is from the mean; 1."""
    p = simulation.particles
    size = (
        p.initial_volume / (2 * math.pi * p.position[:, 0])
        if simulation.operations.radial
        else p.initial_volume
    )
    h = float(np.median(size)) ** (1 / p.dim)
    apart = np.abs(p.position[:, None, :] - p.position[None, :, :]) / h
    around = np.prod(np.maximum(0.0, 1.5 - apart), axis=2) @ size
    inner = ((p.position > 1.5 * h) & (p.position < simulation.grid.extent - 1.5 * h)).all(axis=1)
    return float(np.std(around[inner]) / np.mean(around[inner]))


def repeatable(space: str, author: Redistribution) -> None:
    """The same particles are redistributed in the same way, to the bit."""
    found = []
    for _ in range(2):
        simulation = full(space, author)
        disorder(simulation)
        redistribute(simulation)
        found.append({name: by_number(simulation, name).copy() for name in MAY_CHANGE})
    for name, array in found[0].items():
        require_same(found[1][name], array, lambda *at, name=name: f"{name} of particle {at[0]}, done again,")
