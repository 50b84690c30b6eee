"""A law that fails is named with its distribution, whichever command it fails in."""

import json

import pytest
from third_party import LAW, case, status

from mpmkit.bench.timing import timed
from mpmkit.case import parse_case
from mpmkit.errors import PluginStop
from mpmkit.registry import installed
from mpmkit.rheology.refit import with_law
from mpmkit.solver.simulation import Simulation
from mpmkit.study.work import run_member

FAULTS = {
    "a number that is none": (
        "self.plastic_viscosity",
        "np.full_like(shear_rate, np.nan)",
        "stress that is not finite",
    ),
    "another shape": ("self.plastic_viscosity", "np.ones(3)[:, None]", "must return an array of shape (64,)"),
    "an exception": ("self.plastic_viscosity", "{}['yield surface']", "raised KeyError: 'yield surface'"),
}


@pytest.mark.parametrize(("good", "bad", "reason"), FAULTS.values(), ids=FAULTS)
def test_a_law_that_fails_in_a_run_is_named_with_its_distribution(
    good, bad, reason, distribution, tmp_path, capsys
):
    """After a few calls the law fails: the summary names it, and other cases still run."""
    law = LAW.replace("import numpy as np", "import numpy as np\nasked = []")
    law = law.replace(
        "        return self.yield", "        asked.append(len(shear_rate))\n        return self.yield"
    )
    law = law.replace(f"+ {good}", f"+ ({bad} if asked.count(64) > 6 else {good})")
    distribution("faulty-pack", slurry=law)
    distribution("good-pack", mud=LAW.replace('"slurry"', '"mud"'))
    path = tmp_path / "case.json"
    path.write_text(json.dumps(case() | {"until": 0.05}), encoding="utf-8")
    assert status("run", path, "--out", tmp_path / "run", "--quiet") == 3
    (sentence,) = capsys.readouterr().err.splitlines()
    assert sentence.startswith("mpmkit: stopped at step ")
    assert "the plug-in 'slurry' (law, of faulty-pack) " in sentence
    assert reason in sentence
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["stopped_because"] == "plug-in-error"
    path.write_text(json.dumps(case("mud")), encoding="utf-8")
    assert status("run", path, "--out", tmp_path / "other", "--quiet") == 0


def failing(raised, method="largest_viscosity", after=0):
    """A law one of whose methods raises something, from some call on."""
    body = (
        f"    def {method}(self, *given):\n"
        f"        asked.append(1)\n"
        f"        if len(asked) > {after}:\n"
        f"            raise {raised}\n"
        f"        return super().{method}(*given)\n\n"
    )
    law = LAW.replace("    def apparent_viscosity", body + "    def apparent_viscosity")
    imports = "import sys\nimport numpy as np\nfrom mpmkit.errors import CaseError\nasked = []"
    return law.replace("import numpy as np", imports)


RAISED = {
    "KeyError('surface')": "raised KeyError: 'surface' (faulty_pack_slurry.py, line ",
    "TypeError('I am a bug')": "raised TypeError: I am a bug (faulty_pack_slurry.py, line ",
    "ValueError('I am a bug')": "raised ValueError: I am a bug (faulty_pack_slurry.py, line ",
    "CaseError('the case is wrong')": "raised CaseError: the case is wrong (faulty_pack_slurry.py, line ",
    "SystemExit(0)": "raised SystemExit: 0 (faulty_pack_slurry.py, line ",
}


@pytest.mark.parametrize("raised", RAISED)
@pytest.mark.parametrize("command", ["run", "plan", "stability"])
def test_a_law_that_fails_while_a_case_is_validated_is_named(
    command, raised, distribution, tmp_path, capsys, monkeypatch
):
    """In one sentence, with status 3, the same of every command; nothing is written."""
    monkeypatch.chdir(tmp_path)
    distribution("faulty-pack", slurry=failing(raised))
    (tmp_path / "case.json").write_text(json.dumps(case()), encoding="utf-8")
    assert status(command, "case.json") == 3
    (sentence,) = capsys.readouterr().err.splitlines()
    assert sentence.startswith(f"mpmkit: the plug-in 'slurry' (law, of faulty-pack) {RAISED[raised]}")
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize("command", ["plan", "stability"])
def test_a_law_that_fails_in_a_trial_is_named_by_every_command(
    command, distribution, tmp_path, capsys, monkeypatch
):
    """Neither for a case that cannot be run nor for a step that is too long."""
    monkeypatch.chdir(tmp_path)
    distribution("faulty-pack", slurry=failing("KeyError('surface')", "update_stress", after=6))
    (tmp_path / "case.json").write_text(json.dumps(case() | {"until": 0.05}), encoding="utf-8")
    assert status(command, "case.json") == 3
    (sentence,) = capsys.readouterr().err.splitlines()
    assert sentence.startswith("mpmkit: stopped at step ")
    assert (
        f"the plug-in 'slurry' (law, of faulty-pack) {RAISED['KeyError(' + repr('surface') + ')']}"
        in sentence
    )


def test_a_law_that_ends_the_process_ends_its_run(distribution, tmp_path, capsys):
    """With status 3 and a message (formerly 0 and none); the results so far are kept."""
    distribution("faulty-pack", slurry=failing("SystemExit(0)", "update_stress", after=6))
    path = tmp_path / "case.json"
    path.write_text(json.dumps(case() | {"until": 0.05}), encoding="utf-8")
    assert status("run", path, "--out", tmp_path / "run", "--quiet") == 3
    assert "the plug-in 'slurry' (law, of faulty-pack) raised SystemExit: 0" in capsys.readouterr().err
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["stopped_because"] == "plug-in-error"
    assert (tmp_path / "run" / "history.nc").exists()


def test_a_law_that_ends_the_process_ends_its_member_of_a_study(distribution):
    distribution("faulty-pack", slurry=failing("SystemExit(0)", "update_stress", after=6))
    outcome = run_member(case() | {"name": "member", "until": 0.05}, threads=1)
    assert outcome.fate == "plug-in-error"
    assert "the plug-in 'slurry' (law, of faulty-pack) raised SystemExit: 0" in outcome.sentence


def test_a_law_that_fails_as_its_parameters_are_fitted_is_named(distribution):
    """A curve is asked for where a study or ``stability`` puts another law in the place of one."""
    raising = LAW.replace("return self.yield_stress /", "raise ValueError('no curve')\n        return 1 /")
    distribution("faulty-pack", slurry=raising)
    (body,) = case()["bodies"]
    said = r"the plug-in 'slurry' \(law, of faulty-pack\) raised ValueError: no curve"
    with pytest.raises(PluginStop, match=said):
        with_law(body["material"], "herschel-bulkley", installed())


def test_a_law_that_fails_in_a_benchmark_is_named(distribution):
    distribution("faulty-pack", slurry=failing("KeyError('surface')", "update_stress", after=3))
    with pytest.raises(PluginStop, match=r"'slurry' \(law, of faulty-pack\) raised KeyError: 'surface'"):
        timed(Simulation(parse_case(case())), "of the tests", threads=1, seconds=0.1)


def test_what_a_validator_of_a_plugin_refuses_is_the_users(distribution, tmp_path, capsys):
    """A ValueError of pydantic's validators is how a plug-in says that a parameter is wrong."""
    law = LAW.replace("import numpy as np", "import numpy as np\nfrom pydantic import field_validator")
    check = (
        "    @field_validator('yield_stress')\n    @classmethod\n    def _even(cls, value):\n"
        "        if value % 2:\n            raise ERROR\n        return value\n\n"
    )
    law = law.replace("    def apparent_viscosity", check + "    def apparent_viscosity")
    distribution("careful-pack", slurry=law.replace("ERROR", "ValueError('it must be even')"))
    distribution("faulty-pack", mud=law.replace('"slurry"', '"mud"').replace("ERROR", "KeyError('surface')"))
    path = tmp_path / "case.json"
    for name, expected, said in (
        ("slurry", 2, "it must be even"),
        ("mud", 3, "the plug-in 'mud' (law, of faulty-pack) raised KeyError: 'surface'"),
    ):
        data = case(name)
        data["bodies"][0]["material"]["yield_stress"] = 101
        path.write_text(json.dumps(data), encoding="utf-8")
        assert status("plan", path) == expected
        assert said in capsys.readouterr().err
