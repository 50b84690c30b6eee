"""Output of a plug-in, and its changes of the process, do not disturb results."""

import json
import logging
import os
import subprocess
import sys
import warnings

import numpy as np
import pytest
from third_party import LAW, case, status

from mpmkit.registry import discover

TALKATIVE = """
import os
import sys
print("hello at import")
os.write(1, b"hello of a library\\n")
sys.__stdout__.write("hello by another way\\n")
os.system("echo hello of a process")
""" + LAW.replace('"slurry"', '"talker"').replace(
    "        return self.yield_stress", "        print('hello in a call')\n        return self.yield_stress"
)


@pytest.mark.parametrize(
    "arguments", [["plan", "case.json", "--json"], ["plugins", "--json"], ["schema"]], ids=" ".join
)
def test_what_a_plugin_prints_is_kept_out_of_json(arguments, distribution, tmp_path):
    """However it prints, at import or in calls: the standard output has only results."""
    distribution("loud-pack", talker=TALKATIVE)
    (tmp_path / "case.json").write_text(json.dumps(case("talker")), encoding="utf-8")
    path = os.pathsep.join([str(tmp_path), *sys.path])
    done = subprocess.run(
        [sys.executable, "-m", "mpmkit", *arguments],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path, "MPMKIT_PLUGINS": "loud-pack", "NUMBA_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert "talker" in done.stdout or json.loads(done.stdout)["particles"] == 64
    json.loads(done.stdout)
    said = ["at import", "of a library", "by another way", "of a process"]
    said += ["in a call"] if arguments[0] == "plan" else []
    assert [word for word in said if f"hello {word}" not in done.stderr] == []


def test_what_a_plugin_prints_is_kept_out_of_json_in_a_notebook_too(distribution, capsys):
    """Python's own streams may be others than those of the system; they are back afterwards."""
    distribution("loud-pack", talker="print('hello')\n" + LAW.replace('"slurry"', '"talker"'))
    before = sys.stdout
    assert status("plugins", "--json") == 0
    shown = capsys.readouterr()
    assert "talker" in {plugin["name"] for plugin in json.loads(shown.out)["plugins"]}
    assert shown.err.count("hello") == 1
    assert sys.stdout is before


MEDDLER = """
import logging.config
import os
import warnings
import numpy as np
os.chdir("/")
np.seterr(all="raise")
warnings.simplefilter("error")
logging.disable(logging.CRITICAL)
logging.config.dictConfig({"version": 1})
""" + LAW.replace('"slurry"', '"meddler"').replace(
    "        return self.yield_stress",
    "        os.chdir('/')\n        np.seterr(all='raise')\n        return self.yield_stress",
)


def test_what_a_plugin_changes_of_the_process_is_undone(distribution, tmp_path, monkeypatch):
    """Else the results would go elsewhere, and the warnings of the run nowhere."""
    monkeypatch.chdir(tmp_path)
    errors = np.geterr()
    distribution("meddling-pack", meddler=MEDDLER)
    (tmp_path / "case.json").write_text(json.dumps(case("meddler")), encoding="utf-8")
    assert status("run", "case.json", "--out", "here", "--quiet") == 0
    assert (tmp_path / "here" / "summary.json").exists()
    assert os.getcwd() == str(tmp_path)
    assert np.geterr() == errors
    assert ("error", None, Warning, None, 0) not in warnings.filters
    logger = logging.getLogger("mpmkit")
    assert not logger.disabled
    assert logger.isEnabledFor(logging.WARNING)
    assert "64 particles" in (tmp_path / "here" / "run.log").read_text(encoding="utf-8")


def test_a_problem_of_one_plugin_is_not_reported_for_another_with_a_similar_name(distribution):
    source = LAW.replace('"slurry"', '"slurry-evp"').replace("api_version = 2", "api_version = 9")
    distribution("old-pack", slurry_evp=source)
    registry = discover()
    assert len(registry.why_not("law", "slurry-evp")) == 1
    assert registry.why_not("law", "slurry") == []
