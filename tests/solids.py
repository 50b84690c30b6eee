"""Shapes of which volume and particles are known, and files of surfaces."""

from __future__ import annotations

import numpy as np
import pytest
from mpmkit_plugins.body_shapes.box import Box
from mpmkit_plugins.body_shapes.cylinder import Cylinder
from mpmkit_plugins.body_shapes.frustum import Frustum
from mpmkit_plugins.body_shapes.polygon import Polygon
from mpmkit_plugins.body_shapes.sphere import Sphere

from mpmkit.geometry import sample
from mpmkit.spaces import SPACES

SOLID, PLANE, RADIAL = SPACES["3d"], SPACES["plane-strain"], SPACES["axisymmetric"]
CONE = Frustum(bottom_radius=0.1, top_radius=0.05, height=0.3)
ROD = Cylinder(radius=0.1, height=0.2)
BALL = Sphere(centre=[0, 0, 0.1], radius=0.1)
BALL_2D = Sphere(centre=[0, 0.1], radius=0.1)
BLOCK = Box(lower=[0, 0, 0], upper=[0.1, 0.2, 0.3])
RING = Box(lower=[0.1, 0], upper=[0.3, 0.5])
CORNERS = [[0.05, 0], [0.1, 0], [0.1, 0.2], [0.3, 0.5], [0.05, 0.5]]
"""A funnel with its outlet, which has a corner that points inwards."""
FUNNEL = Polygon(corners=CORNERS)
HOPPER = Polygon(corners=CORNERS[::-1], y=[-0.1, 0.05])


def fill(shape, space, cell=0.01, per_axis=2, keep=None, origin=0.0):
    return sample(
        shape, space, origin=[origin] * space.dim, cell_size=cell, per_axis=[per_axis] * space.dim, keep=keep
    )


def whole(space):
    return np.full(space.dim, -1.0), np.full(space.dim, 1.0)


def write(path, vertices, faces):
    trimesh = pytest.importorskip("trimesh")
    trimesh.Trimesh(vertices, faces, process=False).export(path)
    return str(path)


def icosphere(radius, subdivisions=4):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.icosphere(subdivisions, radius=radius)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


BLOCK_QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def text(path, content):
    path.write_text(content)
    return str(path)


CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * 0.1
CUBE_FACES = np.concatenate([BLOCK_QUADS[:, [0, 1, 2]], BLOCK_QUADS[:, [0, 2, 3]]])
