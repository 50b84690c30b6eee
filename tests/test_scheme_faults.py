"""A faulty volumetric treatment, redistribution, velocity update or order is named."""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np
import pytest
from faulty_plugins import N, blamed, simulation

from mpmkit.contracts import (
    Redistribution,
    UpdateOrder,
    VelocityUpdate,
    VolumetricTreatment,
)


@pytest.mark.parametrize(
    ("average", "rate", "reason"),
    [
        (lambda field: field[:-1], 0.0, "returned an array of shape (63,) from average"),
        (lambda field: field * np.nan, 0.0, "an average that is not finite"),
        (lambda field: np.ones(N, dtype=int), 0.0, "returned an array of int64 from average"),
        (lambda field: field.astype(complex), 0.0, "returned an array of complex128 from average"),
        (lambda field: None, 0.0, "returned nothing from average"),
        (lambda field: np.add(field, 1.0, out=field), 0.0, "changed 'field', which it may only read"),
        (lambda field: field, "fast", "gave the text 'fast' as relaxation_rate; it must be a number"),
        (lambda field: field, -1.0, "has a relaxation rate of -1.0 /s"),
        (lambda field: field, math.nan, "has a relaxation rate of nan /s"),
    ],
    ids=[
        "shape",
        "no number",
        "integers",
        "complex",
        "nothing",
        "meddles",
        "text",
        "negative rate",
        "no rate",
    ],
)
def test_a_volumetric_treatment_that_cannot_be_used(average, rate, reason):
    class Bad(VolumetricTreatment):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def average(self, ops, field):
            return average(field)

        def relaxation_rate(self, ops):
            return rate

    assert reason in blamed("volumetric", Bad)


@pytest.mark.parametrize(
    ("use", "reason"),
    [
        (
            lambda ops: ops.shift(np.zeros((N - 1, 2))),
            "gave an array of shape (63, 2) as a displacement; it must",
        ),
        (lambda ops: ops.shift(np.full((N, 2), np.nan)), "gave particle 0 a displacement that is not finite"),
        (lambda ops: ops.shift(None), "gave nothing as a displacement"),
        (
            lambda ops: ops.shift(np.zeros((N, 2), dtype=int)),
            "an array of shape (64, 2) of int64 as a displace",
        ),
        (lambda ops: ops.scale_volume_ratio(np.ones(3)), "gave an array of shape (3,) as a factor of J"),
        (lambda ops: ops.scale_volume_ratio(np.zeros(N)), "gave 0 as a factor of J; it must be above 0"),
        (lambda ops: ops.scale_volume_ratio(np.full(N, np.inf)), "a factor of J that is not finite"),
        (lambda ops: ops.weigh(-np.ones(N)), "gave -1 as a weight; it must be at least 0"),
        (lambda ops: ops.weigh(1.0), "gave a float as a weight"),
        (lambda ops: ops.nodes.at_particles(np.ones(3)), "gave an array of shape (3,) as a field"),
        (lambda ops: ops.nodes.average(np.ones(N + 1)), "one number for each of 64 particles"),
        (lambda ops: ops.places.least_around(None), "gave nothing as a field"),
        (lambda ops: ops.places.nearest(ops, ops.nodes.crowding()), "what is no lattice of this scene"),
        (lambda ops: ops.cells().at_particles("all"), "gave the text 'all' as a field"),
    ],
)
def test_what_a_redistribution_cannot_hand_in(use, reason):
    class Bad(Redistribution):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def is_due(self, shear):
            return True

        def redistribute(self, ops, time):
            use(ops)

    assert reason in blamed("redistribution", Bad)


@pytest.mark.parametrize(
    ("due", "reason"), [(None, "returned nothing from is_due"), (0.5, "returned a float from is_due")]
)
def test_a_redistribution_that_does_not_say_whether_it_is_due(due, reason):
    class Bad(Redistribution):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def is_due(self, shear):
            return due

        def redistribute(self, ops, time):
            pass

    assert f"{reason}; it must be True or False" in blamed("redistribution", Bad)


def test_a_flip_that_is_no_number():
    class Bad(VelocityUpdate):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def map_to_particles(self, ops, dt):
            ops.move_particles(dt, flip=math.nan)

    assert "asked for a flip of nan" in blamed("velocity", Bad)


@pytest.mark.parametrize(
    ("use", "reason"),
    [
        (lambda ops, dt: ops.average("all"), "asked for an average of str"),
        (lambda ops, dt: ops.average(np.ones(3)), "it must be an array of 64 real numbers"),
        (lambda ops, dt: ops.average(np.ones(N, dtype=complex)), "it must be an array of 64 real numbers"),
        (lambda ops, dt: ops.nodes_to_particles(np.ones(N - 1)), "asked for an average of (63,) of float64"),
        (lambda ops, dt: ops.average(np.ones(N), "weight"), "it must be by 'mass' or 'volume'"),
        (lambda ops, dt: ops.move_particles("dt", flip=1.0), "asked for a step of 'dt' s"),
        (lambda ops, dt: ops.move_particles(math.nan, flip=1.0), "asked for a step of nan s"),
        (lambda ops, dt: ops.move_particles(dt, flip="much"), "asked for a flip of much"),
        (
            lambda ops, dt: ops.move_particles(dt / 2, flip=1.0),
            "advanced the particles by 0.002 s in a step of 0.004 s",
        ),
        (lambda ops, dt: None, "advanced the particles by 0 s in a step of 0.004 s"),
    ],
    ids=["text", "few", "complex", "nodes", "measure", "step", "nan", "flip", "half", "nothing"],
)
def test_a_velocity_update_that_misuses_its_operations(use, reason):
    class Bad(VelocityUpdate):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def map_to_particles(self, ops, dt):
            use(ops, dt)

    assert reason in blamed("velocity", Bad)


class Order(UpdateOrder):
    name = "of-the-tests"
    api_version = 2
    citation = "none"
    calls: ClassVar = (
        "map_to_grid",
        "solve_momentum",
        "map_to_particles",
        "update_velocity_gradient",
        "update_stress",
    )

    def step(self, ops, dt):
        for call in self.calls:
            method, _, times = call.partition("*")
            timed = method in ("solve_momentum", "map_to_particles", "update_stress")
            getattr(ops, method)(*((float(times or 1) * dt,) if timed else ()))


@pytest.mark.parametrize(
    ("calls", "reason"),
    [
        ((), "moved the particles by 0 s in a step of 0.004 s"),
        (Order.calls[:-1], "updated the stress by 0 s in a step of 0.004 s"),
        ((*Order.calls[:-1], "update_stress*2"), "updated the stress by 0.008 s in a step of 0.004 s"),
        ((*Order.calls[:3], "update_stress"), "updated the stress without the velocity gradient of the step"),
        (("map_to_grid", *Order.calls[2:]), "with nodal velocities advanced by 0 s"),
        (("map_to_grid", "map_forces", *Order.calls[1:]), "the forces mapped 2 times; it must be once"),
        (Order.calls[1:], "the forces mapped 0 times; it must be once"),
        ((*Order.calls[:2], *Order.calls[3:]), "moved the particles by 0 s in a step of 0.004 s"),
    ],
    ids=[
        "nothing",
        "no stress",
        "twice",
        "no gradient",
        "no momentum",
        "forces twice",
        "no map",
        "no motion",
    ],
)
def test_an_order_that_does_not_advance_the_scene(calls, reason):
    assert reason in blamed("order", type("Bad", (Order,), {"calls": calls, "__module__": __name__}))


@pytest.mark.parametrize(
    "calls",
    [
        Order.calls,
        (*Order.calls[:4], "update_stress*0.5", "update_stress*0.5"),
        (*Order.calls[:3], "remap_velocity", *Order.calls[3:]),
    ],
    ids=["whole", "halves", "remapped"],
)
def test_an_order_that_is_sound_runs(calls):
    made = simulation("order", type("Good", (Order,), {"calls": calls, "__module__": __name__}))
    for _ in range(3):
        made.advance()
    assert made.steps == 3


@pytest.mark.parametrize("fraction", [0.0, -1.0, math.nan, math.inf, "half", None], ids=str)
@pytest.mark.parametrize(
    ("kind", "name"),
    [("order", "acoustic_fraction"), ("order", "viscous_fraction"), ("velocity", "acoustic_fraction")],
)
def test_a_part_of_the_limit_that_is_none(kind, name, fraction):
    """Formerly, the message blamed the step and asked the user to shorten it."""

    class Update(VelocityUpdate):
        name = "of-the-tests"
        api_version = 2
        citation = "none"

        def map_to_particles(self, ops, dt):
            ops.move_particles(dt, flip=1.0)

    base = Order if kind == "order" else Update
    said = blamed(kind, type("Bad", (base,), {name: fraction, "__module__": __name__}))
    assert f" as {name}; it must be" in said
