"""Parameters at the top of a case: values of formulas, and the sentences about wrong ones."""

import copy
import json

import pytest

from mpmkit.case import case_schema, parse_case
from mpmkit.case.formula import LONGEST, evaluate, parse
from mpmkit.case.overrides import apply_overrides
from mpmkit.case.parameters import expand, fine
from mpmkit.case.schema import FORMULA
from mpmkit.errors import CaseError
from mpmkit.registry import installed
from mpmkit.study import members_of
from mpmkit.study.model import Study

NEW = '{"value": 1, "unit": "s", "description": "x"}'
WATER = {"law": "newtonian", "density": 1000, "viscosity": 1, "sound_speed": 10}


def case(**more):
    return {
        "parameters": {
            "cell": {"value": 0.01, "unit": "m", "description": "side of a cell", "above": 0, "fine": 0.005},
            "width": {"value": "= 4 * cell", "unit": "m", "description": "width", "at_most": "= deep"},
            "deep": {"value": 0.1, "unit": "m", "description": "depth"},
        },
        "space": "plane-strain",
        "until": 1,
        "grid": {"cell_size": "= cell", "domain": {"x": [0, 0.2], "z": [0, "= 2 * deep"]}},
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0, 0], "upper": ["= width", "= deep"]},
                "material": copy.deepcopy(WATER),
            }
        ],
    } | more


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("1 + 2 * 3 - 4 / 8", 6.5),
        ("-(a - 2) * b", 5.0 * -1 * -1 * (2 - 1)),
        ("max(a, b, 2)", 5.0),
        ("cbrt(27)", 3.0),
        ("cbrt(-8)", -2.0),
        ("min(a, b)", 1.0),
        ("ceil(0.3 / 0.01)", 30.0),  # in binary 0.3 / 0.01 is above 30 by a rounding
        ("ceil(2.1)", 3.0),
        ("sqrt(b + 4) * sin(radians(90))", 3.0),
    ],
)
def test_a_formula_is_arithmetic(formula, value):
    assert evaluate(parse(formula), {"a": 1.0, "b": 5.0}) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("formula", "words"),
    [
        ("a / (a - 1)", "it divides by zero"),
        ("radiu", "there is no 'radiu'; did you mean 'radius'?"),
        ("2 ** 1000", "'2 ** 1000' is not allowed in a formula"),
        ("().__class__", "is not allowed in a formula"),
        ("__import__('os')", "there is no function '__import__'"),
        ("max(a)", "max takes two or more numbers"),
        ("min('a', 'b')", "a number is needed, and not a name in quotes"),
        ("sqrt(-1)", "-1 has no square root"),
        ("1e300 * 1e300", "it is too large for a number"),
        ("a if a else 2", "is not allowed in a formula"),
        ("a +", "this is not a formula"),
        ("a" * (LONGEST + 1), f"at most {LONGEST} characters"),
        ("True", "is not allowed in a formula"),
    ],
)
def test_what_is_no_arithmetic_is_refused(formula, words):
    with pytest.raises(ValueError, match=r"\w") as refused:
        evaluate(parse(formula), {"a": 1.0, "radius": 2.0})
    assert words in str(refused.value)


def test_the_rest_of_the_case_follows_its_parameters():
    found = parse_case(case(), ["parameters.cell=0.02"])
    assert found.grid.cell_size == 0.02
    assert found.bodies[0].shape.upper == [0.08, 0.1]
    assert found == parse_case(expand(apply_overrides(case(), ["parameters.cell=0.02"])))


def test_a_limit_is_met_by_what_differs_from_it_by_a_rounding():
    data = case()
    data["parameters"]["deep"] |= {"value": 0.0375, "at_least": "= 3 * 0.0125 * cell / cell"}
    data["parameters"]["cell"]["value"] = 0.005
    data["grid"]["domain"]["z"] = [0, 0.2]
    assert parse_case(data).bodies[0].shape.upper[1] == 0.0375


def test_the_fine_variant_has_its_own_values():
    assert parse_case(fine(case())).bodies[0].shape.upper == [0.02, 0.1]


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("parameters.deep=0.03", "parameters.width (width) is 0.04 m; it must be at most 0.03 m, which is"),
        ("parameters.cell=0", "parameters.cell (side of a cell) is 0 m; it must be above 0 m"),
        ("parameters.cell=coarse", 'parameters.cell.value is "coarse"; it must be a number'),
        ("parameters.deeep=1", "parameters.deeep is 1; it must be an object"),
        (f"parameters.time={NEW}", "the name of a variable of the history"),
        ("parameters.new={\"value\":1}", "parameters.new.unit is missing"),
        ("parameters.cell.least=1", "parameters.cell has an unknown key 'least'"),
        ("until== long", "until is \"= long\": there is no 'long'"),
        ("until== deep / 0", "it divides by zero"),
        ("parameters.width.value== cell + later", "there is no 'later'"),
    ],
)  # fmt: skip
def test_a_sentence_says_what_is_wrong_with_a_parameter(override, words):
    with pytest.raises(CaseError) as refused:
        parse_case(case(), [override])
    assert words in str(refused.value)


def test_a_parameter_that_would_change_nothing_is_refused():
    data = case()
    data["parameters"]["new"] = {"value": 1, "unit": "s", "description": "x"}
    with pytest.raises(CaseError, match=r"parameters\.new is used by no formula"):
        parse_case(data)


def test_a_place_that_a_parameter_stands_at_can_be_set_itself():
    assert parse_case(case(), ["grid.domain.z=[0, 0.3]", "until=3"]).grid.domain["z"] == [0, 0.3]
    assert parse_case(case(), ["bodies.0.shape.upper=[0.05, 0.05]"]).bodies[0].shape.upper == [0.05, 0.05]


def test_a_formula_without_parameters_is_refused():
    data = case(until="= 2 * time")
    del data["parameters"]
    with pytest.raises(CaseError, match=r"until is the formula .= 2 \* time., but the case has no"):
        parse_case(data)


def test_a_study_varies_a_parameter_and_makes_a_law_of_its_numbers():
    study = Study.model_validate(
        {"name": "s", "case": case(), "vary": {"parameters.deep": [0.05, 0.1], "until": [1, 2]}}
    )
    members = members_of(study)
    assert [member.case.bodies[0].shape.upper[1] for member in members] == [0.05, 0.05, 0.1, 0.1]
    assert [member.case.until for member in members] == [1, 2, 1, 2]


def test_the_schema_allows_parameters_and_formulas():
    schema = case_schema(installed())
    assert schema["properties"]["parameters"]["type"] == "object"
    size = schema["$defs"]["Grid"]["properties"]["cell_size"]
    assert size["anyOf"] == [{"exclusiveMinimum": 0, "type": "number"}, FORMULA]
    assert FORMULA["type"] == "string"
    assert "exclusiveMinimum" not in size
    json.dumps(schema)
