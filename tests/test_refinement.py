"""Splitting and merging: bounded numbers of particles, conserved sums, and the keys of a case."""

from __future__ import annotations

import numba
import numpy as np
import pytest
from refined import DX, FLUID, data, draw_out, scene, spaces

import mpmkit
from mpmkit.case import parse_case
from mpmkit.contracts import Refinement
from mpmkit.errors import CaseError, PluginStop
from mpmkit.running.recorder import _by_number
from mpmkit.solver.energies import kinetic_energy
from mpmkit.solver.ledger import ENERGY
from mpmkit.solver.simulation import Simulation

RUBBER = {"law": "neo-hookean", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}


# --- That it ends


@spaces
@pytest.mark.parametrize("refinement", ["split", "split-and-merge"])
def test_the_number_of_particles_is_bounded_whatever_the_flow(refinement, space):
    """By splitting eight times as many, and two full cells for each cell; with merging twice, and one."""
    simulation = scene(space, refinement)
    p = simulation.particles
    begun, most, most_cells = len(p), 0, 0
    for seed in range(15):
        draw_out(simulation, seed)
        simulation.refiner.refine()
        most = max(most, len(p))
        cells = len(np.unique(np.floor(p.position / DX), axis=0))
        if refinement == "split":
            most_cells = max(most_cells, cells)
            assert len(p) <= 8 * begun + 2 * 2**p.dim * most_cells
        else:
            assert len(p) <= 2 * begun + 2**p.dim * cells
        assert p.portion.sum() == pytest.approx(begun, rel=1e-12)
    assert most > 1.2 * begun


def test_a_small_box_is_cut_to_a_cell_where_others_fill_the_room():
    simulation = scene(refinement="split")
    p = simulation.particles
    inner = int(np.argmin(np.abs(p.position - 0.525).sum(axis=1)))
    p.portion[inner], p.box[inner, 0] = 0.2, 1.1 * DX
    simulation.refiner.refine()
    assert len(p) == 64
    assert p.box[inner, 0] == pytest.approx(DX / 2)
    assert simulation.measures.fractured(p) == 0


@pytest.mark.parametrize("refinement", ["split", "split-and-merge"])
def test_a_thread_that_is_drawn_out_fortyfold_does_not_tear(refinement):
    """No cell along it is without a particle, and there are no more than its cells need."""
    case = data(refinement=refinement)
    case["grid"]["domain"]["x"] = [0, 40]
    simulation = Simulation(parse_case(case))
    p = simulation.particles
    for _ in range(39):
        p.position[:] *= [1.1, 1 / 1.1]
        p.box[:] *= [1.1, 1 / 1.1]
        simulation.refiner.refine()
    cells = np.unique(np.floor(p.position[:, 0] / DX).astype(int))
    assert len(cells) > 160
    np.testing.assert_array_equal(np.diff(cells), 1)
    assert len(p) <= (8 * 64 + 8 * len(cells) if refinement == "split" else 2 * 64 + 4 * len(cells))
    assert refinement == "split" or simulation.measures.fractured(p) == 0


def test_only_crowded_cells_are_merged_and_only_down_to_what_a_full_one_has():
    simulation = scene()
    p = simulation.particles
    p.portion[:] = 0.25
    p.position[:6] = [0.35, 0.35] + 0.01 * np.array([[0, 0], [1, 0], [0, 3], [1, 3], [4, 4], [4, 1]])
    others = np.flatnonzero((np.floor(p.position[6:] / DX) == 3).all(axis=1)) + 6
    p.position[others] += DX * np.array([-2.0, 0.0])
    simulation.refiner.refine()
    assert len(p) == 62  # of six in a cell, four are left: the nearest two pairs are one each
    inside = (np.floor(p.position / DX) == 3).all(axis=1)
    assert sorted(p.portion[inside]) == [0.25, 0.25, 0.5, 0.5]


@pytest.mark.parametrize("materials", [(RUBBER,), (FLUID, FLUID | {"density": 1200})])
def test_solids_and_other_materials_are_not_merged(materials):
    simulation = scene(materials=materials)
    p = simulation.particles
    p.portion[:] = 0.25
    half = len(p) // 2
    p.position[:] = np.random.default_rng(0).uniform(0.31, 0.39, p.position.shape)
    simulation.refiner.refine()
    if len(materials) == 1:
        assert len(p) == 2 * half
    else:
        for group in p.groups:  # no two fit into one any more
            assert np.sort(p.portion[group.part])[:2].sum() > 1
            assert p.portion[group.part].sum() == half / 4
        assert {tuple(np.unique(p.body[g.part])) for g in p.groups} == {(0,), (1,)}
        for group in p.groups:
            np.testing.assert_allclose(
                p.mass[group.part], group.density * p.initial_volume[group.part], rtol=1e-13
            )


def test_energy_lost_by_merging_is_in_the_ledger():
    """The lost relative motion of merged particles is in the ledger; no other energy appears or vanishes."""
    simulation = scene()
    p = simulation.particles
    simulation.prepare()
    rng = np.random.default_rng(2)
    p.portion[:] = 0.5
    p.position[:, 0] = 0.3 + 0.5 * (p.position[:, 0] - 0.3)
    p.velocity[:] = rng.standard_normal(p.velocity.shape)
    simulation.guards.balance.update(p, simulation.account()[:, ENERGY])
    created, held = simulation.guards.balance.created, kinetic_energy(p)
    simulation._refine()
    assert kinetic_energy(p) < 0.99 * held
    simulation.guards.balance.update(p, simulation.account()[:, ENERGY])
    assert simulation.guards.balance.created == pytest.approx(created, abs=1e-9 * held)


# --- In a run


def flowing(**scheme):
    """A column that falls apart on a floor, with many splits and mergers."""
    case = data(materials=[FLUID | {"yield_stress": 5, "plastic_viscosity": 30}], **scheme)
    case["gravity"] = None
    case["grid"]["faces"] = {"z_min": "slip", "z_max": "slip", "x_min": "slip", "x_max": "slip"}
    case["bodies"][0]["shape"] |= {"lower": [0.0, 0.0], "upper": [0.4, 0.8]}
    return parse_case(case)


def test_bits_do_not_depend_on_threads_nor_on_a_stop_half_way():
    found = []
    for threads in (1, 2):
        numba.set_num_threads(threads)
        simulation = Simulation(flowing())
        while simulation.time < 0.35:
            simulation.advance()
        if threads == 2:
            again = Simulation(flowing())
            again.restore({name: array.copy() for name, array in simulation.state().items()})
            simulation = again
        while simulation.time < 0.6:
            simulation.advance()
        found.append(simulation)
    one, other = found
    assert one.particles.numbers_given > 300  # of 128 at the start
    assert len(one.particles) < one.particles.numbers_given  # and some are gone
    for name, array in one.particles.arrays().items():
        np.testing.assert_array_equal(other.particles.arrays()[name], array, err_msg=name)


def test_a_history_has_a_row_for_every_number():
    field = _by_number(np.array([[3.0], [0.5], [1.0]]), np.array([3, 0, 1]))
    np.testing.assert_array_equal(field, [[0.5], [1.0], [np.nan], [3.0]])


def test_a_run_with_merging_keeps_particle_histories(tmp_path):
    case = flowing().model_copy(update={"until": 0.6})
    case = case.model_copy(
        update={"output": case.output.model_copy(update={"particle_history": ["position"]})}
    )
    history = mpmkit.run(case)
    last = history.position.values[-1]
    assert np.isnan(last).any()
    assert np.isfinite(history.position.values[0, :128]).all()
    assert not np.isfinite(history.position.values[0, 128:]).any()


# --- What a case says


@pytest.mark.parametrize(
    ("scheme", "name"),
    [
        ({}, "none"),
        ({"splitting": False}, "none"),
        ({"splitting": True}, "split"),
        ({"refinement": "split"}, "split"),
        ({"refinement": {"name": "split-and-merge"}}, "split-and-merge"),
        ({"refinement": "split-and-merge", "splitting": True}, "split-and-merge"),
        ({"refinement": "none", "splitting": False}, "none"),
    ],
)
def test_splitting_is_short_for_a_refinement(scheme, name):
    case = data()
    case["scheme"] = scheme
    found = parse_case(case)
    assert found.scheme.refinement.name == name
    assert found.scheme.splitting == (name != "none")
    assert parse_case(found.model_dump(mode="json")) == found


@pytest.mark.parametrize(("splitting", "refinement"), [(True, "none"), (False, "split-and-merge")])
def test_what_contradicts_itself_is_refused(splitting, refinement):
    case = data()
    case["scheme"] = {"splitting": splitting, "refinement": refinement}
    with pytest.raises(CaseError) as caught:
        parse_case(case)
    assert str(caught.value) == (
        f"case: scheme: splitting is {str(splitting).lower()} and refinement is '{refinement}', which "
        "contradict each other; leave out splitting"
    )


@pytest.mark.parametrize(
    ("use", "reason"),
    [
        (
            lambda ops: ops.split(np.ones(3, dtype=bool), 0),
            "chose particles by an array of shape (3,); it must",
        ),
        (
            lambda ops: ops.split(np.ones(64), 0),
            "an array of shape (64,) of float64; it must be an array of True",
        ),
        (lambda ops: ops.cut(None, 0), "chose particles by nothing"),
        (lambda ops: ops.split(np.ones(64, dtype=bool), 2), "asked for axis 2; it must be 0 to 1"),
        (lambda ops: ops.split(np.ones(64, dtype=bool), "x"), "asked for axis 'x'"),
        (
            lambda ops: ops.merge([[0, 1]]),
            "gave a list as pairs to merge; it must be an array of shape (m, 2)",
        ),
        (lambda ops: ops.merge(np.array([[0.0, 1.0]])), "of float64 as pairs to merge"),
        (lambda ops: ops.merge(np.array([[0, 64]])), "gave row 64 in a pair to merge; rows are 0 to 63"),
        (lambda ops: ops.merge(np.array([[0, 1], [1, 2]])), "gave particle 1 twice in pairs to merge"),
    ],
)
def test_what_a_refinement_cannot_hand_in(use, reason):
    class Bad(Refinement):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def refine(self, ops):
            use(ops)

    with pytest.raises(PluginStop) as caught:
        with_refinement(scene(), Bad())._refine()
    assert "'of-the-tests'" in str(caught.value)
    assert reason in str(caught.value)


def with_refinement(simulation, author):
    case = simulation.case
    scheme = case.scheme.model_copy(update={"refinement": author})
    return Simulation(case.model_copy(update={"scheme": scheme}))


def test_two_bodies_and_solids_are_refused_as_pairs():
    class Pairs(Refinement):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def refine(self, ops):
            ops.merge(np.array([[0, len(ops.count()) - 1]]))

    for materials, reason in [
        ((FLUID, FLUID), "gave particles 0 and 127 as a pair to merge; they are of two bodies"),
        (
            (RUBBER,),
            "gave particle 0 in a pair to merge; its law 'neo-hookean' is of a material whose particles",
        ),
    ]:
        simulation = with_refinement(scene(materials=materials), Pairs())
        with pytest.raises(PluginStop, match=reason.replace("(", r"\(")):
            simulation._refine()
