"""What keeps volume, box and place of sheared particles the same, piece by piece."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from mpmkit.case import parse_case
from mpmkit.solver.simulation import Simulation

DX, CELLS = 0.1, 6
FLUID = {
    "law": "bingham-evp",
    "density": 1000,
    "yield_stress": 5,
    "plastic_viscosity": 5,
    "sound_speed": 20.0,
}
RUBBER = {"law": "neo-hookean", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}
AXES = {"plane-strain": "xz", "3d": "xyz", "axisymmetric": "rz"}
WALLED = {
    space: {f"{a}_{side}": "slip" for a in axes for side in ("min", "max")} for space, axes in AXES.items()
}
WALLED["axisymmetric"].pop("r_min")
SEAMED = {
    "plane-strain": {"x_min": "periodic", "x_max": "periodic", "z_min": "stick", "z_max": "symmetry"},
    "3d": {f"{a}_{side}": "periodic" for a in "xy" for side in ("min", "max")}
    | {"z_min": "slip", "z_max": "stick"},
    "axisymmetric": {"z_min": "periodic", "z_max": "periodic", "r_max": "stick"},
}
spaces = pytest.mark.parametrize("space", AXES)
each_side = pytest.mark.parametrize("faces", [WALLED, SEAMED], ids=["walls", "seams"])


def filled(space, faces=WALLED, velocity=None, materials=(FLUID,), redistribution="even", **scheme):
    """A domain that is full from wall to wall, of one material or of layers."""
    axes = AXES[space]
    side = CELLS * DX
    layers = np.linspace(0, side, len(materials) + 1)
    flat = len(axes) - 1
    bodies = [
        {
            "shape": {"kind": "box", "lower": [0.0] * flat + [low], "upper": [side] * flat + [high]},
            "material": material,
            **({} if velocity is None else {"velocity": velocity}),
        }
        for low, high, material in zip(layers[:-1], layers[1:], materials, strict=True)
    ]
    return Simulation(
        parse_case(
            {
                "space": space,
                "until": 1.0,
                "gravity": [0.0] * len(axes),
                "grid": {"cell_size": DX, "domain": {a: [0, side] for a in axes}, "faces": faces[space]},
                "bodies": bodies,
                "scheme": {"redistribution": redistribution, **scheme},
            }
        )
    )


def disorder(simulation, amount=0.2, seed=3):
    """Every particle moved by up to a part of its own size; sorted anew."""
    p, rng = simulation.particles, np.random.default_rng(seed)
    p.position += rng.uniform(-amount, amount, p.position.shape) * 2 * p.box
    np.clip(p.position, 1e-6, CELLS * DX - 1e-6, out=p.position)
    simulation.operations.sorting.sorts = 0
    simulation.operations.begin()
    return p


def redistribute(simulation, probe):
    """Call ``probe`` with the stage where a redistribution would be called, in this step."""
    operations = simulation.operations
    stage = operations.stage

    class Probe:
        equal_boxes = True

        def is_due(self, shear):
            return True

        def redistribute(self, ops, time):
            probe(ops)

    stage.redistribution = Probe()
    stage.redistribute_if_due(operations.window, operations.sorting)


@spaces
@each_side
def test_a_domain_that_is_full_is_neither_crowded_nor_empty_anywhere(space, faces):
    simulation = filled(space, faces)
    simulation.operations.begin()
    found = {}

    def probe(ops):
        for name in ("nodes", "places"):
            lattice = getattr(ops, name)
            crowding = lattice.crowding()
            inside = crowding > 0
            found[name] = crowding[inside]
            np.testing.assert_allclose(lattice.at_particles(crowding), 1.0, rtol=1e-12)
            np.testing.assert_allclose(lattice.slope_at_particles(crowding) * DX, 0.0, atol=1e-10)
        cells = ops.cells()
        np.testing.assert_allclose(cells.at_particles(cells.filling()), 1.0, rtol=1e-12)

    redistribute(simulation, probe)
    for crowding in found.values():
        np.testing.assert_allclose(crowding, 1.0, rtol=1e-12)


@spaces
def test_even_particles_stay_where_they_are(space):
    simulation = filled(space, SEAMED)
    p = simulation.particles
    simulation.operations.begin()
    p.velocity_gradient[:, 0, 1] = 3.0
    before = {name: array.copy() for name, array in p.arrays().items()}
    simulation.operations.stage.shear, simulation.operations.stage.time = 1.0, 0.3
    simulation.operations.stage.redistribute_if_due(
        simulation.operations.window, simulation.operations.sorting
    )
    np.testing.assert_allclose(p.position, before["position"], atol=1e-12)
    np.testing.assert_allclose(p.volume_ratio, 1.0, rtol=1e-12)
    np.testing.assert_allclose(p.quadrature, 1.0, rtol=1e-12)


@spaces
def test_nothing_happens_at_rest_and_as_a_body_moves_as_a_whole(space):
    """No shear, no redistribution: the same bits as if there were none."""
    velocity = [0.0] * (len(AXES[space]) - 1) + [0.3]
    open_faces = {name: {} for name in AXES}
    one, other = (filled(space, open_faces, velocity, redistribution=kind) for kind in ("even", "none"))
    for _ in range(10):
        one.advance(), other.advance()
    assert one.operations.stage.shear < 1e-9
    np.testing.assert_allclose(one.particles.position, other.particles.position, rtol=1e-12)


@spaces
@each_side
def test_disorder_decays_and_momentum_and_mass_are_kept(space, faces):
    simulation = filled(space, faces)
    p = disorder(simulation)
    p.velocity[:] = np.random.default_rng(1).normal(size=p.velocity.shape)
    p.affine[:] = np.random.default_rng(2).normal(size=p.affine.shape)
    p.velocity_gradient[:, 0, 1] = 1.0
    momentum, mass = p.mass @ p.velocity, p.mass.sum()
    stage, spread = simulation.operations.stage, []
    for _ in range(12):
        even = stage.redistribution
        redistribute(
            simulation,
            lambda ops: spread.append(np.std(ops.places.at_particles(ops.places.crowding()))),
        )
        stage.redistribution = even
        stage.shear = stage.time = 0.1
        assert stage.redistribute_if_due(simulation.operations.window, simulation.operations.sorting)
        simulation.operations._sort()
    assert spread[-1] < 0.4 * spread[0]
    scale = np.abs(p.mass[:, None] * p.velocity).sum()
    np.testing.assert_allclose(p.mass @ p.velocity, momentum, rtol=0, atol=1e-13 * scale)
    assert p.mass.sum() == mass


@spaces
def test_every_full_cell_weighs_what_it_is(space):
    """Σ_p V_p w_p is the volume of the cells, however the particles lie in them."""
    simulation = filled(space, SEAMED)
    p = disorder(simulation, 0.1)
    found = {}

    def probe(ops):
        cells = ops.cells()
        found["weights"] = cells.at_particles(1 / np.maximum(cells.filling(), 0.1))

    redistribute(simulation, probe)
    size = p.volume / (2 * np.pi * p.position[:, 0]) if space == "axisymmetric" else p.volume
    assert size @ found["weights"] == pytest.approx((CELLS * DX) ** len(AXES[space]), rel=1e-12)


def test_material_comes_to_fill_the_room_there_is():
    """Particles that lie too close are drawn apart by J, those that lie too far together."""
    simulation = filled("plane-strain", SEAMED)
    p = simulation.particles
    simulation.operations.begin()
    p.velocity_gradient[:, 0, 1] = 1.0
    p.volume *= 1.03  # too much of it
    p.volume_ratio *= 1.03
    stage = simulation.operations.stage
    stage.shear = stage.time = 0.5
    stage.redistribute_if_due(simulation.operations.window, simulation.operations.sorting)
    np.testing.assert_allclose(p.volume_ratio, 1.03 * np.exp(-0.5 * np.log(1.03)), rtol=1e-10)


def test_a_solid_keeps_its_places_and_boxes():
    simulation = filled("plane-strain", SEAMED, materials=(FLUID, RUBBER))
    p = disorder(simulation)
    p.velocity_gradient[:, 0, 1] = 1.0
    solid = simulation.particles.groups[1].part
    before = {name: array[solid].copy() for name, array in p.arrays().items()}
    stage = simulation.operations.stage
    stage.shear = stage.time = 0.3
    stage.redistribute_if_due(simulation.operations.window, simulation.operations.sorting)
    for name in ("position", "box", "volume_ratio", "volume", "quadrature"):
        np.testing.assert_array_equal(getattr(p, name)[solid], before[name], err_msg=name)


@spaces
def test_bits_do_not_depend_on_threads(space):
    found = []
    for threads in (1, 2):
        numba.set_num_threads(threads)
        each = len(AXES[space])
        wave = {"amplitude": [0.5] * each, "wave_vector": [10.0] * each}
        simulation = filled(space, SEAMED, velocity=wave)
        disorder(simulation)
        for _ in range(60):
            simulation.advance()
        assert simulation.operations.stage.shear < 1.0
        found.append(simulation.particles.position.tobytes())
    assert found[0] == found[1]
