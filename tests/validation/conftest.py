"""Fixtures of the validation tests: one thread, and a sheet for the results of each test."""

from __future__ import annotations

import numba
import pytest
from sheet import Sheet, done_before

SHEET = pytest.StashKey[Sheet]()


def pytest_configure(config):
    config.addinivalue_line("markers", "section(number): section of the validation report that it belongs to")


def pytest_collection_modifyitems(config, items):
    done = [item for item in items if done_before(item.nodeid)]
    if done:
        config.hook.pytest_deselected(items=done)
        items[:] = [item for item in items if item not in done]


@pytest.fixture(autouse=True)
def _one_thread():
    numba.set_num_threads(1)


@pytest.fixture
def validate(request) -> Sheet:
    """Called with each number that the test vouches for; see the module ``sheet``."""
    return request.node.stash[SHEET]


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    marker = item.get_closest_marker("section")
    section = marker.args[0] if marker else 0
    slow = item.get_closest_marker("slow") is not None
    item.stash[SHEET] = Sheet(item.nodeid, item.reportinfo()[1] or 0, section, slow)


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem):
    """The test itself, and then the verdict on its rows."""
    result = yield
    if SHEET in pyfuncitem.stash:
        pyfuncitem.stash[SHEET].judge()
    return result


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Close the sheet. A test that ended by itself keeps the rows that it had, and says what stopped it."""
    report = yield
    if SHEET in item.stash and (call.when == "call" or report.failed or report.skipped):
        sheet = item.stash[SHEET]
        status = "passed"
        if hasattr(report, "wasxfail"):
            status = "expected to fail" if report.skipped else "passed though expected to fail"
        elif report.skipped:
            status = "skipped"
        elif call.excinfo is not None:
            status = "failed" if call.excinfo.errisinstance(AssertionError) else "crashed"
        elif report.failed:
            status = "passed though expected to fail"  # of an xfail that is strict
        said = str(call.excinfo.value).strip() if call.excinfo else getattr(report, "wasxfail", "")
        sheet.finish(status, said.split("\n")[0][:200], call.duration)
    return report
