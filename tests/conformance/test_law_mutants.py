"""The conformance kit finds faults of laws: every mutant fails the check for its fault, with a sentence."""

from __future__ import annotations

import law_mutants
import pytest
import shape_mutants
from sound_laws import Ageing, NeoHooke, Oil, Plastic, Spring

from mpmkit.testing import Violation, law_checks, law_tests, shape_checks

CURVES = {Oil: lambda rate: 5.0 * rate, Plastic: lambda rate: 20.0 + 5.0 * rate}
LAW_MUTANTS = [
    (law_mutants.NormalComponentsOnly, "resists shear"),
    (law_mutants.TwiceTheStress, "flow curve"),
    (law_mutants.TwiceTheFlow, "flow curve"),
    (law_mutants.FlowCurveOff, "flow curve"),
    (law_mutants.WrongSign, "dissipation"),
    (law_mutants.WrongSign, "resists shear"),
    (law_mutants.WrongSignOfOneShear, "resists shear"),
    (law_mutants.WrongSignOfOneShear, "objectivity"),
    (law_mutants.GradientNotTransposed, "resists shear"),
    (law_mutants.ShearStressesInAnotherOrder, "resists shear"),
    (law_mutants.TurnNotTransposed, "turning"),
    (law_mutants.TurnedBackwards, "turning"),
    (law_mutants.NotTurned, "turning"),
    (law_mutants.WholeTensor, "swelling"),
    (law_mutants.SlowWave, "wave speed"),
    (law_mutants.NoWaveSpeed, "wave speed"),
    (law_mutants.ThinnerThanItIs, "largest viscosity"),
    (law_mutants.EnergyOfNothing, "dissipation"),
    (law_mutants.NothingAtRest, "rest"),
    (law_mutants.Overflows, "extreme rates"),
    (law_mutants.KnowsTheOthers, "batch order"),
    (law_mutants.HiddenState, "declared state"),
    (law_mutants.UndeclaredState, "declared state"),
    (law_mutants.ChangesTheKinematics, "leaves the kinematics alone"),
    (law_mutants.RightForLeft, "energy gives the stress"),
    (law_mutants.RightForLeft, "frame indifference"),
    (law_mutants.HalfTheEnergy, "energy gives the stress"),
    (law_mutants.RemarkOfNobody, "remarks"),
    (law_mutants.NoCitation, "descriptor"),
    (law_mutants.NewStress, "writes in place"),
    (law_mutants.NewStress, "resists shear"),
    (law_mutants.ReturnsItsStress, "writes in place"),
    (law_mutants.ReplacesItsState, "writes in place"),
    (law_mutants.ReplacesItsState, "declared state"),
    (Oil, "registered"),
]


def checks_on(law):
    curve = CURVES[Plastic] if isinstance(law, Plastic | law_mutants.FlowCurveOff) else None
    curve = CURVES[Oil] if isinstance(law, Oil) else curve
    return {check.name: check for check in law_checks(law, flow_curve=curve)}


@pytest.mark.parametrize("law", [Oil, Plastic, Spring, Ageing, NeoHooke])
def test_a_correct_law_passes(law):
    checks = checks_on(law())
    assert len(checks) >= 15
    for name, check in checks.items():
        if name != "registered":
            check()


@pytest.mark.parametrize(("law", "name"), LAW_MUTANTS)
def test_a_mutant_of_a_law_fails(law, name):
    with pytest.raises(Violation, match=r"^law 'mutant': ") as caught:
        checks_on(law())[name]()
    assert "\n" not in str(caught.value)


# --- Sentences ----------------------------------------------------------------------------------------------


def test_the_sentence_says_what_where_and_by_how_much():
    with pytest.raises(Violation) as caught:
        checks_on(law_mutants.TwiceTheStress())["flow curve"]()
    assert str(caught.value) == (
        "law 'mutant': steady shear stress at 5 /s is 50 Pa, not 25: off by 25, 2.5e-05 allowed"
    )


@pytest.mark.parametrize(
    ("checks", "name", "sentence"),
    [
        (
            lambda: checks_on(law_mutants.NewStress()),
            "resists shear",
            "law 'mutant': its update_stress left the array 'stress' as it was; it must write into it, as "
            "stress[:] = … does (stress = … only makes another array of that name)",
        ),
        (
            lambda: checks_on(law_mutants.ReturnsItsStress()),
            "flow curve",
            "law 'mutant': its update_stress returned a ndarray; it must write into the array 'stress', as "
            "stress[:] = … does, and return nothing",
        ),
        (
            lambda: checks_on(law_mutants.ReplacesItsState()),
            "declared state",
            "law 'mutant': its update_stress replaced the array of its state 'strain'; it must write into "
            "the one there, as state['strain'][:] = … does",
        ),
        (
            lambda: {check.name: check for check in shape_checks(shape_mutants.NewHoop())},
            "radial expansion",
            "shape 'mutant': its fill_radial left the array 'hoop' as it was; it must write into it, as "
            "hoop[:] = … does (hoop = … only makes another array of that name)",
        ),
    ],
)
def test_an_output_that_is_not_written_is_named(checks, name, sentence):
    """Every check names this fault itself, and not a consequence of it such as a stress of 0 Pa."""
    with pytest.raises(Violation) as caught:
        checks()[name]()
    assert str(caught.value) == sentence


def test_each_property_is_a_test_of_its_own():
    (mark,) = law_tests(Oil(), flow_curve=CURVES[Oil]).pytestmark
    assert mark.name == "parametrize"
    assert len(mark.args[1]) == len(checks_on(Oil()))
