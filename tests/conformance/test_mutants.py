"""The conformance kit finds faults: every mutant of a plug-in fails the check for its fault. Laws have a file
of their own, ``test_law_mutants.py``."""

from __future__ import annotations

import body_force_mutants
import body_shape_mutants
import contact_mutants
import diagnostic_mutants
import equation_of_state_mutants
import initial_field_mutants
import numpy as np
import order_mutants
import particle_field_mutants
import pytest
import redistribution_mutants
import refinement_mutants
import shape_mutants
import sink_mutants
import source_mutants
import surface_mutants
import velocity_mutants
import volumetric_mutants

from mpmkit.registry import installed
from mpmkit.testing import (
    Violation,
    body_force_checks,
    body_shape_checks,
    contact_checks,
    diagnostic_checks,
    equation_of_state_checks,
    initial_field_checks,
    order_checks,
    particle_field_checks,
    redistribution_checks,
    refinement_checks,
    shape_checks,
    sink_checks,
    source_checks,
    surface_checks,
    velocity_checks,
    volumetric_checks,
)

# --- Shape functions ----------------------------------------------------------------------------------------

SHAPE_MUTANTS = [
    (shape_mutants.GradientOffByACell, "gradients"),
    (shape_mutants.GradientOffByACell, "linear reproduction"),
    (shape_mutants.BaseOffByACell, "linear reproduction"),
    (shape_mutants.TwiceTheGradient, "gradients"),
    (shape_mutants.TwiceTheGradient, "radial expansion"),
    (shape_mutants.GradientPerCell, "gradients"),
    (shape_mutants.WeightsSwapped, "linear reproduction"),
    (shape_mutants.WeightsSwapped, "gradients"),
    (shape_mutants.TooLight, "partition of unity"),
    (shape_mutants.TooLight, "radial partition of unity"),
    (shape_mutants.NearestNode, "continuity"),
    (shape_mutants.NearestNode, "gradients"),
    (shape_mutants.SaysItIsSmooth, "continuity"),
    (shape_mutants.FirstAxisOnly, "partition of unity"),
    (shape_mutants.TooFar, "nodes within reach"),
    (shape_mutants.LocalLattice, "batch order"),
    (shape_mutants.LocalLattice, "place in the lattice"),
    (shape_mutants.NoHoop, "radial expansion"),
    (shape_mutants.HoopOfTheCell, "radial expansion"),
    (shape_mutants.HoopOfTheCell, "far from the axis"),
    (shape_mutants.RadialTablesOfNobody, "radial partition of unity"),
    (shape_mutants.WeightByDifference, "barely touched nodes"),
    (shape_mutants.Lopsided, "mirror"),
    (shape_mutants.UnknownDomain, "nodes within reach"),
    (shape_mutants.NewBase, "writes in place"),
    (shape_mutants.NewHoop, "writes in place"),
    (shape_mutants.NewHoop, "radial expansion"),
]


@pytest.mark.parametrize("shape", [shape_mutants.Hats, shape_mutants.Splines])
def test_a_correct_shape_passes(shape):
    for check in shape_checks(shape()):
        if check.name != "registered":
            check()


@pytest.mark.parametrize(("shape", "name"), SHAPE_MUTANTS)
def test_a_mutant_of_a_shape_fails(shape, name):
    checks = {check.name: check for check in shape_checks(shape())}
    with pytest.raises(Violation, match=r"^shape 'mutant': ") as caught:
        checks[name]()
    assert "\n" not in str(caught.value)


# --- Orders -------------------------------------------------------------------------------------------------

ORDER_MUTANTS = [
    (order_mutants.StressBackwards, "energy plane-strain"),
    (order_mutants.TwiceTheStrain, "energy plane-strain"),
    (order_mutants.NoForces, "free fall plane-strain"),
    (order_mutants.NoForces, "energy axisymmetric"),
    (order_mutants.ForcesTwice, "free fall plane-strain"),
    (order_mutants.ForcesTwice, "energy plane-strain"),
    (order_mutants.NoMomentumEquation, "free fall axisymmetric"),
    (order_mutants.NeverStrains, "momentum plane-strain"),
    (order_mutants.NeverStrains, "energy plane-strain"),
    (order_mutants.NeverMoves, "uniform motion plane-strain"),
    (order_mutants.NeverMoves, "uniform motion 3d"),
]


def test_a_correct_order_passes():
    for check in order_checks(order_mutants.Modified()):
        if check.name != "registered":
            check()


@pytest.mark.parametrize(("order", "name"), ORDER_MUTANTS)
def test_a_mutant_of_an_order_fails(order, name):
    checks = {check.name: check for check in order_checks(order())}
    with pytest.raises(Violation, match=r"^order 'mutant': ") as caught, np.errstate(all="ignore"):
        checks[name]()
    assert "\n" not in str(caught.value)


# --- The other kinds ----------------------------------------------------------------------------------------

CHECKS = {
    "velocity": velocity_checks,
    "volumetric": volumetric_checks,
    "redistribution": redistribution_checks,
    "refinement": refinement_checks,
    "equation_of_state": equation_of_state_checks,
    "surface": surface_checks,
    "contact": contact_checks,
    "body_force": body_force_checks,
    "body_shape": body_shape_checks,
    "initial_field": initial_field_checks,
    "sink": sink_checks,
    "source": source_checks,
    "diagnostic": diagnostic_checks,
    "particle_field": particle_field_checks,
}
NEED_PARAMETERS = (
    "surface",
    "contact",
    "body_force",
    "body_shape",
    "initial_field",
    "sink",
    "source",
    "diagnostic",
)
"""Kinds whose plug-ins go through the kit in test files of their own, with parameters."""
OTHER_MUTANTS = [
    ("velocity", velocity_mutants.Amplified, "no energy from nowhere plane-strain"),
    ("velocity", velocity_mutants.Still, "uniform motion plane-strain"),
    ("velocity", velocity_mutants.Still, "free fall 3d"),
    ("velocity", velocity_mutants.TwiceAsFar, "uniform motion axisymmetric"),
    ("velocity", velocity_mutants.Twice, "free fall plane-strain"),
    ("velocity", velocity_mutants.BearsNothing, "acoustic fraction"),
    ("volumetric", volumetric_mutants.ByMass, "constant field plane-strain"),
    ("volumetric", volumetric_mutants.ByMass, "power plane-strain"),
    ("volumetric", volumetric_mutants.Larger, "constant field 3d"),
    ("volumetric", volumetric_mutants.OneSided, "power axisymmetric"),
    ("volumetric", volumetric_mutants.WritesItsInput, "power plane-strain"),
    ("volumetric", volumetric_mutants.WholeNumbers, "constant field plane-strain"),
    ("volumetric", volumetric_mutants.Nothing, "constant field plane-strain"),
    ("volumetric", volumetric_mutants.DrawsApart, "relaxation rate plane-strain"),
    ("redistribution", redistribution_mutants.Attracts, "disorder decays plane-strain"),
    ("redistribution", redistribution_mutants.Settles, "even particles axisymmetric"),
    ("redistribution", redistribution_mutants.NeverRests, "rest plane-strain"),
    ("redistribution", redistribution_mutants.AlwaysDue, "is due"),
    ("redistribution", redistribution_mutants.Perhaps, "is due"),
    ("redistribution", redistribution_mutants.Swells, "even particles 3d"),
    ("redistribution", redistribution_mutants.Heavier, "even particles plane-strain"),
    ("redistribution", redistribution_mutants.ByChance, "repeatable plane-strain"),
    ("redistribution", redistribution_mutants.NoNumber, "disorder decays axisymmetric"),
    ("redistribution", redistribution_mutants.OneTooFew, "mass and momentum plane-strain"),
    ("redistribution", redistribution_mutants.WholeNumbers, "mass and momentum 3d"),
    ("refinement", refinement_mutants.Endless, "ends plane-strain"),
    ("refinement", refinement_mutants.Everything, "as they begin 3d"),
    ("refinement", refinement_mutants.CutsAll, "as they begin axisymmetric"),
    ("refinement", refinement_mutants.ByChance, "repeatable plane-strain"),
    ("refinement", refinement_mutants.OneTooFew, "as they begin plane-strain"),
    ("refinement", refinement_mutants.Rows, "keeps what there is axisymmetric"),
    ("refinement", refinement_mutants.NoSuchAxis, "keeps what there is 3d"),
    ("refinement", refinement_mutants.WithItself, "keeps what there is plane-strain"),
    ("refinement", refinement_mutants.Decimals, "keeps what there is plane-strain"),
    ("refinement", refinement_mutants.Beyond, "keeps what there is plane-strain"),
    ("equation_of_state", equation_of_state_mutants.WrongSign, "resists compression"),
    ("equation_of_state", equation_of_state_mutants.WrongSign, "energy gives the pressure"),
    ("equation_of_state", equation_of_state_mutants.TwiceAsStiff, "sound speed"),
    ("equation_of_state", equation_of_state_mutants.HalfTheEnergy, "energy gives the pressure"),
    ("equation_of_state", equation_of_state_mutants.NegativeEnergy, "natural state"),
    ("equation_of_state", equation_of_state_mutants.Pressed, "natural state"),
    ("equation_of_state", equation_of_state_mutants.WritesItsInput, "arrays"),
    ("equation_of_state", equation_of_state_mutants.OneNumber, "arrays"),
    ("equation_of_state", equation_of_state_mutants.KnowsTheOthers, "batch order"),
    ("surface", surface_mutants.NormalIntoTheWall, "normals plane-strain"),
    ("surface", surface_mutants.NotOfLengthOne, "arrays 3d"),
    ("surface", surface_mutants.Squared, "lipschitz 3d"),
    ("surface", surface_mutants.Squared, "normals plane-strain"),
    ("surface", surface_mutants.HalfTheDistance, "normals axisymmetric"),
    ("surface", surface_mutants.AtRest, "moves as it says 3d"),
    ("surface", surface_mutants.WrongWay, "moves as it says axisymmetric"),
    ("surface", surface_mutants.Slower, "fastest plane-strain"),
    ("surface", surface_mutants.OneNormal, "arrays plane-strain"),
    ("surface", surface_mutants.NoNumber, "arrays axisymmetric"),
    ("surface", surface_mutants.MovesThePoints, "arrays plane-strain"),
    ("surface", surface_mutants.KnowsTheOthers, "batch order 3d"),
    ("surface", surface_mutants.Perhaps, "arrays 3d"),
    ("surface", surface_mutants.Nowhere, "problem"),
    ("surface", surface_mutants.NoSentence, "problem"),
    ("surface", surface_mutants.Paper, "arrays 3d"),
    ("contact", contact_mutants.EveryNode, "arrays"),
    ("contact", contact_mutants.Pulls, "pushes only"),
    ("contact", contact_mutants.Bounces, "energy"),
    ("contact", contact_mutants.Drives, "energy"),
    ("contact", contact_mutants.Downwards, "objectivity"),
    ("contact", contact_mutants.AtRestOnly, "galilei"),
    ("contact", contact_mutants.DividesByTheSlip, "extremes"),
    ("contact", contact_mutants.Replaces, "arrays"),
    ("contact", contact_mutants.Forgets, "arrays"),
    ("contact", contact_mutants.Returns, "arrays"),
    ("contact", contact_mutants.WritesTheWall, "arrays"),
    ("contact", contact_mutants.Touches, "arrays"),
    ("contact", contact_mutants.KnowsTheOthers, "batch order"),
    ("contact", contact_mutants.HiddenMemory, "batch order"),
    ("contact", contact_mutants.NoParity, "declares"),
    ("contact", contact_mutants.Rows, "descriptor"),
    ("body_force", body_force_mutants.Nowhere, "home"),
    ("body_force", body_force_mutants.SaysNothing, "home"),
    ("body_force", body_force_mutants.OneForAll, "arrays plane-strain"),
    ("body_force", body_force_mutants.Infinite, "arrays 3d"),
    ("body_force", body_force_mutants.Moves, "arrays axisymmetric"),
    ("body_force", body_force_mutants.Nothing, "arrays plane-strain"),
    ("body_force", body_force_mutants.KnowsTheOthers, "batch order 3d"),
    ("body_force", body_force_mutants.Varies, "declares plane-strain"),
    ("body_force", body_force_mutants.Drags, "declares 3d"),
    ("body_force", body_force_mutants.Changes, "declares axisymmetric"),
    ("body_force", body_force_mutants.Double, "mean plane-strain"),
    ("body_force", body_force_mutants.Weaker, "largest 3d"),
    ("body_force", body_force_mutants.Restless, "settles plane-strain"),
    ("body_force", body_force_mutants.NoPeriod, "settles 3d"),
    ("body_shape", body_shape_mutants.Nowhere, "home"),
    ("body_shape", body_shape_mutants.SaysNothing, "home"),
    ("body_shape", body_shape_mutants.OneCorner, "home"),
    ("body_shape", body_shape_mutants.UpsideDown, "home"),
    ("body_shape", body_shape_mutants.BehindTheAxis, "home"),
    ("body_shape", body_shape_mutants.LeavesItsBounds, "distances 3d"),
    ("body_shape", body_shape_mutants.Column, "distances plane-strain"),
    ("body_shape", body_shape_mutants.NoNumber, "distances axisymmetric"),
    ("body_shape", body_shape_mutants.Moves, "distances 3d"),
    ("body_shape", body_shape_mutants.KnowsTheOthers, "distances plane-strain"),
    ("body_shape", body_shape_mutants.TwiceAsFar, "never too far 3d"),
    ("body_shape", body_shape_mutants.HalfAsFar, "leads to the surface axisymmetric"),
    ("body_shape", body_shape_mutants.InsideOut, "distances plane-strain"),
    ("body_shape", body_shape_mutants.HoldsTooMuch, "contains 3d"),
    ("body_shape", body_shape_mutants.Heavy, "volume axisymmetric"),
    ("body_shape", body_shape_mutants.LosesAPart, "volume plane-strain"),
    ("initial_field", initial_field_mutants.Nowhere, "home"),
    ("initial_field", initial_field_mutants.SaysNothing, "home"),
    ("initial_field", initial_field_mutants.OneForAll, "arrays"),
    ("initial_field", initial_field_mutants.NoNumber, "arrays"),
    ("initial_field", initial_field_mutants.Moves, "arrays"),
    ("initial_field", initial_field_mutants.KnowsTheOthers, "batch order"),
    ("sink", sink_mutants.Nowhere, "home"),
    ("sink", sink_mutants.SaysNothing, "home"),
    ("sink", sink_mutants.Rows, "takes something plane-strain"),
    ("sink", sink_mutants.Perhaps, "takes something 3d"),
    ("sink", sink_mutants.Nothing, "takes something plane-strain"),
    ("sink", sink_mutants.Everything, "takes something axisymmetric"),
    ("sink", sink_mutants.Lowest, "batch order plane-strain"),
    ("sink", sink_mutants.Pulls, "batch order plane-strain"),
    ("source", source_mutants.Nowhere, "home"),
    ("source", source_mutants.SaysNothing, "home"),
    ("source", source_mutants.NoMouth, "mouth 3d"),
    ("source", source_mutants.Thick, "mouth plane-strain"),
    ("source", source_mutants.Sideways, "mouth axisymmetric"),
    ("source", source_mutants.Unsigned, "mouth 3d"),
    ("source", source_mutants.Sucks, "pushes"),
    ("source", source_mutants.Idle, "pushes"),
    ("source", source_mutants.TooEarly, "pushes"),
    ("source", source_mutants.Endless, "pushes"),
    ("source", source_mutants.EndsFirst, "pushes"),
    ("source", source_mutants.AText, "pushes"),
    ("source", source_mutants.Slower, "fastest"),
    ("source", source_mutants.Runs, "fastest"),
    ("source", source_mutants.Counts, "remembers nothing"),
    ("diagnostic", diagnostic_mutants.Nowhere, "home"),
    ("diagnostic", diagnostic_mutants.SaysNothing, "home"),
    ("diagnostic", diagnostic_mutants.NoUnit, "declares plane-strain"),
    ("diagnostic", diagnostic_mutants.BadName, "declares 3d"),
    ("diagnostic", diagnostic_mutants.Renamed, "numbers plane-strain"),
    ("diagnostic", diagnostic_mutants.AText, "numbers plane-strain"),
    ("diagnostic", diagnostic_mutants.AnArray, "numbers 3d"),
    ("diagnostic", diagnostic_mutants.OverNothing, "numbers plane-strain"),
    ("diagnostic", diagnostic_mutants.StopsIt, "numbers axisymmetric"),
    ("diagnostic", diagnostic_mutants.ByChance, "remembers nothing plane-strain"),
    ("diagnostic", diagnostic_mutants.OfTheFirst, "particle order plane-strain"),
    ("particle_field", particle_field_mutants.NoUnit, "descriptor"),
    ("particle_field", particle_field_mutants.Shapeless, "descriptor"),
    ("particle_field", particle_field_mutants.OnlySome, "arrays plane-strain"),
    ("particle_field", particle_field_mutants.Whole, "arrays 3d"),
    ("particle_field", particle_field_mutants.OneNumber, "arrays axisymmetric"),
    ("particle_field", particle_field_mutants.Infinite, "arrays plane-strain"),
    ("particle_field", particle_field_mutants.Heavier, "arrays plane-strain"),
    ("particle_field", particle_field_mutants.KnowsTheOthers, "each for itself plane-strain"),
]


@pytest.mark.parametrize(
    ("kind", "plugin"),
    [
        ("velocity", velocity_mutants.Undamped),
        ("volumetric", volumetric_mutants.Half),
        ("redistribution", redistribution_mutants.Spread),
        ("refinement", refinement_mutants.Halves),
        ("refinement", refinement_mutants.Joins),
        ("equation_of_state", equation_of_state_mutants.InLogarithm),
        ("surface", surface_mutants.Rising),
        ("contact", contact_mutants.Sticky),
        ("body_force", body_force_mutants.Pulse),
        ("body_shape", body_shape_mutants.Ball),
        ("initial_field", initial_field_mutants.Rising),
        ("sink", sink_mutants.Below),
        ("source", source_mutants.Tap),
        ("diagnostic", diagnostic_mutants.Fastest),
        ("particle_field", particle_field_mutants.Momentum),
    ],
)
def test_a_correct_plugin_of_another_kind_passes(kind, plugin):
    for check in CHECKS[kind](plugin()):
        if check.name != "registered":
            check()


@pytest.mark.parametrize(("kind", "plugin", "name"), OTHER_MUTANTS)
def test_a_mutant_of_another_kind_fails(kind, plugin, name):
    checks = {check.name: check for check in CHECKS[kind](plugin())}
    with pytest.raises(Violation) as caught, np.errstate(all="ignore"):
        checks[name]()
    assert str(caught.value).startswith(f"{kind.replace('_', ' ')} 'mutant': ")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "check",
    [
        pytest.param(check, id=f"{name}: {check.name}")
        for kind, checks in CHECKS.items()
        if kind not in NEED_PARAMETERS
        for name, plugin in installed().of_kind(kind).items()
        for check in checks(plugin())
    ],
)
def test_conformance_of_what_is_registered(check):
    check()
