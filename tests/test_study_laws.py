"""Another law for the same material is fitted to the flow curve of the law in the case."""

import copy

import numpy as np
import pytest
from studies import CASE, study

from mpmkit.registry import installed
from mpmkit.rheology.flow_curve import flow_curve
from mpmkit.rheology.refit import RATES, with_law
from mpmkit.study import members_of

BINGHAM = {"law": "bingham", "yield_stress": 50.0, "plastic_viscosity": 20.0, "density": 2000.0}
HERSCHEL_BULKLEY = {"law": "herschel-bulkley", "yield_stress": 50.0, "consistency": 20.0, "flow_index": 0.5}


def made(material, law):
    return with_law(material, law, installed())


def curve(material):
    law = installed().of_kind("law")[material["law"]]
    given = {key: material[key] for key in law.model_fields if key in material}
    return flow_curve(law.model_validate(given), RATES)


@pytest.mark.parametrize("law", ["herschel-bulkley", "herschel-bulkley-evp"])
def test_a_bingham_material_is_herschel_bulkleys_with_an_index_of_one(law):
    material, (remark,) = made(BINGHAM, law)
    assert material["flow_index"] == pytest.approx(1.0, rel=1e-6)
    assert material["consistency"] == pytest.approx(20.0, rel=1e-6)
    assert material["yield_stress"] == 50.0
    assert material["density"] == 2000.0
    assert "plastic_viscosity" not in material
    assert remark.startswith(f"law '{law}' with consistency = 20, flow_index = 1, fitted to the flow curve")


def test_there_and_back_again():
    there, _ = made(BINGHAM, "herschel-bulkley")
    back, _ = made(there, "bingham")
    assert back.pop("law") == "bingham"
    assert back == pytest.approx({key: value for key, value in BINGHAM.items() if key != "law"}, rel=1e-6)


def test_laws_that_share_their_parameters_are_not_fitted():
    assert made(BINGHAM, "bingham-evp") == (BINGHAM | {"law": "bingham-evp"}, [])
    assert made(BINGHAM, "bingham") == (BINGHAM, [])


def test_a_newtonian_material_is_bingham_without_a_yield_stress():
    material, _ = made({"law": "newtonian", "viscosity": 10.0}, "bingham")
    assert material["plastic_viscosity"] == pytest.approx(10.0, rel=1e-6)
    assert material["yield_stress"] < 1e-6


def test_the_fit_is_that_of_least_squares():
    """Linear in the plastic viscosity: the normal equation gives it, and no other is closer."""
    material, _ = made(HERSCHEL_BULKLEY, "bingham")
    rest = curve(HERSCHEL_BULKLEY) - curve(material | {"plastic_viscosity": 0.0})
    assert material["plastic_viscosity"] == pytest.approx(float(rest @ RATES / (RATES @ RATES)), rel=1e-6)


def test_a_law_without_a_flow_curve_is_left_to_the_case():
    assert made(BINGHAM, "neo-hookean")[1] == []
    assert made({"law": "bingham", "yield_stress": "much"}, "newtonian")[1] == []
    assert made(BINGHAM, "no such law") == (BINGHAM | {"law": "no such law"}, [])


def laws(*path_sets):
    case = copy.deepcopy(CASE)
    case["bodies"][0]["material"] |= {"law": "bingham", "yield_stress": 50, "plastic_viscosity": 20}
    del case["bodies"][0]["material"]["viscosity"]
    members = {str(n): {f"bodies.0.material.{k}": v for k, v in s.items()} for n, s in enumerate(path_sets)}
    found = members_of(study(case=case, members=members))
    return [(member.data["bodies"][0]["material"], member.remarks) for member in found]


def test_what_is_changed_along_with_the_law_is_fitted_around():
    full = {"law": "herschel-bulkley", "consistency": 3, "flow_index": 0.7}
    half = {"law": "herschel-bulkley", "flow_index": 0.5}
    stiff = {"law": "herschel-bulkley", "yield_stress": 100}
    given, some, other = laws(full, half, stiff)
    assert (given[0]["consistency"], given[0]["flow_index"], given[0]["yield_stress"]) == (3, 0.7, 50)
    assert given[1] == []
    assert some[0]["flow_index"] == 0.5
    x, target = np.sqrt(RATES), 20 * RATES  # beside the yield stress, which both have
    assert some[0]["consistency"] == pytest.approx(float(x @ target / (x @ x)), rel=1e-4)
    assert "consistency" in some[1][0]
    # The curve is that of the Bingham material with the other yield stress.
    assert other[0]["yield_stress"] == 100
    assert other[0]["consistency"] == pytest.approx(20, rel=1e-6)
    assert other[0]["flow_index"] == pytest.approx(1, rel=1e-6)


def test_the_case_of_the_study_is_left_as_it_is():
    given = study(vary={"bodies.0.material.law": ["newtonian", "bingham"]})
    before = given.model_dump_json()
    first, second = members_of(given)
    assert given.model_dump_json() == before
    assert first.data["bodies"][0]["material"]["viscosity"] == 10
    assert second.data["bodies"][0]["material"]["plastic_viscosity"] == pytest.approx(10)
