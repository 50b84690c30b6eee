"""The standard scenes: slump tests of the concrete of Ferreira et al., in mid-flow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

CONCRETE = {"density": 2574, "yield_stress": 188.91, "consistency": 45.65, "flow_index": 1.33}
EXACT = CONCRETE | {"law": "herschel-bulkley-evp", "sound_speed": {"factor": 10}}
REGULARISED = CONCRETE | {
    "law": "herschel-bulkley",
    "regularisation": 1000,
    "sound_speed": {"factor": 50},
}
CONE = {"kind": "frustum", "bottom_radius": 0.1, "top_radius": 0.05, "height": 0.3}
ACCURATE = {
    "shape": "cpgimp",
    "order": "usl",
    "velocity": "apic",
    "volumetric": "nodal-average",
    "time_step": {"fraction": 0.4},
}
SEED = {
    "shape": {"name": "cpgimp", "domain": "fixed"},
    "order": "usl",
    "velocity": "flip",
    "volumetric": "own",
    "time_step": {"fraction": 0.25, "ignore": ["viscous"]},
}
FLOWING = 0.3
"""s after the release: the material flows outwards fastest, and half of the final spread is reached."""


@dataclass(frozen=True)
class BenchScene:
    """A case, and how many times coarser the cells of the run are that gives its state in mid-flow."""

    name: str
    description: str
    case: dict[str, Any]
    coarser: int


def _slump(name: str, space: str, cell_size: float, material: dict, scheme: dict) -> dict[str, Any]:
    horizontal = {"r": [0, 0.36]} if space == "axisymmetric" else {"x": [-0.36, 0.36], "y": [-0.36, 0.36]}
    return {
        "name": name,
        "space": space,
        "until": 4.0,
        "grid": {
            "cell_size": cell_size,
            "domain": {**horizontal, "z": [0, 0.32]},
            "faces": {"z_min": "slip"},
        },
        "bodies": [
            {
                "shape": CONE,
                "material": material,
                "particles_per_cell": 4 if space == "axisymmetric" else 8,
            }
        ],
        "scheme": scheme,
    }


SCENES = {
    scene.name: scene
    for scene in (
        BenchScene(
            "seed-3d",
            "the paper's cone and scheme, 5 mm",
            _slump("seed-3d", "3d", 0.005, REGULARISED, SEED),
            coarser=4,
        ),
        BenchScene(
            "accurate-3d",
            "the same cone with averaged volumes, exact yield and APIC",
            _slump("accurate-3d", "3d", 0.005, EXACT, ACCURATE),
            coarser=4,
        ),
        BenchScene(
            "accurate-axisymmetric",
            "the same as a body of revolution, 0.5 mm",
            _slump("accurate-axisymmetric", "axisymmetric", 0.0005, EXACT, ACCURATE),
            coarser=20,
        ),
        BenchScene(
            "small-axisymmetric",
            "the same at 10 mm, where the time outside the kernels matters",
            _slump("small-axisymmetric", "axisymmetric", 0.01, EXACT, ACCURATE),
            coarser=1,
        ),
    )
}
