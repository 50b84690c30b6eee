"""Merged particles: their values, and which sums are conserved."""

from __future__ import annotations

import numpy as np
import pytest
from refined import DX, FLUID, data, draw_out, scene, spaces

from mpmkit.case import parse_case
from mpmkit.contracts import StateVariable
from mpmkit.registry import Registered, Registry, installed
from mpmkit.solver.energies import compressive_energy, kinetic_energy, strain_energy
from mpmkit.solver.merging import WIDEST, merge
from mpmkit.solver.simulation import Simulation


class Aged(installed().of_kind("law")["bingham-evp"]):
    """A Bingham fluid with a state that nothing changes, a number and a vector."""

    name = "aged"
    state = {"age": StateVariable("s", "age"), "dye": StateVariable("1", "dyes", shape=(3,))}


def aged(space="plane-strain"):
    """A scene of a law with a state, every field random, except fields that depend on each other."""
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


# --- Merging: what is kept


@spaces
def test_merging_conserves_mass_volume_and_momentum(space):
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
    """New particles get a number that no present or removed particle has had."""
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
