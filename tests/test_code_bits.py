"""New compiled code and cached code give the same bits."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest

from mpmkit.kernels.code_cache import cached_code

OF_THE_KERNELS = """
import hashlib
import numpy as np
from mpmkit.registry import installed
from mpmkit.testing.specimens import Specimens, random_gradients
from test_transfers import Scene

found = []
for law in ("herschel-bulkley-evp", "herschel-bulkley"):
    material = installed().of_kind("law")[law](yield_stress=188.91, consistency=45.65, flow_index=1.33)
    found.append(Specimens(material, 300).drive(random_gradients(300), 0.2, 10))
scene = Scene(2, 3, n=300, affine=True)
grid = np.zeros((scene.count, 10))
scene.scatter(grid, True, True)
scene.gather(scene.rng.normal(size=grid.shape), move=True, strain=True, affine=True)
found += [grid, scene.velocity, scene.velocity_gradient, scene.affine]
print(*(hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest() for array in found))
"""
STEPS = """
import hashlib, sys
import mpmkit
case, *changes = sys.argv[1:]
simulation = mpmkit.Simulation(mpmkit.load_case(case, changes))
while simulation.steps < 20:
    simulation.advance()
particles = simulation.particles
print(*(hashlib.sha256(getattr(particles, name).tobytes()).hexdigest()
        for name in ("position", "velocity", "affine", "stress", "volume_ratio")))
"""
COARSE = ["grid.cell_size=0.02", 'grid.domain={"x": [0, 0.36], "y": [0, 0.36], "z": [0, 0.32]}']
REGULARISED = [
    "bodies.0.material.law=herschel-bulkley",
    "bodies.0.material.regularisation=100",
    "scheme.velocity=flip",
    "scheme.order=usf",
]


def twice_in_processes_of_their_own(script, folder, *arguments):
    """The outputs of two processes: one compiles, the other one loads the cached code."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder), "NUMBA_NUM_THREADS": "1"}
    return [in_a_process_of_its_own(script, environment, *arguments) for _ in range(2)]


def in_a_process_of_its_own(script, environment, *arguments):
    command = [sys.executable, "-c", script, *arguments]
    return subprocess.check_output(command, cwd=Path(__file__).parent, env=environment, text=True)


def test_kernels_just_compiled_and_kernels_that_were_kept_agree_to_the_bit(capsys):
    """Cached code passes through the compiler once more, which must not change the rounding. Tested on the
    kernels with the most arithmetic: two laws, and the maps from particles to nodes and back. If there is no
    cached code yet, as in continuous integration, this process compiles it."""
    exec(OF_THE_KERNELS, {})
    environment = {**os.environ, "NUMBA_NUM_THREADS": "1"}
    kept = in_a_process_of_its_own(OF_THE_KERNELS, environment)
    assert capsys.readouterr().out == kept


@pytest.mark.slow
def test_kernels_agree_to_the_bit_whatever_code_there_is_on_this_machine(tmp_path):
    compiled, kept = twice_in_processes_of_their_own(OF_THE_KERNELS, tmp_path)
    assert compiled == kept


@pytest.mark.slow
@pytest.mark.parametrize(
    "arguments",
    [["slump_fast"], ["slump_quarter", *COARSE], ["slump_quarter", *COARSE, *REGULARISED]],
    ids=["axisymmetric", "3-D", "3-D, regularised"],
)
def test_scenes_of_code_just_compiled_and_of_code_that_was_kept_agree_to_the_bit(arguments, tmp_path):
    name, *changes = arguments
    case = Path(__file__).parents[1] / "cases" / f"{name}.json"
    compiled, kept = twice_in_processes_of_their_own(STEPS, tmp_path, str(case), *changes)
    assert compiled == kept


def test_a_function_is_compiled_once_for_all_constants_of_one_type():
    @cached_code(numba.njit)
    def power(x, exponent, inverse):
        return x**-exponent if inverse else x**exponent

    @numba.njit  # not kept on disk: from there it would come without asking for the other
    def both(x):
        return power(x, 2, False) + power(x, 3, False) + power(x, 1, True)

    assert both(2.0) == 4 + 8 + 0.5
    if not numba.config.DISABLE_JIT:
        assert len(power.overloads) == 1
