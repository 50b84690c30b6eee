"""A simulation of a scene, apart from the physics: groups, symmetry, guards, general mappings."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import psutil
import pytest

import mpmkit
from mpmkit.contracts import ConstitutiveLaw, Kinematics, StateVariable, hookimpl, quantity
from mpmkit.errors import CaseError, GuardStop
from mpmkit.registry import Registered, Registry, installed

FLUID = {"law": "newtonian", "density": 1000.0, "viscosity": 1.0, "sound_speed": 10.0}
RUBBER = {"law": "neo-hookean", "density": 1000.0, "youngs_modulus": 1e5, "poisson_ratio": 0.3}


class Hypoelastic(ConstitutiveLaw):
    """σ̇ = K tr(L) I: pressure of its own, from a state of its own, and no deformation gradient."""

    name = "hypoelastic"
    api_version = 2
    citation = "a test"
    uses_equation_of_state = False
    state = {"mean_stress": StateVariable("Pa", "mean stress")}

    bulk_modulus: float = quantity("Pa", "bulk modulus K", gt=0)

    def update_stress(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], dt: float, stress: np.ndarray
    ) -> None:
        state["mean_stress"] += (
            dt * self.bulk_modulus * np.trace(kinematics.velocity_gradient, axis1=1, axis2=2)
        )
        stress[:, :3] = state["mean_stress"][:, None]

    def wave_speed(self, density: float, sound_speed: float | None) -> float:
        return float(np.sqrt(self.bulk_modulus / density))


@hookimpl
def mpmkit_laws():
    return [Hypoelastic]


def with_hypoelastic() -> Registry:
    built_in = [entry for kind in installed().plugins.values() for entry in kind.values()]
    return Registry([*built_in, Registered("law", Hypoelastic, "test", "0", "hypoelastic")], [])


def box(lower, upper, material=FLUID, **more):
    return {"shape": {"kind": "box", "lower": lower, "upper": upper}, "material": material, **more}


def scene(
    bodies, faces=None, domain=None, registry=None, cell=0.1, gravity=0.0, **scheme
) -> mpmkit.Simulation:
    case = {
        "space": "plane-strain",
        "until": 1.0,
        "gravity": [0.0, gravity],
        "grid": {
            "cell_size": cell,
            "domain": domain or {"x": [0, 2], "z": [0, 2]},
            "faces": faces or {},
        },
        "bodies": bodies,
        "scheme": scheme,
    }
    return mpmkit.Simulation(mpmkit.parse_case(case, registry=registry))


def test_law_with_its_own_pressure_needs_no_deformation_gradient():
    """The material is compressed between walls; its stress comes from the state of each particle."""
    material = {"law": "hypoelastic", "density": 1000.0, "bulk_modulus": 1e5}
    simulation = scene(
        [box([0.5, 0.5], [1.0, 1.0], material, velocity=[-1.0, 0.0])],
        {"x_min": "slip"},
        registry=with_hypoelastic(),
        order="musl",
    )
    p = simulation.particles
    while simulation.time < 0.55:
        simulation.advance()
    assert p.deformation_gradient is None
    np.testing.assert_array_equal(p.stress[:, 0], p.groups[0].state["mean_stress"])
    assert p.stress[:, 0].min() < -1e3
    assert (p.volume_ratio < 1).any()


@pytest.mark.parametrize("side", ["min", "max"])
def test_a_symmetry_plane_on_either_side_doubles_the_spread(side):
    lower, upper = ([0.0, 0.0], [0.3, 0.4]) if side == "min" else ([1.7, 0.0], [2.0, 0.4])
    simulation = scene([box(lower, upper)], {f"x_{side}": "symmetry"})
    measures = simulation.measures(simulation.particles)
    assert measures["spread_diameter"] == pytest.approx(0.6)
    assert measures["axis_height"] == pytest.approx(0.4)


def test_bodies_that_overlap_are_refused_and_those_that_touch_are_not():
    scene([box([0.5, 0.5], [1.0, 1.0]), box([1.0, 0.5], [1.5, 1.0], RUBBER)])
    for begin, shared in {0.9: r"0\.05", 0.996: r"0\.002"}.items():  # the second is less than a particle
        with pytest.raises(
            CaseError, match=rf"bodies\.1\.shape and bodies\.0\.shape overlap: they share {shared} m³"
        ):
            scene([box([0.5, 0.5], [1.0, 1.0]), box([begin, 0.5], [1.5, 1.0], RUBBER)])


def test_bodies_that_touch_on_a_row_of_lattice_points_weigh_what_they_are():
    p = scene([box([0.0, 0.0], [0.325, 0.2]), box([0.325, 0.0], [0.5, 0.2], RUBBER)]).particles
    assert p.mass.sum() == pytest.approx(1000 * 0.5 * 0.2, rel=1e-12)
    assert p.mass[p.body == 0].sum() == pytest.approx(1000 * 0.325 * 0.2, rel=1e-12)


@pytest.mark.parametrize("height", [0.2126, 0.207, 0.2187])
def test_a_column_keeps_its_height_and_bears_it_at_its_foot(height):
    """Rows are cut at the body's face; the cell at the foot has p = ρ g (H − Δx/2) in the mean."""
    simulation = scene(
        [box([0.0, 0.0], [0.05, height], FLUID | {"sound_speed": 20.0, "viscosity": 2000.0})],
        {"x_min": "slip", "x_max": "slip", "z_min": "slip"},
        {"x": [0, 0.05], "z": [0, 0.3]},
        cell=0.025,
        gravity=-9.81,
        volumetric="own",
    )
    p = simulation.particles
    assert (p.position + p.half_size)[:, 1].max() == pytest.approx(height, abs=1e-12)
    assert p.mass.sum() == pytest.approx(1000 * 0.05 * height, rel=1e-12)
    while simulation.time < 0.08:
        simulation.advance()
    foot = p.pressure[p.position[:, 1] < 0.025].mean()
    assert foot == pytest.approx(1000 * 9.81 * (height - 0.0125), rel=0.01)


def test_a_body_cut_off_centre_by_a_symmetry_plane_weighs_what_is_left():
    p = scene([box([-0.113, 0.2], [0.207, 0.5])], {"x_min": "symmetry"}, cell=0.05).particles
    assert p.mass.sum() == pytest.approx(1000 * 0.207 * 0.3, rel=1e-12)


def test_a_particle_thrown_far_out_stops_the_run_before_memory_does(monkeypatch):
    simulation = scene([box([0.5, 0.5], [1.0, 1.0])], domain={"x": [0, 2e6], "z": [0, 2e6]})
    simulation.advance()
    simulation.particles.position[7] = [1.9e6, 1.9e6]
    number = simulation.particles.number[7]
    monkeypatch.setattr(psutil, "virtual_memory", lambda: type("Memory", (), {"available": 2**30}))
    with pytest.raises(GuardStop, match=rf"particle {number} is so far from the others") as stop:
        simulation.advance()
    assert (stop.value.guard, stop.value.particle, stop.value.step) == ("scattered", number, 1)


def test_a_particle_without_volume_stops_the_run():
    simulation = scene([box([0.5, 0.5], [1.0, 1.0])])
    simulation.advance()
    simulation.particles.volume_ratio[3] = -0.2
    with pytest.raises(GuardStop, match=r"has a volume ratio of -0\.2, which is not positive") as stop:
        simulation.check()
    assert stop.value.particle == simulation.particles.number[3]


@pytest.mark.parametrize("shape", list(installed().of_kind("shape")))
@pytest.mark.parametrize("faces", [{}, {"x_min": "slip", "z_min": "slip"}], ids=["open", "slip"])
def test_general_mappings_average_and_reproduce(shape, faces):
    """A constant comes back as itself, with walls or without, and the average is that of the weights."""
    simulation = scene([box([0.0, 0.0], [1.0, 1.0])], faces, shape=shape)
    operations, p = simulation.operations, simulation.particles
    operations.begin()
    for weighting in ("mass", "volume"):
        nodal = operations.particles_to_nodes(np.full(len(p), 3.5), weighting)
        np.testing.assert_allclose(operations.nodes_to_particles(nodal), 3.5, rtol=1e-13)
    # A node is at the mean of what it sees once its support is full, ``support`` / 2 cells to each side.
    depth = 0.1 * installed().of_kind("shape")[shape].support
    inside = (np.abs(p.position - 0.5) < 0.5 - depth).all(axis=1)
    assert inside.any()
    nodal = operations.particles_to_nodes(2.0 + p.position[:, 0])
    found = operations.nodes_to_particles(nodal)
    np.testing.assert_allclose(found[inside], 2.0 + p.position[inside, 0], rtol=0, atol=1e-12)
