"""Small scenes of blocks, for what can only be seen of a scheme in motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..case import Case, parse_case
from ..contracts import Plugin
from ..solver.simulation import Simulation

DX = 0.0625
SMALL_STEP = 0.1
"""Fraction of the critical step at which even USL with linear shape functions survives its nearly empty nodes
long enough: a particle that enters a cell at speed v leaves the unstable range in (fraction) c / v steps."""
STIFFNESS = 1e5
RUBBER = {"law": "neo-hookean", "density": 1000.0, "youngs_modulus": STIFFNESS, "poisson_ratio": 0.3}
AXES = {"plane-strain": "xz", "axisymmetric": "rz", "3d": "xyz"}
SPACES = tuple(AXES)

Corners = Sequence[int]
Block = tuple[Corners, Corners, Mapping[str, Any], Sequence[float] | None]
Scheme = Mapping[str, Any]


def simulate(
    space: str,
    scheme: Scheme,
    blocks: Sequence[Block],
    domain: Sequence[Sequence[int]],
    faces: Mapping[str, Any] | None = None,
    gravity: Sequence[float] | None = None,
    fraction: float = 0.4,
) -> Simulation:
    """A scene on cells of ``DX``.

    Args:
        space: as in a case file.
        scheme: as in a case file; an entry may also be a plug-in, registered or not.
        blocks: ``(lower corner, upper corner, material, velocity)``, corners in cells.
        domain: lower and upper end along each axis, in cells.
        faces: as in a case file.
        gravity: m/s² along each axis; default: none.
        fraction: of the critical step.
    """
    axes = AXES[space]
    given = {key: value for key, value in scheme.items() if isinstance(value, Plugin)}
    named = {key: value for key, value in scheme.items() if key not in given}
    case = parse_case(
        {
            "space": space,
            "until": 1.0,
            "gravity": list(gravity) if gravity else [0.0] * len(axes),
            "grid": {
                "cell_size": DX,
                "domain": {a: [low * DX, high * DX] for a, (low, high) in zip(axes, domain, strict=True)},
                "faces": dict(faces or {}),
            },
            "bodies": [_body(*block) for block in blocks],
            "scheme": {**named, "time_step": {"fraction": fraction}},
        }
    )
    return Simulation(_with(case, given))


def _body(lower: Corners, upper: Corners, material: Mapping[str, Any], velocity: Any) -> dict[str, Any]:
    ends = {"lower": [DX * x for x in lower], "upper": [DX * x for x in upper]}
    return {"shape": {"kind": "box", **ends}, "material": dict(material), "velocity": velocity}


def _with(case: Case, plugins: Mapping[str, Plugin]) -> Case:
    """The case with schemes that need not be registered."""
    return case.model_copy(update={"scheme": case.scheme.model_copy(update=dict(plugins))})


def shake(simulation: Simulation, size: float = 0.5, seed: int = 21) -> None:
    """Add a smooth velocity field, so that the body deforms and turns; it vanishes on the axis r = 0."""
    p = simulation.particles
    x = (p.position - p.position.mean(axis=0)) / DX
    if simulation.case.space == "axisymmetric":
        x[:, 0] = p.position[:, 0] / DX
    rng = np.random.default_rng(seed)
    waves = rng.uniform(-0.4, 0.4, (p.dim, p.dim))
    still = p.velocity[:, 0].copy()
    p.velocity += size * np.sin(x @ waves)
    if simulation.case.space == "axisymmetric":
        p.velocity[:, 0] = still + size * np.sin(0.3 * p.position[:, 0] / DX)


def by_number(simulation: Simulation, field: str = "position") -> np.ndarray:
    """A field of the particles in the order of the start."""
    p = simulation.particles
    return getattr(p, field)[np.argsort(p.number)]


def block(space: str, corner: int = 3, size: int = 4) -> tuple[list[int], list[int], list[list[int]]]:
    """Corners of a block in cells, and a domain with room around it; a cylinder if axisymmetric."""
    dim = 3 if space == "3d" else 2
    lower, upper = [corner] * dim, [corner + size] * dim
    if space == "axisymmetric":
        lower[0], upper[0] = 0, size
    return lower, upper, [[0, 2 * corner + size]] * dim


def free_block(
    space: str, scheme: Scheme, velocity: Sequence[float], gravity: Sequence[float], fraction: float
) -> Simulation:
    """A block of rubber with nothing around it; axisymmetric ones move along their axis alone."""
    lower, upper, domain = block(space)
    v, g = list(velocity[: len(lower)]), list(gravity[-len(lower) :])
    if space == "axisymmetric":
        v[0] = g[0] = 0.0
    return simulate(space, scheme, [(lower, upper, RUBBER, v)], domain, None, g, fraction)
