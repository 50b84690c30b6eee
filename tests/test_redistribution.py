"""The parts of the redistribution that keeps volume, box and position of sheared particles consistent."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from mpmkit.case import parse_case
from mpmkit.case.forewarnings import forewarnings
from mpmkit.contracts import Redistribution
from mpmkit.errors import PluginFault
from mpmkit.solver.energies import compressive_energy
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
    """Every particle moved by up to a part of its own size, and sorted again."""
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
    simulation.operations.stage.shear, simulation.operations.stage.elapsed = 1.0, 0.3
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
        stage.shear = stage.elapsed = 0.1
        assert stage.redistribute_if_due(simulation.operations.window, simulation.operations.sorting)
        simulation.operations._sort()
    assert spread[-1] < 0.4 * spread[0]
    scale = np.abs(p.mass[:, None] * p.velocity).sum()
    np.testing.assert_allclose(p.mass @ p.velocity, momentum, rtol=0, atol=1e-13 * scale)
    assert p.mass.sum() == mass


def test_particles_in_lines_are_brought_apart():
    """A floor on which material is stretched turns a lattice into columns.

    On the line of a column the gradient of the crowding is zero: a shift along the gradient alone leaves the
    columns as they are.
    """
    simulation = filled("3d", SEAMED)
    p, operations = simulation.particles, simulation.operations
    up, side = p.dim - 1, CELLS * DX
    p.position[:, 0] = (np.floor(p.position[:, 0] / (1.5 * DX)) + 0.5) * 1.5 * DX
    for column in np.unique(p.position[:, :up].round(9), axis=0):
        (those,) = np.nonzero(np.isclose(p.position[:, :up], column).all(axis=1))
        p.position[those, up] = (np.arange(len(those)) + 0.5) / len(those) * side
    p.velocity_gradient[:, 0, 0], p.velocity_gradient[:, up, up] = 1.0, -1.0  # γ̇ = 2 /s
    stage, acting = operations.stage, operations.stage.redistribution

    def unevenness():
        found = []
        redistribute(simulation, lambda ops: found.append(ops.cells().at_particles(ops.cells().filling())))
        stage.redistribution = acting
        return np.abs(found[0] - 1).mean()

    before = None
    for step in range(40):
        operations.sorting.sorts = 0
        operations.begin()
        before = unevenness() if before is None else before
        stage.shear, stage.elapsed = 0.1, 0.05
        simulation.particles.time = 0.05 * step
        stage.redistribute_if_due(operations.window, operations.sorting)
    assert before > 0.1
    assert unevenness() < 0.25 * before


def test_a_scene_that_has_diverged_is_not_the_fault_of_the_redistribution():
    """A volume that is not positive makes everything that follows from it meaningless."""
    simulation = filled("plane-strain")
    p = simulation.particles
    p.volume[3] = p.volume_ratio[3] = -5.0
    stage = simulation.operations.stage
    stage.weigh(np.full(len(p), np.nan))
    p.volume[3] = p.volume_ratio[3] = 1.0
    with pytest.raises(PluginFault, match="gave particle 0 a weight that is not finite"):
        stage.weigh(np.full(len(p), np.nan))


@spaces
def test_the_weighted_volumes_fill_every_full_cell(space):
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


def test_weighted_volumes_fill_each_cell_where_most_boxes_lie_across_two():
    """Rows at 0.27, 1.15, 1.95, ... cells: sheared material lies so at a wall.

    The filling of a cell is then wrong by up to 10 %. One pass of the weights leaves 2 %, three leave 0.3 %.
    """
    simulation = filled("plane-strain", {"plane-strain": {**SEAMED["plane-strain"], "z_max": "stick"}})
    p = simulation.particles
    order = np.argsort(p.position[:, 1], kind="stable")
    rows = np.array([0.27, 1.15, 1.95, 2.7, 3.3, 4.05, 4.85, 5.73]) * DX
    p.position[order, 1] = np.repeat(rows, len(p) // len(rows))
    p.position[order, 0] = np.tile(
        (np.arange(len(p) // len(rows)) + 0.5) / (len(p) // len(rows)) * CELLS * DX, len(rows)
    )
    simulation.operations.sorting.sorts = 0
    simulation.operations.begin()
    p.velocity_gradient[:, 0, 1] = 1e-9  # shear that moves nothing
    stage = simulation.operations.stage
    stage.shear = stage.elapsed = 1.0
    stage.redistribute_if_due(simulation.operations.window, simulation.operations.sorting)
    found = {}

    def probe(ops):
        cells = ops.cells()
        found["before"] = cells.at_particles(np.abs(cells.filling() - 1))
        found["after"] = cells.at_particles(np.abs(cells.filling(p.quadrature) - 1))

    redistribute(simulation, probe)
    assert found["before"].max() > 0.05
    assert found["after"].max() < 0.006


def test_j_tends_to_the_available_volume():
    """With 3 % too much material, ln J falls by 2 ln 1.03 dγ over the shear since the last redistribution,
    and no further. The work of the equation of state on the way is the energy of the redistribution."""
    simulation = filled("plane-strain", SEAMED)
    p = simulation.particles
    simulation.operations.begin()
    p.velocity_gradient[:, 0, 1] = 1.0
    p.volume *= 1.03  # too much of it
    p.volume_ratio *= 1.03
    stage = simulation.operations.stage
    stage.shear = stage.elapsed = 0.5
    stage.redistribute_if_due(simulation.operations.window, simulation.operations.sorting)
    np.testing.assert_allclose(p.volume_ratio, 1.03, rtol=1e-10)
    stage.rate, stage.energy, before = 1.0, 0.0, compressive_energy(p)
    group, still = p.groups[0], np.zeros(len(p))
    for shear in (0.25, 0.5, 1.0):
        for _ in range(250):
            p.pressure[:] = group.pressure(p.volume_ratio)
            stage.stretch(still, 0.001)
        expected = 1.03 * np.exp(-2 * min(shear, 0.5) * np.log(1.03))
        np.testing.assert_allclose(p.volume_ratio, expected, rtol=1e-5)
        np.testing.assert_allclose(p.volume, p.initial_volume * p.volume_ratio, rtol=1e-14)
    assert stage.energy == pytest.approx(compressive_energy(p) - before, rel=0.01)


def test_only_the_flow_carries_material_out_of_an_open_face():
    """Behind an open face a sink removes a particle, or a guard stops the run; a shift must not move one
    there."""
    simulation = filled("plane-strain", {"plane-strain": {"z_min": "stick"}})
    simulation.operations.begin()
    redistribute(simulation, lambda ops: ops.shift(np.full((len(simulation.particles), 2), 0.6 * DX)))
    top = simulation.grid.extent
    assert (simulation.particles.position <= top).all()
    assert (simulation.particles.position.max(axis=0) == top).all()


def test_no_box_is_shifted_across_the_axis():
    """The area V/(2 π r) of a particle on the axis is infinite, and the crowding would be as well."""
    simulation = filled("axisymmetric")
    simulation.operations.begin()
    p = simulation.particles
    before, box = p.position.copy(), p.box.copy()
    p.position[:7, 0] = 0.5 * box[:7, 0]  # already across: these stay
    inwards = np.zeros_like(p.position)
    inwards[:, 0] = -0.3 * DX
    redistribute(simulation, lambda ops: ops.shift(inwards))
    np.testing.assert_array_equal(p.position[:7, 0], 0.5 * box[:7, 0])
    expected = np.maximum(before[7:, 0] - 0.3 * DX, np.minimum(before[7:, 0], box[7:, 0]))
    np.testing.assert_allclose(p.position[7:, 0], expected, rtol=1e-12)
    np.testing.assert_array_equal(inwards[:, 0], -0.3 * DX)


def test_a_solid_keeps_its_places_and_boxes():
    simulation = filled("plane-strain", SEAMED, materials=(FLUID, RUBBER))
    p = disorder(simulation)
    p.velocity_gradient[:, 0, 1] = 1.0
    solid = simulation.particles.groups[1].part
    before = {name: array[solid].copy() for name, array in p.arrays().items()}
    stage = simulation.operations.stage
    stage.shear = stage.elapsed = 0.3
    stage.redistribute_if_due(simulation.operations.window, simulation.operations.sorting)
    for name in ("position", "box", "volume_ratio", "volume", "quadrature"):
        np.testing.assert_array_equal(getattr(p, name)[solid], before[name], err_msg=name)


def test_solids_alone_are_left_as_they_are():
    """Without a fluid, the redistribution changes no bit."""
    velocity = {"amplitude": [0.5, 0.5], "wave_vector": [10.0, 10.0]}
    one, other = (filled("plane-strain", SEAMED, velocity, [RUBBER], kind) for kind in ("even", "none"))
    for _ in range(10):
        one.advance(), other.advance()
    assert np.ptp(one.particles.box) > 0  # they follow the strain
    for name, array in other.particles.arrays().items():
        np.testing.assert_array_equal(one.particles.arrays()[name], array, err_msg=name)


@pytest.mark.parametrize("rule", ["stretch", "volume", "fixed", "strain"])
def test_beside_a_fluid_boxes_of_a_solid_follow_the_rule_of_the_shape_function(rule):
    """And those of the fluid hold its volume, but where the rule is that boxes stay as they are."""
    shape = {"name": "cpgimp", "domain": rule}
    velocity = {"amplitude": [0.5, 0.5], "wave_vector": [10.0, 10.0]}
    simulation = filled("plane-strain", SEAMED, velocity, [FLUID, RUBBER], shape=shape)
    for _ in range(20):
        simulation.advance()
    p = simulation.particles
    fluid, solid = (group.part for group in p.groups)
    if rule == "stretch":
        C = np.einsum("pki,pkj->pij", p.deformation_gradient[solid], p.deformation_gradient[solid])
        values, vectors = np.linalg.eigh(C)
        U = np.einsum("pik,pk,pjk->pij", vectors, np.sqrt(values), vectors)
        expected = p.initial_half_size[solid] * np.stack([U[:, 0, 0], U[:, 1, 1]], axis=1)
    elif rule == "volume":
        expected = p.initial_half_size[solid] * p.volume_ratio[solid, None] ** 0.5
    else:
        expected = np.full(p.half_size[solid].shape, DX / 4) if rule == "fixed" else p.box[solid]
    np.testing.assert_allclose(p.half_size[solid], expected, rtol=1e-10)
    held = np.full(2, DX / 4) if rule == "fixed" else np.sqrt(p.volume[fluid])[:, None] / 2
    np.testing.assert_allclose(
        p.half_size[fluid], np.broadcast_to(held, p.half_size[fluid].shape), rtol=1e-10
    )


def test_a_redistribution_without_equal_boxes_is_due_and_weighs():
    """Shear is added up for it, too, and its weights enter the internal force."""

    class Weighs(Redistribution):
        name = "weighs"
        api_version = 2
        citation = "none"

        def is_due(self, shear):
            return shear > 0.01

        def redistribute(self, ops, time):
            ops.weigh(np.zeros(len(ops.shear_rate())))

    velocity = {"amplitude": [0.5, 0.5], "wave_vector": [10.0, 10.0]}
    case = filled("plane-strain", SEAMED, velocity).case
    case = case.model_copy(update={"scheme": case.scheme.model_copy(update={"redistribution": Weighs()})})
    simulation = Simulation(case)
    while simulation.operations.stage.shear <= 0.01:
        simulation.advance()
    simulation.advance()
    before = simulation.particles.velocity.copy()
    np.testing.assert_array_equal(simulation.particles.quadrature, 0.0)
    simulation.operations.map_to_grid()
    forces = simulation.operations.window.nodes[:, 3:5]  # after mass and two components of the velocity
    np.testing.assert_array_equal(forces, 0.0)
    np.testing.assert_array_equal(simulation.particles.velocity, before)


def test_few_particles_in_three_dimensions_are_a_warning():
    few, flat, rubber = filled("3d"), filled("plane-strain"), filled("3d", materials=(RUBBER,))
    data = few.case.model_dump()
    data["bodies"][0]["particles_per_cell"] = 27
    assert any("bodies.0 has 8 particles per cell" in said for said in forewarnings(few.case))
    for case in (flat.case, rubber.case, parse_case(data)):
        assert not any("particles per cell" in said for said in forewarnings(case))


@pytest.mark.parametrize(
    ("scheme", "sentence"),
    [
        (
            {"splitting": True},
            "scheme.refinement is 'split', but scheme.redistribution 'even' keeps boxes of fluids",
        ),
        (
            {"shape": {"name": "cpgimp", "domain": "stretch"}},
            "'stretch' of scheme.shape 'cpgimp' acts on solids",
        ),
    ],
)
def test_settings_without_effect_give_a_remark(scheme, sentence):
    assert any(sentence in said for said in forewarnings(filled("plane-strain", **scheme).case))
    assert not any(sentence in said for said in forewarnings(filled("plane-strain").case))


@pytest.mark.parametrize("shape", ["linear", {"name": "cpgimp", "domain": "fixed"}])
def test_even_works_with_boxes_that_the_weights_do_not_see(shape):
    """Cells are weighed with the boxes that hold the volume, whatever the weights are made of."""
    velocity = {"amplitude": [0.5, 0.5], "wave_vector": [10.0, 10.0]}
    simulation = filled("plane-strain", SEAMED, velocity, shape=shape, order="musl")
    p = disorder(simulation)
    done = 0
    for _ in range(60):
        before = simulation.operations.stage.elapsed
        simulation.advance()
        done += simulation.operations.stage.elapsed < before
    simulation.check()
    assert done > 0
    np.testing.assert_allclose(p.box, np.sqrt(p.volume)[:, None].repeat(2, axis=1) / 2, rtol=1e-2)
    assert 0.5 <= p.quadrature.min() < p.quadrature.max() <= 2.0


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
