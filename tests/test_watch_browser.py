"""The live page in a real browser: it shows the written results, follows the run, and shows its end."""

import shutil
import threading
from pathlib import Path

import pytest
from browser import window

from mpmkit.case import load_case
from mpmkit.output import RunDirectory
from mpmkit.output.flow import arrays_of, read_flow, write_flow
from mpmkit.output.netcdf import read_dataset, write_dataset
from mpmkit.running.runner import run
from mpmkit.watch.server import Server

CASE = Path(__file__).parents[1] / "cases" / "slump_fast.json"
STATUS = "document.querySelector('[role=status]').textContent"


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A run that has ended."""
    directory = tmp_path_factory.mktemp("whole") / "run"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mpmkit.report.write_report", lambda _: [])
        run(load_case(CASE, ["until=0.2", "grid.cell_size=0.04"]), directory, threads=1)
    return RunDirectory(directory)


def write_part(whole, part, rows, moments):
    """What the run had written when it had so many rows and moments."""
    write_dataset(read_dataset(whole.history).isel(time=slice(0, rows)), part.history)
    write_flow(part.flow, arrays_of(read_flow(whole.flow)[:moments]))


def test_the_page_follows_the_run_to_its_end(whole, tmp_path):
    part = RunDirectory(tmp_path / "run")
    part.path.mkdir()
    shutil.copy(whole.case, part.case)
    server = Server(part.path, resumed=False)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with window() as browser:
        browser.driver.get(server.address)
        browser.until(f"{STATUS}.includes('being prepared')")
        write_part(whole, part, 40, 5)
        browser.until("document.documentElement.dataset.ready === 'yes'", 30)
        at = float(read_dataset(part.history).time[-1])
        browser.until(f"{STATUS} === 'Live: t = {at:#.4g} of 0.2 s'", 30)
        early = browser.run("return mpmkit.page.player.flow.moments.length")
        browser.run("mpmkit.page.player.seek(0.001)")
        write_part(whole, part, None, None)
        shutil.copy(whole.summary, part.summary)
        browser.until("document.documentElement.dataset.version !== undefined", 30)
        assert browser.run("return mpmkit.page.player.flow.moments.length") > early
        assert browser.run("return mpmkit.page.player.time") == 0.001  # the player stays where it was
        assert "The run came to its end" in browser.run("return document.body.innerText")
        server.end()
        browser.until(f"{STATUS}.includes('The run has ended. Its page stays in {part.path}')", 30)
        assert browser.errors() == []
        assert {address.split("/")[2] for address in browser.requests()} == {server.address.split("/")[2]}
    server.shutdown()
    server.server_close()
