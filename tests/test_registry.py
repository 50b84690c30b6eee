"""Discovery of plug-ins: a faulty third-party distribution is reported and disturbs no other plug-in."""

import json
import os
import textwrap

import pytest
from third_party import LAW, case, status

from mpmkit.case import parse_case
from mpmkit.errors import CaseError
from mpmkit.registry import discover

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
    """The message gives the clash as the reason, and does not propose another similar name."""
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


def test_a_kind_without_any_usable_plugin_is_reported(distribution):
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
def test_third_parties_that_are_left_out_are_reported_and_built_ins_stay(
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


def test_a_named_distribution_that_is_missing_is_reported(distribution, monkeypatch):
    distribution("mud-pack", mud=LAW.replace('"slurry"', '"mud"'))
    monkeypatch.setenv("MPMKIT_PLUGINS", "mud-pack, no-such-pack")
    registry = discover()
    assert {"mud", "bingham"} <= set(registry.plugins["law"])
    (problem,) = [p for p in registry.problems if p.distribution == "no-such-pack"]
    assert "is not installed, though MPMKIT_PLUGINS names it" in str(problem)


def _newtonian():
    (body,) = case()["bodies"]
    body["material"] = {"law": "newtonian", "density": 1000, "viscosity": 1.0, "sound_speed": 10}
    return [body]
