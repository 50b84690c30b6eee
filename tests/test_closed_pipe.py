"""``mpmkit … | head -1``: when the reader has gone, a command ends without a message, and a run continues to
its end."""

import json
import os
import subprocess
import sys

import pytest
from studies import CASE

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="pipes of POSIX")


def unread(*arguments, here, errors=False):
    """Run a command whose standard output is closed, and with ``errors`` also its standard error."""
    reading, writing = os.pipe()
    os.close(reading)
    try:
        return subprocess.run(
            [sys.executable, "-m", "mpmkit", *arguments],
            stdout=writing,
            stderr=writing if errors else subprocess.PIPE,
            cwd=here,
            text=True,
            check=False,
        )
    finally:
        os.close(writing)


@pytest.mark.parametrize("arguments", [["schema"], ["run", "--help"]])
def test_what_is_printed_ends_with_the_status_of_the_shell(arguments, tmp_path):
    done = unread(*arguments, here=tmp_path)
    assert (done.returncode, done.stderr) == (141, "")


def test_a_run_goes_on_to_its_end(tmp_path):
    """With ``2>&1`` the first line of the log meets the closed pipe."""
    (tmp_path / "tiny.json").write_text(json.dumps(CASE), encoding="utf-8")
    assert unread("run", "tiny.json", "--out", "x", here=tmp_path, errors=True).returncode == 141
    assert json.loads((tmp_path / "x/summary.json").read_text())["stopped_because"] == "finished"


def test_a_bad_case_keeps_its_status(tmp_path):
    assert unread("run", "gone.json", here=tmp_path, errors=True).returncode == 2
