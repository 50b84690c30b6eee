"""A shape function with unusable tables is named, and a rehearsal does not change results."""

from __future__ import annotations

import numpy as np
import pytest
from faulty_plugins import N, blamed, simulation

import mpmkit
from mpmkit.contracts import (
    ShapeFunction,
)


def hats(**changes):
    """The hat functions, written out, with something wrong."""
    calls = []

    class Hats(ShapeFunction):
        name = "of-the-tests"
        api_version = 2
        citation = "none"
        support = 2

        def fill(self, position, half_size, cell_size, base, weight, gradient):
            cells = position / cell_size
            base[:] = np.floor(cells) + changes.get("base", 0)
            part = cells - np.floor(cells)
            weight[..., 0], weight[..., 1] = 1 - part, part * changes.get("weight", 1.0)
            gradient[..., 0], gradient[..., 1] = -1 / cell_size, changes.get("gradient", 1.0) / cell_size
            gradient *= changes.get("sign", 1)
            if changes.get("mirrored"):
                weight[:] = weight[..., ::-1].copy()
            if "later" in changes:
                calls.append(len(position))
                if len(position) == N and calls.count(N) > 3:
                    changes["later"](base, weight, gradient)
            if "unset" in changes:
                weight[3] = np.nan
            if "beyond" in changes:
                np.lib.stride_tricks.as_strided(weight, (len(weight) + 1, 2, 2))[-1] = 0.0
            if "meddle" in changes:
                position[0] += 1e-9

        def fill_radial(self, *arguments):
            raise NotImplementedError

    return Hats


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"base": 5}, "nodes more than a cell from the particle's own"),
        ({"weight": 0.99}, "weights that do not sum to one"),
        ({"gradient": 0.99}, "gradients that do not sum to zero"),
        ({"sign": -1}, "gave gradients of which that of a linear field, Σ ∇N x, is not one"),
        ({"mirrored": True}, "gave weights whose mean position of the nodes, Σ N x, is not the particle's"),
        ({"unset": True}, "left 'weight' without a finite number"),
        ({"beyond": True}, "wrote beyond the ends of the array 'weight'"),
        ({"meddle": True}, "changed 'position', which it may only read"),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_a_shape_function_whose_tables_cannot_be_used(changes, reason):
    assert reason in blamed("shape", hats(**changes), steps=1)


@pytest.mark.parametrize(
    "later",
    [
        lambda base, weight, gradient: base.__setitem__((7, 1), 2**30),
        lambda base, weight, gradient: base.__setitem__((7, 0), -(2**31)),
        lambda base, weight, gradient: base.__iadd__(2),
    ],
    ids=["far", "far below", "all"],
)
def test_a_base_that_goes_astray_between_rehearsals(later):
    """Formerly, the compiled loops then accessed memory outside the nodes: signal 11."""
    said = blamed("shape", hats(later=later), steps=8)
    assert "stopped at step 2, " in said
    assert "the 'base' " in said
    assert "which leads to nodes more than a cell from the particle's own" in said


@pytest.mark.parametrize(
    ("later", "reason"),
    [
        (
            lambda base, weight, gradient: weight.__setitem__(5, np.nan),
            "weights that sum to nan and not to 1",
        ),
        (lambda base, weight, gradient: weight.__imul__(1.01), "weights that sum to 1.0201 and not to 1"),
        (lambda base, weight, gradient: gradient.__setitem__(5, np.nan), "gradients that do not sum to zero"),
        (lambda base, weight, gradient: gradient.__setitem__(5, 0.3), "gradients that do not sum to zero"),
    ],
    ids=["nan", "heavy", "nan gradients", "gradients"],
)
def test_weights_that_go_astray_between_rehearsals(later, reason):
    """Formerly, the message blamed the step, or there was none."""
    assert reason in blamed("shape", hats(later=later), steps=25)


@pytest.mark.parametrize("domain", ["stretched", None, 1])
def test_a_rule_for_domains_that_there_is_not(domain):
    plugin = hats()
    plugin.particle_domain = property(lambda self: domain)
    assert f"has a particle_domain of {domain!r}; it must be one of strain, fixed" in blamed("shape", plugin)


def test_a_shape_function_that_is_sound_runs():
    made = simulation("shape", hats())
    made.advance()
    assert made.steps == 1


def test_a_rehearsal_changes_nothing(monkeypatch):
    """To the bit, whether laws and shape functions are rehearsed in every step or hardly ever."""
    last = []
    for interval in (1, 10**9):
        monkeypatch.setattr("mpmkit.registry.audit.INTERVAL", interval)
        made = mpmkit.Simulation(mpmkit.load_case("cases/slump_fast.json"))
        for _ in range(5):
            made.advance()
        last.append(made.particles)
    for name, array in last[0].arrays().items():
        np.testing.assert_array_equal(array, getattr(last[1], name), err_msg=name)
