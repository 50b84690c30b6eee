"""Discovery: whatever a stranger's distribution does stays its own problem, and is reported."""

import json
import logging
import os
import subprocess
import sys
import textwrap
import warnings

import numpy as np
import pytest

from mpmkit.bench.timing import timed
from mpmkit.case import parse_case
from mpmkit.cli import main
from mpmkit.errors import CaseError, PluginStop
from mpmkit.registry import discover, installed
from mpmkit.rheology.refit import with_law
from mpmkit.solver.simulation import Simulation
from mpmkit.study.work import run_member

LAW = """
import numpy as np
from mpmkit.contracts import GeneralisedNewtonianLaw, hookimpl, quantity

class Slurry(GeneralisedNewtonianLaw):
    '''mu = tau0 / (γ̇ + γ̇0) + mu_p, a plastic regularised by a shear rate.'''

    name = "slurry"
    api_version = 2
    citation = "nobody, nowhere (2024)"

    yield_stress: float = quantity("Pa", "yield stress", ge=0)
    plastic_viscosity: float = quantity("Pa s", "plastic viscosity", ge=0)
    smallest_rate: float = quantity("1/s", "regularising shear rate", gt=0, default=1.0)

    def apparent_viscosity(self, shear_rate: np.ndarray) -> np.ndarray:
        return self.yield_stress / (shear_rate + self.smallest_rate) + self.plastic_viscosity

@hookimpl
def mpmkit_laws():
    return [Slurry]
"""

BROKEN = {
    "import error": ("import nothing_of_this_name\n", "No module named 'nothing_of_this_name'"),
    "exit at import": ("raise SystemExit(3)\n", "SystemExit: 3"),
    "exit without a word": ("raise SystemExit\n", "SystemExit"),
    "skipped at import": (
        "import pytest\npytest.importorskip('no_such_module')\n",
        "Skipped: could not import",
    ),
    "exception of its own": (
        "class Mute(BaseException):\n    def __str__(self):\n        return 1 / 0\nraise Mute\n",
        "Mute",
    ),
    "exit in a hook": (LAW.replace("return [Slurry]", "raise SystemExit(0)"), "SystemExit: 0"),
    "syntax error": ("def f(:\n", "SyntaxError"),
    "misspelt hook": (LAW.replace("def mpmkit_laws", "def mpmkit_law"), "did you mean mpmkit_laws?"),
    "newer version": (
        LAW.replace("api_version = 2", "api_version = 3"),
        "it is written for version 3 of the plug-in contracts; this mpmkit supports versions 1 to 2; "
        "update mpmkit",
    ),
    "older version": (
        LAW.replace("api_version = 2", "api_version = 0"),
        "it is written for version 0 of the plug-in contracts; this mpmkit supports versions 1 to 2; "
        "what has changed: docs/plugins.md#versions",
    ),
    "version as text": (
        LAW.replace("api_version = 2", 'api_version = "1"'),
        "its api_version is '1', which is text; it must be a whole number, such as 2",
    ),
    "version as truth value": (
        LAW.replace("api_version = 2", "api_version = True"),
        "its api_version is True, which is of type bool; it must be a whole number, such as 2",
    ),
    "version with a point": (
        LAW.replace("api_version = 2", "api_version = 1.0"),
        "its api_version is 1.0, which is of type float; it must be a whole number, such as 2",
    ),
    "no version": (
        LAW.replace("    api_version = 2\n", ""),
        "Slurry has no 'api_version'; for this mpmkit write api_version = 2",
    ),
    "no subclass": (LAW.replace("return [Slurry]", "return [int]"), "not a subclass of ConstitutiveLaw"),
    "no list": (LAW.replace("return [Slurry]", "return Slurry"), "must return a list of classes"),
    "registers nothing": ("x = 1\n", "registers nothing"),
    "empty list": (LAW.replace("return [Slurry]", "return []"), "registers nothing"),
    "raising hook": (LAW.replace("return [Slurry]", "return [1 / 0]"), "ZeroDivisionError"),
    "no citation": (LAW.replace('    citation = "nobody, nowhere (2024)"', ""), "has no 'citation'"),
    "upper-case name": (LAW.replace('"slurry"', '"Slurry"'), "must be of lower-case letters"),
    "abstract": (LAW.replace("def apparent_viscosity", "def apparent"), "lacks apparent_viscosity"),
    "reserved key": (LAW.replace("smallest_rate", "density"), "parameter 'density'"),
}


@pytest.fixture
def distribution(tmp_path, monkeypatch):
    """Makes a distribution with one entry point a module, found until the test is over."""
    monkeypatch.delenv("MPMKIT_PLUGINS")
    made = []

    def make(name, **sources):
        entries = []
        for entry, source in sources.items():
            module = f"{name.replace('-', '_')}_{entry}"
            made.append(module)
            (tmp_path / f"{module}.py").write_text(textwrap.dedent(source), encoding="utf-8")
            entries.append(f"law.{entry} = {module}")
        info = tmp_path / f"{name.replace('-', '_')}-1.2.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(
            f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.2\n", encoding="utf-8"
        )
        (info / "entry_points.txt").write_text("[mpmkit]\n" + "\n".join(entries) + "\n", encoding="utf-8")

    monkeypatch.syspath_prepend(tmp_path)
    installed.cache_clear()
    yield make
    installed.cache_clear()
    for module in made:
        sys.modules.pop(module, None)


def case(law="slurry", **changes):
    return {
        "space": "plane-strain",
        "until": 0.001,
        "grid": {"cell_size": 0.1, "domain": {"x": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
        "bodies": [
            {
                "shape": {"kind": "box", "lower": [0.2, 0], "upper": [0.6, 0.4]},
                "material": {
                    "law": law,
                    "density": 2000,
                    "yield_stress": 100,
                    "plastic_viscosity": 50,
                    "sound_speed": {"factor": 10},
                },
            }
        ],
        "scheme": {"time_step": {"ignore": ["viscous"]}},
        "output": {"report": False},
    } | changes


def status(*arguments):
    with pytest.raises(SystemExit) as stop:
        main([str(argument) for argument in arguments])
    return stop.value.code


def test_built_ins_have_no_problems():
    registry = discover()
    assert [p for p in registry.problems if p.distribution == "mpmkit"] == []
    assert all(registry.plugins.values())


@pytest.mark.parametrize(("source", "reason"), BROKEN.values(), ids=BROKEN)
def test_a_broken_plugin_is_reported_and_breaks_no_other(source, reason, distribution, tmp_path, capsys):
    distribution("broken-pack", slurry=source)
    distribution("good-pack", mud=LAW.replace('"slurry"', '"mud"'))

    assert status("plugins") == 0
    listed = capsys.readouterr()
    assert "mud" in listed.out
    assert "bingham" in listed.out
    assert "slurry" not in listed.out
    assert "plug-in 'law.slurry' of distribution 'broken-pack' is not usable" in listed.err
    assert reason in listed.err

    assert status("plugins", "--json") == 0
    (problem,) = json.loads(capsys.readouterr().out)["problems"]
    assert (problem["distribution"], problem["entry_point"]) == ("broken-pack", "law.slurry")
    assert reason in problem["reason"]

    path = tmp_path / "case.json"
    path.write_text(json.dumps(case()), encoding="utf-8")
    assert status("run", path, "--out", tmp_path / "run") == 2
    (sentence,) = capsys.readouterr().err.splitlines()
    assert '.law is "slurry"; it must be "bingham"' in sentence
    assert "'law.slurry' of distribution 'broken-pack'" in sentence
    assert reason in sentence
    assert not (tmp_path / "run").exists()

    parse_case(case("bingham"))
    parse_case(case("mud"))


def test_a_bad_plugin_leaves_the_good_ones_of_its_module(distribution):
    source = LAW.replace("return [Slurry]", "return [Slurry, int]")
    distribution("half-pack", slurry=source)
    registry = discover()
    assert "slurry" in registry.plugins["law"]
    assert [p.distribution for p in registry.problems] == ["half-pack"]


@pytest.mark.parametrize("name", ["bingham", "bingham-evp", "slurry"])
def test_two_of_one_name_are_both_refused(name, distribution):
    rivals = {"one-pack", "two-pack"} if name == "slurry" else {"one-pack", "mpmkit"}
    for rival in rivals - {"mpmkit"}:
        distribution(rival, wet=LAW.replace('"slurry"', f'"{name}"'))
    registry = discover()
    assert name not in registry.plugins["law"]
    assert {p.distribution for p in registry.problems} == rivals
    with pytest.raises(CaseError, match=f'law is "{name}"; it must be') as refused:
        parse_case(case(name), registry=registry)
    for rival in rivals:
        assert str(refused.value).count(f"of '{rival}'") == 1
    assert f"law '{name}' is registered by" in str(refused.value)
    assert "did you mean" not in str(refused.value)
    parse_case(case("newtonian", bodies=_newtonian()), registry=registry)


def test_a_misspelt_name_that_two_plugins_have(distribution):
    """That name was meant, and the clash is the reason; not another name that is near."""
    distribution("one-pack", wet=LAW.replace('"slurry"', '"bingham-evp"'))
    with pytest.raises(CaseError) as refused:
        parse_case(case("bingham-evpp"), registry=discover())
    assert "did you mean \"bingham-evp\"?; law 'bingham-evp' is registered by" in str(refused.value)
    assert "uninstall all but one of them" in str(refused.value)


def test_a_problem_of_another_kind_is_not_the_reason(distribution):
    distribution(
        "one-pack", usf=LAW.replace("api_version = 2", "api_version = 9").replace("slurry", "usf-ish")
    )
    with pytest.raises(CaseError, match="plug-ins that were not loaded are") as refused:
        parse_case(case("bingham", scheme={"order": "usf-ish"}), registry=discover())
    assert 'did you mean "usf"?' in str(refused.value)


def test_a_name_that_clashes_is_taken(distribution, tmp_path, capsys):
    distribution("one-pack", wet=LAW.replace('"slurry"', '"bingham-evp"'))
    assert status("new-plugin", "bingham-evp", "--kind", "law", "--out", tmp_path / "new") == 2
    assert "there is a constitutive law 'bingham-evp' already: law 'bingham-evp' is registered by" in (
        capsys.readouterr().err
    )
    assert not (tmp_path / "new").exists()


def test_a_kind_without_any_usable_plugin_is_told_of(distribution):
    source = """
        from mpmkit.contracts import VolumetricTreatment, hookimpl

        class Own(VolumetricTreatment):
            name = "{name}"
            api_version = 2
            citation = "nobody"

            def average(self, ops, field):
                return field

        @hookimpl
        def mpmkit_volumetric_treatments():
            return [{classes}]
    """
    names = list(discover().plugins["volumetric"])
    body = "".join(
        f"""
            class C{k}(Own):
                name = "{name}"
        """
        for k, name in enumerate(names)
    )
    text = textwrap.dedent(source).replace("{name}", "mine")
    text = text.replace("@hookimpl", textwrap.dedent(body) + "\n@hookimpl")
    distribution("greedy-pack", own=text.replace("{classes}", ", ".join(f"C{k}" for k in range(len(names)))))
    registry = discover()
    assert registry.plugins["volumetric"] == {}
    with pytest.raises(CaseError, match=r"scheme\.volumetric .*greedy-pack"):
        parse_case(case("bingham"), registry=registry)


def test_a_good_law_of_a_third_party_runs_from_the_command_line(distribution, tmp_path, capsys):
    distribution("slurry-pack", slurry=LAW)
    path = tmp_path / "case.json"
    path.write_text(json.dumps(case()), encoding="utf-8")
    assert status("run", path, "--out", tmp_path / "run", "--quiet") == 0
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    used = {p["name"]: p for p in summary["plugins"]}
    assert used["slurry"] == {
        "kind": "law",
        "name": "slurry",
        "distribution": "slurry-pack",
        "version": "1.2",
    }

    assert status("schema") == 0
    schema = json.loads(capsys.readouterr().out)
    parameters = schema["$defs"]["Material_Slurry"]["properties"]
    assert parameters["smallest_rate"]["unit"] == "1/s"
    assert "regularising" in parameters["smallest_rate"]["description"]

    path.write_text(json.dumps(case()).replace('"yield_stress": 100', '"yield_stres": 100'), encoding="utf-8")
    assert status("run", path, "--out", tmp_path / "other") == 2
    assert "unknown key 'yield_stres'; did you mean 'yield_stress'?" in capsys.readouterr().err


@pytest.mark.parametrize("asked", ["option", "empty variable", "another named"])
def test_third_parties_that_are_left_out_are_told_of_and_built_ins_stay(
    asked, distribution, tmp_path, monkeypatch, capsys
):
    distribution("slurry-pack", slurry=LAW)
    distribution("Mud_Pack", mud=LAW.replace('"slurry"', '"mud"'))
    monkeypatch.setenv("MPMKIT_PLUGINS", "mud-pack" if asked == "another named" else "")
    option = []
    if asked == "option":
        del os.environ["MPMKIT_PLUGINS"]
        option = ["--no-plugins"]
    why = "because MPMKIT_PLUGINS is 'mud-pack'" if asked == "another named" else "because of --no-plugins"

    path = tmp_path / "case.json"
    path.write_text(json.dumps(case()), encoding="utf-8")
    assert status("run", path, "--out", tmp_path / "run", *option) == 2
    (sentence,) = capsys.readouterr().err.splitlines()
    assert 'bodies.0.material.law is "slurry"; it must be "bingham"' in sentence
    assert f"plug-in 'law.slurry' of distribution 'slurry-pack' was left out, {why}" in sentence
    assert not (tmp_path / "run").exists()

    assert status(*option, "plugins") == 0
    listed = capsys.readouterr()
    assert "bingham" in listed.out
    assert ("mud" in listed.out) == (asked == "another named")
    assert "'slurry-pack' was left out" in listed.err
    parse_case(case("bingham"))


def test_a_named_distribution_that_is_not_there_is_told_of(distribution, monkeypatch):
    distribution("mud-pack", mud=LAW.replace('"slurry"', '"mud"'))
    monkeypatch.setenv("MPMKIT_PLUGINS", "mud-pack, no-such-pack")
    registry = discover()
    assert {"mud", "bingham"} <= set(registry.plugins["law"])
    (problem,) = [p for p in registry.problems if p.distribution == "no-such-pack"]
    assert "is not installed, though MPMKIT_PLUGINS names it" in str(problem)


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
    """Once it has been asked a few times; the summary says so, and other cases run on."""
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
    """With status 3 and a word, where it was 0 and none; what was computed is kept."""
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


def _newtonian():
    (body,) = case()["bodies"]
    body["material"] = {"law": "newtonian", "density": 1000, "viscosity": 1.0, "sound_speed": 10}
    return [body]


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
    """Whatever way it prints, at import and in calls: the standard output is for results."""
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


def test_a_problem_of_one_plugin_is_not_told_of_another_with_a_similar_name(distribution):
    source = LAW.replace('"slurry"', '"slurry-evp"').replace("api_version = 2", "api_version = 9")
    distribution("old-pack", slurry_evp=source)
    registry = discover()
    assert len(registry.why_not("law", "slurry-evp")) == 1
    assert registry.why_not("law", "slurry") == []
