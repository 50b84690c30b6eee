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
