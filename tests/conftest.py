"""Settings made before any import: two threads even on one core, so that tests of determinism can fail, and
only the built-in plug-ins."""

import os

os.environ.setdefault("NUMBA_NUM_THREADS", "2")
os.environ["MPMKIT_PLUGINS"] = ""

import numba
import pytest
from third_party import distribution  # noqa: F401 - a fixture of more than one file


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config):
    """Whole folders of tests run on all cores; single files in this process, which starts at once.

    ``-n`` decides otherwise: ``pytest -n 0`` runs everything in this process.
    """
    here = "PYTEST_XDIST_WORKER" not in os.environ and config.pluginmanager.hasplugin("xdist")
    if here and config.option.numprocesses is None and all(map(os.path.isdir, config.args)):
        config.option.numprocesses = "auto"
        if config.option.dist == "no":
            config.option.dist = "worksteal"


COMPILE_NOTHING = {
    "test_body_shape_kit.py", "test_case.py", "test_case_values.py", "test_code_cache.py",
    "test_distances.py", "test_examples.py", "test_fit_files.py", "test_geometry.py",
    "test_geometry_between.py", "test_mesh_files.py", "test_meshes.py", "test_messages.py",
    "test_new_plugin.py", "test_study_files.py", "test_surfaces_and_contacts.py",
}  # fmt: skip
"""Files whose tests need few kernels or none."""


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items):
    """Of two processes the second begins with what compiles nothing.

    Each takes one half of the tests. If both began with simulations, they would compile the same kernels at
    the same time; so the second finds those of the first in the cache.
    """
    if "PYTEST_XDIST_WORKER" not in os.environ:
        return
    first = [item for item in items if item.path.name in COMPILE_NOTHING]
    others = [item for item in items if item.path.name not in COMPILE_NOTHING]
    middle = len(items) // 2
    items[:] = others[:middle] + first + others[middle:]


@pytest.fixture(scope="session", autouse=True)
def nothing_ahead():
    """No processes that compile ahead of a run: the other cores have tests of their own."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("mpmkit.running.ahead.MOST", 0)
        yield


@pytest.fixture(autouse=True)
def one_thread():
    """One thread unless a test asks for more: the scenes are small, and on a busy machine two that wait for
    each other at the end of every loop can take a hundred times as long."""
    numba.set_num_threads(1)


@pytest.fixture(params=[1, 2], ids=["1 thread", "2 threads"])
def each_number_of_threads(one_thread, request):
    """For tests of kernels: once with one thread, once with two."""
    numba.set_num_threads(request.param)


@pytest.fixture
def undrawn(monkeypatch):
    """Studies without their figures, which take longer to draw than these tests take for all else."""
    monkeypatch.setattr("mpmkit.study.figures.draw", lambda dataset, directory: None)


collect_ignore = ["version1"]
"""A distribution of its own, whose tests ``test_versions.py`` runs."""
