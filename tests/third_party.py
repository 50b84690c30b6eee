"""A third-party distribution with laws, which mpmkit finds until the end of the test."""

import sys
import textwrap

import pytest

from mpmkit.cli import main
from mpmkit.registry import installed

LAW = """
import numpy as np
from mpmkit.contracts import GeneralisedNewtonianLaw, hookimpl, quantity

class Slurry(GeneralisedNewtonianLaw):
    '''mu = tau0 / (γ̇ + γ̇0) + mu_p, a plastic regularised by a shear rate.'''

    name = "slurry"
    api_version = 2
    citation = "nobody, nowhere (2024)"

    yield_stress: float = quantity("Pa", "yield stress", ge=0)
    plastic_viscosity: float = quantity("Pa s", "plastic viscosity", ge=0)
    smallest_rate: float = quantity("1/s", "regularising shear rate", gt=0, default=1.0)

    def apparent_viscosity(self, shear_rate: np.ndarray) -> np.ndarray:
        return self.yield_stress / (shear_rate + self.smallest_rate) + self.plastic_viscosity

@hookimpl
def mpmkit_laws():
    return [Slurry]
"""


@pytest.fixture
def distribution(tmp_path, monkeypatch):
    """Makes a distribution with one entry point a module, found until the test is over."""
    monkeypatch.delenv("MPMKIT_PLUGINS")
    made = []

    def make(name, **sources):
        entries = []
        for entry, source in sources.items():
            module = f"{name.replace('-', '_')}_{entry}"
            made.append(module)
            (tmp_path / f"{module}.py").write_text(textwrap.dedent(source), encoding="utf-8")
            entries.append(f"law.{entry} = {module}")
        info = tmp_path / f"{name.replace('-', '_')}-1.2.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(
            f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.2\n", encoding="utf-8"
        )
        (info / "entry_points.txt").write_text("[mpmkit]\n" + "\n".join(entries) + "\n", encoding="utf-8")

    monkeypatch.syspath_prepend(tmp_path)
    installed.cache_clear()
    yield make
    installed.cache_clear()
    for module in made:
        sys.modules.pop(module, None)


def case(law="slurry", **changes):
    return {
        "space": "plane-strain",
        "until": 0.001,
        "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0.2, 0], "upper": [0.6, 0.4]},
                "material": {
                    "law": law,
                    "density": 2000,
                    "yield_stress": 100,
                    "plastic_viscosity": 50,
                    "sound_speed": {"factor": 10},
                },
            }
        ],
        "scheme": {"time_step": {"ignore": ["viscous"]}},
        "output": {"report": False},
    } | changes


def status(*arguments):
    with pytest.raises(SystemExit) as stop:
        main([str(argument) for argument in arguments])
    return stop.value.code
