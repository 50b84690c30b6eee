"""Shape functions with four nodes per axis, the largest number, at every face of the domain.

In three dimensions their kernels take long to compile, so these tests are slow tests.
"""

from __future__ import annotations

import numpy as np
import pytest

import mpmkit
from mpmkit.contracts import ShapeFunction
from mpmkit.registry import Registered, Registry, installed

SPACES = {"plane-strain": "xz", "axisymmetric": "rz", "3d": "xyz"}
FACES = ["open", "slip", "symmetry", "stick", "periodic", {"kind": "friction", "coefficient": 0.4}]
DX, CELLS = 0.1, 6


def of_space(space, *values):
    """Parameters of a test in a space."""
    return pytest.param(space, *values, marks=pytest.mark.slow if space == "3d" else ())


class CubicSplines(ShapeFunction):
    """Cubic B-splines of width 4 cells, weight 4/6 at the particle's own node."""

    name = "cubic-splines"
    api_version = 2
    citation = "a test"
    support = 4

    def fill(self, position, half_size, cell_size, base, weight, gradient):
        cell = np.floor(position / cell_size)
        x = position / cell_size - cell
        base[:] = cell - 1
        weight[..., 0], weight[..., 3] = (1 - x) ** 3 / 6, x**3 / 6
        weight[..., 1], weight[..., 2] = 2 / 3 - x**2 + x**3 / 2, 2 / 3 - (1 - x) ** 2 + (1 - x) ** 3 / 2
        gradient[..., 0], gradient[..., 3] = -((1 - x) ** 2) / 2, x**2 / 2
        gradient[..., 1], gradient[..., 2] = -2 * x + 3 * x**2 / 2, 2 * (1 - x) - 3 * (1 - x) ** 2 / 2
        gradient /= cell_size

    def fill_radial(self, radius, half_size, cell_size, base, weight, gradient, hoop):
        self.fill(radius, half_size, cell_size, base, weight, gradient)
        hoop[:] = weight / radius[:, None]


def cube_at(face, kind, space):
    """A block of 3 cells that touches a face in the middle of the domain's others, without gravity."""
    axes = SPACES[space]
    axis, upper = axes.index(face[0]), face.endswith("max")
    lower, higher = [DX] * len(axes), [4 * DX] * len(axes)
    if upper:
        lower[axis], higher[axis] = (CELLS - 3) * DX, CELLS * DX
    else:
        lower[axis], higher[axis] = 0.0, 3 * DX
    velocity = [0.3] * len(axes)
    velocity[axis] = 1.0 if upper else -1.0
    faces = {face: kind}
    if kind == "periodic":
        faces = {f"{face[0]}_min": kind, f"{face[0]}_max": kind}
    material = {"law": "neo-hookean", "density": 1000.0, "youngs_modulus": 1e5, "poisson_ratio": 0.3}
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    case = {
        "space": space,
        "until": 1.0,
        "gravity": [0.0] * len(axes),
        "grid": {"cell_size": DX, "domain": {a: [0.0, CELLS * DX] for a in axes}, "faces": faces},
        "bodies": [
            {
                "shape": {"kind": "box", "lower": lower, "upper": higher},
                "material": material,
                "velocity": velocity,
            }
        ],
        "scheme": {"shape": "cubic-splines", "velocity": "flip", "time_step": {"fraction": 0.3}},
    }
    splines = Registered("shape", CubicSplines, "tests", "1", "cubic-splines")
    simulation = mpmkit.Simulation(mpmkit.parse_case(case, registry=Registry([*found, splines], [])))
    p = simulation.particles
    if upper:
        p.position[:, axis] += CELLS * DX - p.position[:, axis].max()  # a row exactly on the face
        p.position[:, axis] = np.minimum(p.position[:, axis], simulation.grid.extent[axis])
    else:
        p.position[:, axis] -= p.position[:, axis].min()
    return simulation, axis


def upper_faces():
    for space, axes in SPACES.items():
        for face in (f"{axis}_max" for axis in axes):
            for kind in FACES:
                if not (face == "r_max" and kind in ("periodic", "symmetry")):
                    yield of_space(space, face, kind)


@pytest.mark.parametrize(("space", "face", "kind"), list(upper_faces()), ids=str)
def test_every_node_that_a_particle_on_a_face_touches_is_stored(space, face, kind):
    """The vectors that P2G and G2P read and write are not checked against the ends of the arrays."""
    simulation, axis = cube_at(face, kind, space)
    p, operations = simulation.particles, simulation.operations
    if kind == "periodic":
        p.position[0, axis] = -1e-20  # which wraps to the upper face itself
    for _ in range(3):
        assert operations.begin() is None
        window, dim = operations.window, len(SPACES[space])
        first = operations.base - window.lower
        assert (first >= 0).all()
        assert (first + CubicSplines.support <= window.shape[:dim]).all()
        dt = simulation.time_step
        operations.step(0.01 * dt)
        assert operations.mapped_mass == pytest.approx(p.mass.sum(), rel=1e-12)
        p.position[:, axis] = np.minimum(p.position[:, axis], simulation.grid.extent[axis])


@pytest.mark.parametrize("kind", [kind for kind in FACES if kind not in ("periodic", "open")], ids=str)
@pytest.mark.parametrize(
    ("space", "axis"), [of_space(s, a) for s, axes in SPACES.items() for a in axes if a != "r"]
)
def test_upper_and_lower_faces_are_mirror_images(space, axis, kind):
    """One block is thrown at the lower face and one at the upper face."""
    velocities = []
    for face in (f"{axis}_min", f"{axis}_max"):
        simulation, number = cube_at(face, kind, space)
        p = simulation.particles
        inside = simulation.grid.extent[number]
        for _ in range(20):
            simulation.advance()
            p.position[:, number] = np.clip(p.position[:, number], 0.0, inside)
        mean = p.mass @ p.velocity / p.mass.sum()
        mean[number] *= -1 if face.endswith("max") else 1
        velocities.append([*mean, p.mass @ (p.velocity**2).sum(axis=1)])
        assert mean[number] > -0.99  # it feels the wall
    np.testing.assert_allclose(velocities[0], velocities[1], rtol=1e-9)
