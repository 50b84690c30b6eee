"""Cheaper models of a scene: they model the same scene, they are offered only where they are admissible, and
their errors are known."""

from __future__ import annotations

import csv
import json
import shlex
from importlib.resources import files
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from mpmkit.case import load_case, parse_case
from mpmkit.case.plugins import cautions
from mpmkit.case.resolved import resolved
from mpmkit.cli.commands import execute
from mpmkit.contracts import ElastoviscoplasticLaw
from mpmkit.plan import cheaper_models, expected_error, plan
from mpmkit.running.execution import _interrupted
from mpmkit.solver.memory import expected_particles

CASES = Path(__file__).parents[1] / "cases"
ROUND = {"kind": "cylinder", "radius": 0.1, "height": 0.3, "base": [0.1, 0.2, 0.0]}
BRICK = {"kind": "box", "lower": [0.0, 0.1, 0.0], "upper": [0.2, 0.3, 0.2]}
FLUID = {"law": "bingham", "density": 2000, "yield_stress": 100, "plastic_viscosity": 20, "sound_speed": 50}


def scene(*shapes, **changes):
    """Bodies at x = 0.1, y = 0.2 in a domain whose middle that is."""
    bodies = [{"shape": shape, "material": FLUID | {"regularisation": 100}} for shape in shapes or (ROUND,)]
    data = {
        "space": "3d",
        "until": 0.5,
        "grid": {"cell_size": 0.01, "domain": {"x": [-0.3, 0.5], "y": [-0.2, 0.6], "z": [0, 0.35]}},
        "bodies": bodies,
    }
    return parse_case(data, [f"{path}={json.dumps(value)}" for path, value in changes.items()])


def names(case):
    return [model.name for model in cheaper_models(case)]


def mass(case):
    return sum(body.material.density * body.shape.volume(case.space_) for body in case.bodies)


def test_a_body_of_revolution_and_a_quarter_are_the_same_material():
    case = scene()
    models = {model.name: model.case for model in cheaper_models(case)}
    assert mass(models["axisymmetric"]) == pytest.approx(mass(case), rel=1e-12)
    assert expected_particles(models["a quarter"]) == pytest.approx(expected_particles(case) / 4, rel=1e-9)
    assert expected_particles(models["axisymmetric"]) == pytest.approx(4 * 0.1 * 0.3 / 0.01**2, rel=1e-9)


@pytest.mark.parametrize(
    "changes",
    [
        {"bodies.0.velocity": [0.1, 0, 0]},
        {"bodies.0.velocity": {"amplitude": [0, 0, 1], "wave_vector": [1, 0, 0]}},
        {"gravity": [1.0, 0, -9.81]},
        {"grid.faces": {"x_min": "periodic", "x_max": "periodic"}},
        {"grid.faces": {"x_min": "slip"}},
    ],
    ids=json.dumps,
)
def test_what_is_not_symmetric_is_not_cut(changes):
    assert {"axisymmetric", "a quarter"}.isdisjoint(names(scene(**changes)))


def test_a_fall_is_symmetric():
    fallen = scene(**{"bodies.0.velocity": [0, 0, -1.5]})
    models = {model.name: model.case for model in cheaper_models(fallen)}
    assert models["axisymmetric"].bodies[0].velocity == [0.0, -1.5]
    assert models["a quarter"].bodies[0].velocity == [0, 0, -1.5]


def test_walls_on_both_sides_leave_a_quarter_and_no_body_of_revolution():
    faces = {"x_min": "stick", "x_max": "stick", "y_min": "slip", "y_max": "slip", "z_min": "stick"}
    found = {model.name: model.case for model in cheaper_models(scene(**{"grid.faces": faces}))}
    assert "axisymmetric" not in found
    quarter = found["a quarter"].grid
    assert quarter.domain == {"x": [0.1, 0.5], "y": [0.2, 0.6], "z": [0, 0.35]}
    assert quarter.faces == faces | {"x_min": "symmetry", "y_min": "symmetry"}


def test_a_brick_has_a_quarter_and_does_not_turn():
    found = names(scene(BRICK))
    assert "a quarter" in found
    assert "axisymmetric" not in found


def test_two_bodies_need_one_axis():
    sphere = {"kind": "sphere", "radius": 0.02, "centre": [0.1, 0.2, 0.33]}
    assert "axisymmetric" in names(scene(ROUND, sphere))
    found = names(scene(ROUND, sphere | {"centre": [0.15, 0.2, 0.33]}))
    assert {"axisymmetric", "a quarter"}.isdisjoint(found)


def test_a_quarter_model_can_be_turned_but_not_cut_again():
    found = names(load_case(CASES / "slump_quarter.json"))
    assert "axisymmetric" in found
    assert "a quarter" not in found


@pytest.mark.parametrize("file", sorted(CASES.glob("*.json")), ids=lambda file: file.stem)
def test_the_options_as_typed_make_the_model(file):
    """Each option is valid: the reader of cases refuses none."""
    case = load_case(file)
    for model in cheaper_models(case):
        assert resolved(load_case(file, model.options)) == resolved(model.case), model.name
        assert expected_particles(model.case) <= expected_particles(case)


def test_exact_yield_has_the_same_flow_curve():
    case = scene(**{"scheme.time_step": {"fraction": 0.3, "ignore": ["viscous"]}})
    (exact,) = (model.case for model in cheaper_models(case) if model.name == "exact yield")
    law, rates = exact.bodies[0].material.constitutive_law, np.geomspace(0.1, 100, 20)
    assert isinstance(law, ElastoviscoplasticLaw)
    np.testing.assert_allclose(law.flow_curve(rates), 100 + 20 * rates, rtol=1e-12)
    assert exact.scheme.time_step.ignore == []


def test_together_has_the_cheapest_of_every_kind():
    together = cheaper_models(load_case(CASES / "slump_ferreira.json"))[-1].case
    assert together.space == "axisymmetric"
    assert together.height / together.grid.cell_size == pytest.approx(15)
    assert together.bodies[0].material.law == "herschel-bulkley-evp"
    assert together.bodies[0].material.sound_speed.mach == 0.1


def test_a_cheap_case_gets_no_advice():
    assert cheaper_models(load_case(CASES / "slump_fast.json")) == []
    assert cheaper_models(load_case(CASES / "vibrating_bar.json")) == []


# --- The error to expect


def rows():
    with (files("mpmkit.plan") / "slump_errors.csv").open() as lines:
        return list(csv.DictReader(lines))


def member(**key):
    """The error of a member of the study, by default that of the schemes of slump.json."""
    default = {"dim": "2", "shape": "cpgimp", "order": "usl", "volumetric": "nodal-average", "law": "exact"}
    wanted = default | {"sound": "mach 0.1"} | key
    found = [row for row in rows() if wanted.items() <= row.items()]
    return float(max(found, key=lambda row: int(row["cells"]))["error"])


RELAXED = ["bodies.0.material.law=herschel-bulkley", "bodies.0.material.form=relaxed"]
SOUNDS = {"mach 0.1": {"mach": 0.1}, "factor 10": {"factor": 10}, "factor 20": {"factor": 20}}


@pytest.mark.parametrize(
    "row", [row for row in rows() if row["dim"] == "2"][::7], ids=lambda row: "-".join(row.values())
)
def test_a_member_of_the_study_has_its_own_error(row):
    law = [*RELAXED, "bodies.0.material.regularisation=100"]
    cell = 0.3 / int(row["cells"])
    case = load_case(
        CASES / "slump.json",
        [
            f"grid.cell_size={cell}",
            f'grid.domain={{"r": [0, 0.36], "z": [0, {0.3 + cell}]}}',
            *(f"scheme.{kind}={row[kind]}" for kind in ("shape", "order", "volumetric")),
            f"bodies.0.material.sound_speed={json.dumps(SOUNDS[row['sound']])}",
            *(law if row["law"] == "relaxed" else []),
        ],
    )
    assert expected_error(case) == (float(row["error"]) if row["error"] else None)


def test_finer_cells_than_the_studys_have_the_error_of_its_finest():
    fine = load_case(CASES / "slump.json")
    assert expected_error(fine) == expected_error(
        load_case(CASES / "slump.json", ["grid.cell_size=0.01", "grid.domain.z=[0, 0.31]"])
    )
    as_the_study = "bodies.0.particles_per_cell=8"
    assert expected_error(load_case(CASES / "slump_quarter.json", [as_the_study])) == member(dim="3")
    assert expected_error(load_case(CASES / "slump_quarter.json")) is None  # it has 27


WATER = ["bodies.0.material.yield_stress=0", "bodies.0.material.consistency=0.001"]
UNKNOWN = {
    "coarser than the study": ["grid.cell_size=0.03", "grid.domain.z=[0, 0.33]"],
    "a slow sound": ['bodies.0.material.sound_speed={"factor": 5}'],
    "a fast sound": ['bodies.0.material.sound_speed={"factor": 200}'],
    "a large Mach number": ['bodies.0.material.sound_speed={"mach": 0.3}'],
    "stopped in the study": ["scheme.shape=linear"],
    "velocity pic": ["scheme.velocity=pic"],
    "velocity flip": ["scheme.velocity=flip"],
    "a rate of apic": ["scheme.velocity.rate=0"],
    "a stick floor": ["grid.faces.z_min=stick"],
    "a friction floor": ['grid.faces.z_min={"kind": "friction", "coefficient": 0.4}'],
    "a wall at the side": ["grid.faces.r_max=slip"],
    "fixed boxes": ["scheme.shape.domain=fixed"],
    "splitting": ["scheme.splitting=true"],
    "no redistribution": ["scheme.redistribution=none"],
    "no relaxation": ["scheme.volumetric.relaxation=0"],
    "one particle a cell": ["bodies.0.particles_per_cell=1"],
    "nine particles per cell": ["bodies.0.particles_per_cell=9"],
    "water": WATER,
    "another yield stress": ["bodies.0.material.yield_stress=100"],
    "another density": ["bodies.0.material.density=2300"],
    "another modulus": ["bodies.0.material.shear_modulus=1e6"],
    "m = 1 s": [*RELAXED, "bodies.0.material.regularisation=1"],
    "not relaxed": [RELAXED[0], "bodies.0.material.regularisation=100"],
    "another law": ["bodies.0.material=" + json.dumps(FLUID | {"law": "bingham-evp"})],
    "a longer step": ["scheme.time_step.fraction=0.5"],
    "no viscous limit": ['scheme.time_step.ignore=["viscous"]'],
    "another height": ["bodies.0.shape.height=0.25"],
    "it is thrown": ["bodies.0.velocity=[0, -1]"],
    "less gravity": ["gravity=[0, -1.62]"],
    "a narrow domain": ["grid.domain.r=[0, 0.2]"],
    "plane strain": ["space=plane-strain", 'grid.domain={"x": [-0.5, 0.5], "z": [0, 0.31]}'],
}


@pytest.mark.parametrize("changes", UNKNOWN.values(), ids=UNKNOWN)
def test_a_case_that_differs_in_something_else_has_no_known_error(changes):
    assert expected_error(load_case(CASES / "slump.json", changes)) is None


KNOWN = {
    "relaxed": [*RELAXED, "bodies.0.material.regularisation=100"],
    "other names for the same": ["gravity=[0, -9.81]", "grid.faces.r_min=symmetry", "grid.faces.r_max=open"],
    "what is written": ["output.report=false", "name=other", "until=1.5"],
    "a wider domain": ["grid.domain.r=[0, 0.5]"],
}


@pytest.mark.parametrize("changes", KNOWN.values(), ids=KNOWN)
def test_a_change_without_influence_on_the_flow_keeps_the_error_known(changes):
    law = "relaxed" if changes[0] == RELAXED[0] else "exact"
    assert expected_error(load_case(CASES / "slump.json", changes)) == member(law=law)


def test_other_scenes_have_no_known_error():
    for name in ("two_discs", "film", "slump_ferreira", "slump_as_published", "vibrating_bar"):
        assert expected_error(load_case(CASES / f"{name}.json")) is None, name


def test_a_scene_with_walls_has_no_known_error():
    """The study has no walls; the lifted mould is its slump otherwise."""
    lifted = load_case(CASES / "slump_lifted.json")
    assert expected_error(lifted) is None
    assert expected_error(lifted.model_copy(update={"walls": {}})) is not None


def test_the_study_that_plan_knows_is_the_shipped_one():
    study = json.loads((files("mpmkit.plan") / "slump_study.json").read_text(encoding="utf-8"))
    shipped = json.loads((CASES / "studies/accuracy_vs_cost.json").read_text(encoding="utf-8"))
    base = json.loads((CASES / "slump.json").read_text(encoding="utf-8"))
    del base["$schema"]
    assert {"description": base["description"], **study["case"]} == base
    models = shipped["vary"]["model"]
    assert study["models"] == {
        "axisymmetric": models["axisymmetric, 20 mm"],
        "3d": models["quarter, 20 mm"],
    }
    assert study["laws"]["relaxed"] == shipped["vary"]["law"]["relaxed"]


def test_combinations_that_failed_in_the_study_get_a_caution():
    """Every combination of schemes of which a member was stopped, and none of which all have finished."""
    kinds = ("shape", "order", "volumetric")
    stopped = {tuple(row[kind] for kind in kinds) for row in rows() if row["fate"] != "finished"}
    for chosen in {tuple(row[kind] for kind in kinds) for row in rows()}:
        schemes = [f"scheme.{kind}={name}" for kind, name in zip(kinds, chosen, strict=True)]
        said = " ".join(cautions(load_case(CASES / "slump.json", schemes)))
        assert ("throw" in said) == (chosen in stopped), chosen


def test_other_known_failures_get_a_caution():
    stick = ['grid.faces={"z_min": "stick"}']
    assert "locks" in " ".join(cautions(load_case(CASES / "slump.json", [*stick, "scheme.volumetric=own"])))
    assert cautions(load_case(CASES / "slump.json", stick)) == []
    water = ["bodies.0.material.yield_stress=0", "bodies.0.material.consistency=0.001"]
    none = "scheme.redistribution=none"
    lasting, torn = [*water, "until=30"], "scheme.splitting=false"
    own = "scheme.volumetric=own"
    for change in ("scheme.splitting=true", torn, own):  # which do not cure it
        said = " ".join(cautions(load_case(CASES / "slump.json", [*lasting, none, change])))
        assert "redistribution 'none' does not keep positions and volumes of a fluid consistent" in said
        assert "'even' keeps them consistent" in said
    even = "scheme.redistribution=even"  # keeps the volume of water, see tests/validation/test_long_shear.py
    assert cautions(load_case(CASES / "slump.json", [*lasting, torn, even])) == []
    assert cautions(load_case(CASES / "slump.json", [*water, none, torn])) == []
    assert cautions(load_case(CASES / "slump.json", ["until=30", none])) == []  # it is at rest by then
    assert "damps" in " ".join(cautions(load_case(CASES / "slump.json", ["scheme.velocity=pic"])))


def test_a_film_is_cautioned_of_what_goes_wrong_in_it_and_of_nothing_else():
    """A film that flows for long gets the caution about density, with a yield stress and with own volumes
    too; it does not lock."""
    film = ["scheme.redistribution=none"]
    assert cautions(load_case(CASES / "film.json", film)) == []
    for volumetric in ("own", "nodal-average"):
        longer = [*film, "until=5", f"scheme.volumetric={volumetric}"]
        (said,) = cautions(load_case(CASES / "film.json", longer))
        assert "redistribution 'none' does not keep positions and volumes of a fluid consistent" in said


# --- In the plan


def test_the_plan_counts_what_cheaper_models_cost(monkeypatch):
    monkeypatch.setattr("mpmkit.plan.cost.WORTH_ADVICE", 0.0)
    monkeypatch.setattr("mpmkit.plan.trial.TRIAL_SECONDS", 0.2)
    cost = plan(scene(**{"grid.cell_size": 0.02, "grid.domain.z": [0, 0.36], "until": 0.2}), threads=1)
    lines = {line["name"]: line for line in cost["cheaper"]}
    assert {"a quarter", "axisymmetric", "exact yield", "all of these"} <= set(lines)
    assert lines["a quarter"]["particles"] == pytest.approx(cost["particles"] / 4, rel=0.05)
    assert lines["exact yield"]["steps"] < cost["steps"] / 5  # no viscous limit
    assert lines["all of these"]["expected_seconds"] < lines["a quarter"]["expected_seconds"]
    json.dumps(cost, allow_nan=False)


def test_the_commands_run_the_case_as_it_was_asked_for(monkeypatch, tmp_path, capsys):
    """The printed commands repeat all options, such as another material or time."""
    monkeypatch.setattr("mpmkit.plan.cost.WORTH_ADVICE", 0.0)
    monkeypatch.setattr("mpmkit.plan.trial.TRIAL_SECONDS", 0.05)
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "a case.json"
    coarse = {"grid.cell_size": 0.02, "grid.domain.z": [0, 0.36], "grid.faces": {"z_min": "slip"}}
    coarse["output"] = {"report": False}
    file.write_text(json.dumps(scene(**coarse).model_dump(mode="json", exclude_unset=True)))
    asked = ["bodies.0.material.yield_stress=50", "description=it's mine", "bodies.0.material.density=1900"]
    options = [word for override in asked for word in ("--set", override)]
    assert execute(["plan", file.name, *options, "--until", "0.05", "--threads", "1"]) == 0
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    commands = [shlex.split(line) for line in lines if line.startswith("mpmkit run ")]
    models = {}
    for model in cheaper_models(load_case(file, [*asked, "until=0.05"])):
        models[json.dumps(resolved(model.case), sort_keys=True)] = model.name
    assert len(commands) >= 3
    for command in commands:
        sets = [command[at + 1] for at, word in enumerate(command) if word == "--set"]
        assert command[command.index("--until") + 1] == "0.05"
        case = load_case(command[2], [*sets, "until=0.05"])
        assert case.bodies[0].material.yield_stress == 50
        assert case.description == "it's mine"
        assert models.pop(json.dumps(resolved(case), sort_keys=True))
    cheapest = commands[-1]
    assert execute([*cheapest[1:], "--out", "run", "--quiet"]) == 0
    written = load_case("run/case.json")
    assert (written.space, written.until) == ("axisymmetric", 0.05)
    assert written.bodies[0].material.density == 1900


def test_the_command_that_goes_on_with_a_run_can_be_typed_as_it_stands(tmp_path):
    (tmp_path / "step_000000000001.checkpoint").touch()
    directory = SimpleNamespace(path=Path("runs/it's mine"), checkpoints=tmp_path)
    stopped = SimpleNamespace(simulation=SimpleNamespace(time=1.0), directory=directory)
    said = _interrupted(stopped)
    typed = shlex.split(said.partition("go on with: ")[2])
    assert typed == ["mpmkit", "run", "--resume", "runs/it's mine"]


def test_a_run_of_seconds_needs_no_advice():
    cost = plan(load_case(CASES / "slump_fast.json", ["until=0.05"]), threads=1)
    assert cost["cheaper"] == []
    fast = [
        row for row in rows() if row["cells"] == "15" and row["dim"] == "2" and row["sound"] == "mach 0.1"
    ]
    schemes = {"shape": "cpgimp", "order": "usl", "volumetric": "nodal-average", "law": "exact"}
    assert cost["expected_error"] == next(
        float(row["error"]) for row in fast if schemes.items() <= row.items()
    )


def test_navier_slip_says_how_wrong_its_slip_may_be():
    def contact(length):
        slips = f'walls.mould.contact={{"kind": "navier-slip", "slip_length": {length}}}'
        return " ".join(cautions(load_case(CASES / "slump_lifted.json", [slips])))

    assert "too large, by" in contact(0.01)
    assert "navier" not in contact(0)
