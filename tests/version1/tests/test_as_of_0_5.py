"""The tests of the distribution, as of mpmkit 0.5.0."""

import mpmkit_as_of_0_5 as old
import numpy as np
import pytest

import mpmkit
from mpmkit.contracts import Motion
from mpmkit.testing import law_tests, order_checks

OIL = {"law": "old-oil", "density": 1000, "viscosity": 1, "sound_speed": 10}
NEWTONIAN = OIL | {"law": "newtonian"}

test_oil = law_tests(old.OldOil(viscosity=3.0), flow_curve=lambda rate: 3.0 * rate)


@pytest.mark.parametrize("check", order_checks(old.OldUSF()), ids=lambda check: check.name)
def test_order(check):
    if not check.name.endswith(("3d", "axisymmetric")):
        check()


def test_a_law_is_driven_through_its_motion():
    L = np.diag([0.1, 0.2, 0.3])[None]
    stress, state = np.zeros((1, 6)), {"stretch": np.zeros(1)}
    motion = Motion(L, np.ones(1), np.zeros(1), 1000.0, sound_speed=10.0)
    old.OldOil(viscosity=3.0).update_stress(motion, state, 0.5, stress)
    assert stress[0, :3] == pytest.approx([-0.6, 0.0, 0.6])
    assert state["stretch"][0] == pytest.approx(0.3)


def history(material=NEWTONIAN, **scheme):
    case = {
        "space": "plane-strain",
        "until": 0.1,
        "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
        "bodies": [
            {"shape": {"kind": "box", "lower": [0.2, 0.0], "upper": [0.6, 0.4]}, "material": material}
        ],
        "scheme": scheme,
        "output": {"particle_history": ["position", "velocity", "stress", "pressure"]},
    }
    return mpmkit.run(mpmkit.parse_case(case))


@pytest.mark.parametrize(
    ("old", "new"),
    [({"order": "old-usf"}, {"order": "usf"}), ({"velocity": "old-blend"}, {"velocity": "blend"})],
)
def test_an_old_scheme_runs_as_its_twin_to_the_bit(old, new):
    assert history(**old).equals(history(**new))


def test_an_old_treatment_runs_as_its_twin_to_the_bit():
    assert history(volumetric="old-average").equals(history(volumetric="nodal-average"))


def test_an_old_law_runs_as_its_twin():
    found, expected = history(OIL), history()
    for name in ("position", "velocity"):
        np.testing.assert_allclose(found[name], expected[name], rtol=0, atol=1e-12)
