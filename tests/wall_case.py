"""A slump in a mould on a floor, and the sentence for a change of it that is refused."""

import copy

import pytest

from mpmkit.case import parse_case
from mpmkit.errors import CaseError
from mpmkit.solver.scene import make_particles

FRUSTUM = {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": 0.3}
LIFT = {"kind": "velocity", "velocity": [0, 0.3], "start": 0}
MOULD = {
    "surface": {"kind": "body", "shape": dict(FRUSTUM), "side": "inside", "thickness": 0.02, "motion": LIFT},
    "contact": "slip",
}
FLOOR = {"surface": {"kind": "plane", "point": [0, 0], "normal": [0, 1]}, "contact": "stick"}
SLUMP = {
    "space": "axisymmetric",
    "until": 0.1,
    "grid": {"cell_size": 0.02, "domain": {"r": [0, 0.5], "z": [0, 0.32]}, "faces": {"z_min": "slip"}},
    "bodies": [
        {
            "shape": FRUSTUM,
            "material": {
                "law": "bingham-evp",
                "density": 2400,
                "sound_speed": {"mach": 0.1},
                "yield_stress": 200,
                "plastic_viscosity": 50,
            },
        }
    ],
    "walls": {"mould": MOULD},
}
ABSENT = object()


def changed(*changes):
    """The slump with other values at paths; what is ``ABSENT`` is taken out."""
    data = copy.deepcopy(SLUMP)
    for path, value in zip(changes[::2], changes[1::2], strict=True):
        *keys, last = path.split(".")
        here = data
        for key in keys:
            here = here[int(key) if isinstance(here, list) else key]
        if value is ABSENT:
            del here[last]
        else:
            here[last] = value
    return data


def sentence(data, overrides=()):
    with pytest.raises(CaseError) as caught:
        make_particles(parse_case(data, overrides))
    assert "\n" not in str(caught.value)
    return str(caught.value)


SURFACE, SHAPE, MOTION = "walls.mould.surface", "walls.mould.surface.shape", "walls.mould.surface.motion"
