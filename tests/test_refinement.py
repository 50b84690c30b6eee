"""Particles that are split and merged: what is kept, what they become, and that it ends."""

from __future__ import annotations

import numba
import numpy as np
import pytest

import mpmkit
from mpmkit.case import parse_case
from mpmkit.contracts import Refinement, StateVariable
from mpmkit.errors import CaseError, PluginStop
from mpmkit.registry import Registered, Registry, installed
from mpmkit.running.recorder import _by_number
from mpmkit.solver.energies import compressive_energy, kinetic_energy, strain_energy
from mpmkit.solver.ledger import ENERGY
from mpmkit.solver.merging import WIDEST, merge
from mpmkit.solver.simulation import Simulation

DX = 0.1
AXES = {"plane-strain": "xz", "axisymmetric": "rz", "3d": "xyz"}
spaces = pytest.mark.parametrize("space", AXES)
FLUID = {
    "law": "bingham-evp",
    "density": 1000,
    "yield_stress": 5,
    "plastic_viscosity": 5,
    "sound_speed": 20.0,
}
RUBBER = {"law": "neo-hookean", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}


class Aged(installed().of_kind("law")["bingham-evp"]):
    """A Bingham fluid with a state that nothing changes, a number and a vector."""

    name = "aged"
    state = {"age": StateVariable("s", "age"), "dye": StateVariable("1", "dyes", shape=(3,))}


def data(space="plane-strain", refinement="split-and-merge", materials=(FLUID,), cells=4, **scheme):
    """Blocks of four cells, each on the one before, with room around them."""
    axes = AXES[space]
    bodies = []
    for number, material in enumerate(materials):
        lower, upper = [0.3] * len(axes), [0.3 + cells * DX] * len(axes)
        lower[-1], upper[-1] = lower[-1] + number * cells * DX, upper[-1] + number * cells * DX
        shape = {"kind": "box", "lower": lower, "upper": upper}
        if space == "axisymmetric":
            shape = {"kind": "cylinder", "radius": cells * DX, "height": cells * DX, "base": [0, lower[-1]]}
        bodies.append({"shape": shape, "material": material})
    high = 0.6 + len(materials) * cells * DX
    domain = {axis: [0, 0.6 + cells * DX] for axis in axes} | {"z": [0, round(high, 3)]}
    return {
        "space": space,
        "until": 1.0,
        "gravity": [0.0] * len(axes),
        "grid": {"cell_size": DX, "domain": domain},
        "bodies": bodies,
        "scheme": {"refinement": refinement, "redistribution": "none", **scheme},
    }


def scene(*args, **kwargs):
    return Simulation(parse_case(data(*args, **kwargs)))


def aged(space="plane-strain"):
    """A scene of a law with a state, every field of it at random, but for what belongs together."""
    found = [entry for entries in installed().plugins.values() for entry in entries.values()]
    registry = Registry([*found, Registered("law", Aged, "tests", "1", "aged")], [])
    material = FLUID | {"law": "aged"}
    simulation = Simulation(parse_case(data(space, materials=[material]), registry=registry))
    p, rng = simulation.particles, np.random.default_rng(4)
    for array in (p.velocity, p.affine, p.velocity_gradient, p.stress, *p.groups[0].state.values()):
        array[:] = rng.standard_normal(array.shape)
    p.volume_ratio[:] = rng.uniform(0.98, 1.02, len(p))
    p.volume[:] = p.initial_volume * p.volume_ratio
    p.pressure[:] = p.groups[0].pressure(p.volume_ratio)
    p.box *= rng.uniform(0.5, 1.5, p.box.shape)
    return simulation


def some_pairs(p, count=20):
    """Pairs at random, whatever lies between the two."""
    return np.random.default_rng(8).permutation(len(p))[: 2 * count].reshape(count, 2)


def draw_out(simulation, seed, stretch=3.0):
    """Particles in disorder, with boxes that are long along one axis and thin along the others."""
    p, rng = simulation.particles, np.random.default_rng(seed)
    p.position += rng.uniform(-0.5, 0.5, p.position.shape) * DX
    np.clip(p.position, 1e-3, simulation.grid.extent - 1e-3, out=p.position)
    p.box *= stretch ** rng.uniform(-1, 1, p.box.shape)


# --- Merging: what is kept


@spaces
def test_merging_keeps_what_there_is(space):
    p = aged(space).particles
    along = slice(space == "axisymmetric", None)

    def totals():
        state = p.groups[0].state
        areas = p.initial_volume / p.position[:, 0]
        fields = [
            p.velocity,
            p.stress,
            p.velocity_gradient.reshape(-1, 9),
            state["dye"],
            state["age"][:, None],
        ]
        sums = [
            p.mass.sum(),
            p.initial_volume.sum(),
            p.volume.sum(),
            p.portion.sum(),
            p.mass @ p.volume_ratio,
        ]
        rings = [areas.sum()] if space == "axisymmetric" else []
        return np.concatenate([sums, rings, p.mass @ p.position[:, along], *(p.mass @ f for f in fields)])

    before, count = totals(), len(p)
    merge(p, some_pairs(p), DX, space == "axisymmetric")
    assert len(p) == count - 20
    np.testing.assert_allclose(totals(), before, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(p.volume, p.initial_volume * p.volume_ratio, rtol=1e-14)
    assert p.groups[0].part == slice(0, len(p))
    assert {len(array) for array in p.groups[0].state.values()} == {len(p)}


@spaces
def test_merging_makes_no_energy_and_leaves_no_yield_surface(space):
    p = aged(space).particles
    pairs = some_pairs(p)
    stays = np.where(p.number[pairs[:, 0]] < p.number[pairs[:, 1]], pairs[:, 0], pairs[:, 1])
    number = p.number[stays]

    def shear(stress):
        mean = stress[:, :3].mean(axis=1, keepdims=True)
        return np.sqrt(((stress[:, :3] - mean) ** 2).sum(axis=1) / 2 + (stress[:, 3:] ** 2).sum(axis=1))

    energies, largest = (
        (kinetic_energy, strain_energy, compressive_energy),
        shear(p.stress)[pairs].max(axis=1),
    )
    before = [energy(p) for energy in energies]
    merge(p, pairs, DX, space == "axisymmetric")
    assert all(energy(p) < held for energy, held in zip(energies, before, strict=True))
    merged = np.searchsorted(p.number, number)
    assert (shear(p.stress[merged]) <= largest * (1 + 1e-14)).all()


@pytest.mark.parametrize("space", ["plane-strain", "3d"])
def test_merging_keeps_angular_momentum(space):
    """That of two boxes which move as v + C (x - x̄), with the second moment l²/3 of each."""
    p = aged(space).particles
    dim, pairs = p.dim, some_pairs(p, 1)
    moments = np.einsum("pi,ij->pij", p.box**2 / 3, np.eye(dim))
    spin = p.mass[:, None, None] * (
        np.einsum("pi,pj->pij", p.velocity, p.position) + np.einsum("pij,pjk->pik", p.affine, moments)
    )
    m, x = p.mass[pairs[0]], p.position[pairs[0]]
    d = x - m @ x / m.sum()
    whole = np.einsum("k,kij->ij", m, moments[pairs[0]] + np.einsum("ki,kj->kij", d, d))
    expected, number = spin[pairs[0]].sum(axis=0), p.number[pairs[0]].min()
    merge(p, pairs, DX, False)
    one = int(np.flatnonzero(p.number == number)[0])
    found = p.mass[one] * np.outer(p.velocity[one], p.position[one]) + p.affine[one] @ whole
    np.testing.assert_allclose(
        found - found.T, expected - expected.T, rtol=1e-12, atol=1e-12 * abs(found).max()
    )


@spaces
def test_merging_leaves_a_linear_velocity_field_as_it_is(space):
    p = aged(space).particles
    gradient = np.random.default_rng(1).standard_normal((p.dim, p.dim))
    if space == "axisymmetric":  # where the radius of the merged ring is not the mean of the two
        gradient[:, 0] = 0.0
    p.velocity[:], p.affine[:] = 0.7 + p.position @ gradient.T, gradient
    merge(p, some_pairs(p), DX, space == "axisymmetric")
    np.testing.assert_allclose(p.velocity, 0.7 + p.position @ gradient.T, rtol=0, atol=1e-13)
    np.testing.assert_allclose(p.affine, np.broadcast_to(gradient, p.affine.shape), rtol=0, atol=1e-12)


@pytest.mark.parametrize("velocity", ["flip", "pic", "apic"])
def test_a_body_that_moves_as_a_whole_goes_on_in_the_same_way(velocity):
    simulation = scene(velocity=velocity)
    p = simulation.particles
    p.velocity[:] = [0.3, -0.2]
    merge(p, some_pairs(p), DX, False)
    np.testing.assert_array_equal(p.velocity, np.broadcast_to([0.3, -0.2], p.velocity.shape))


def test_two_layers_become_one_of_twice_the_thickness():
    p = scene().particles
    p.position[:2] = [[0.5, 0.52], [0.5, 0.53]]
    p.box[:2] = p.half_size[:2] = [0.03, 0.005]
    merge(p, np.array([[0, 1]]), DX, False)
    np.testing.assert_allclose(p.box[0], [0.03, 0.01], rtol=1e-12)
    np.testing.assert_allclose(p.position[0], [0.5, 0.525], rtol=1e-12)


@spaces
def test_a_merged_box_holds_what_the_two_did_and_is_not_split_again(space):
    p = aged(space).particles
    pairs = some_pairs(p)
    sums, longest = np.prod(p.box, axis=1)[pairs].sum(axis=1), p.box[pairs].max(axis=1)
    number = p.number[pairs].min(axis=1)
    merge(p, pairs, DX, space == "axisymmetric")
    merged = np.searchsorted(p.number, number)
    np.testing.assert_allclose(np.prod(p.box[merged], axis=1), sums, rtol=1e-12)
    assert (p.box[merged] <= np.maximum(longest, WIDEST * DX / 2) * (1 + 1e-12)).all()


def test_merging_undoes_a_split():
    """The two halves of a box are the box again, with all that it had."""
    simulation = scene(velocity="apic")
    p = simulation.particles
    p.velocity[:] = np.random.default_rng(0).standard_normal(p.velocity.shape)
    p.affine[:] = np.random.default_rng(1).standard_normal(p.affine.shape)
    before = {name: array[0].copy() for name, array in p.arrays().items()}
    simulation.refiner.split(np.arange(len(p)) == 0, 0)
    assert len(p) == 65
    merge(p, np.array([[0, 1]]), DX, False)
    for name, array in p.arrays().items():
        np.testing.assert_allclose(array[0], before[name], rtol=1e-12, atol=1e-14, err_msg=name)


def test_no_number_is_given_twice():
    """Neither that of a particle that is there, nor that of one that was merged away."""
    simulation = scene()
    p, gone, last = simulation.particles, set(), 63
    for seed in range(6):
        draw_out(simulation, seed)
        before = set(p.number.tolist())
        simulation.refiner.refine()
        now = set(p.number.tolist())
        assert len(now) == len(p)
        assert not now & gone
        assert all(number > last for number in now - before)
        gone |= before - now
        last = max(last, *now)
    assert gone


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


def test_what_merging_takes_is_booked():
    """The relative motion of merged particles is gone: nothing comes from nowhere, and nothing goes there."""
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
