"""The sentence for a case, or a part of one, that is refused."""

import copy

import pytest

from mpmkit.errors import CaseError

GOOD = {
    "space": "plane-strain",
    "until": 0.1,
    "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
    "bodies": [
        {
            "shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]},
            "material": {
                "law": "bingham",
                "density": 2000,
                "yield_stress": 100,
                "plastic_viscosity": 50,
                "sound_speed": {"factor": 10},
            },
        }
    ],
    "scheme": {"shape": "cpgimp", "time_step": {"fraction": 0.3, "ignore": ["viscous"]}},
}
MATERIAL, SHAPE = "bodies.0.material", "bodies.0.shape"
ABSENT = object()
PYDANTICS = (
    "Input should",
    "valid",
    "Extra inputs",
    "Field required",
    "tag",
    "pydantic",
    "Literal",
    "Traceback",
)


def changed(path, value):
    data = copy.deepcopy(GOOD)
    here = data
    *above, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    for key in above:
        here = here.setdefault(key, {}) if isinstance(here, dict) else here[key]
    if value is ABSENT:
        del here[last]
    else:
        here[last] = value
    return data


def sentence(action, *arguments, **options):
    with pytest.raises(CaseError) as refused:
        action(*arguments, **options)
    text = str(refused.value)
    assert "\n" not in text
    assert not any(word in text.replace("not valid JSON", "").replace("shape", "") for word in PYDANTICS), (
        text
    )
    return text
