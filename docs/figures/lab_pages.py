"""Run the shipped tests of the laboratory, and write a page of each, docs/lab/*.md, with its picture,
docs/images/lab/*.png, the gallery docs/lab/index.md, and the work of all shipped cases,
mpmkit/plan/shipped_work.csv.

    python docs/figures/lab_pages.py                      # from the record, and from new runs in runs/lab
    python docs/figures/lab_pages.py --run [NAME…]        # run these cases first, default: the laboratory
    python docs/figures/lab_pages.py --run NAME… --fine   # and their fine variants

What a run has found is recorded in docs/data/laboratory.json, so that a page can be written without its run.
"""

from __future__ import annotations

import argparse
import csv
import json
import subprocess
import sys
from pathlib import Path

import xarray
from common import DOCS
from plan_view import draw_plan

from mpmkit.case import load_case, parse_case
from mpmkit.case.load import read_json
from mpmkit.case.parameters import Parameter, fine, has_fine, parameters
from mpmkit.case.shipped import LABORATORY, shipped
from mpmkit.output import RunDirectory
from mpmkit.plan.shipped_times import FILE as WORK
from mpmkit.report import write_report
from mpmkit.rheology.laboratory import FORMULAS, THIN
from mpmkit.solver.memory import expected_particles
from mpmkit.solver.scene import material_group
from mpmkit.solver.time_step import choose_step, limits

WORDS = json.loads(Path(__file__).with_name("lab_words.json").read_text(encoding="utf-8"))
"""Title, a remark on the closed forms, and what the model leaves out, by the name of the case."""
RUNS = DOCS.parent / "runs" / "lab"
RECORD, FINE = DOCS / "data" / "laboratory.json", "-fine"
STATE = ("particles", "steps", "simulated_time", "at_rest_since")
"""Figures of every summary that a page shows."""
PAGES, IMAGES = DOCS / "lab", DOCS / "images" / "lab"
SHARED = {
    "slump_flow": ["t500_from_lift", "at_rest_since"],
    "j_ring": ["t500_from_lift", "at_rest_since"],
    "slump_test": ["final_height"],
    "standing_layer": ["final_spread"],
    "barrier": ["largest_force", "at_rest_since"],
}
"""Figures of the summary that a page shows beside what the case measures."""
FROM_ABOVE = ("j_ring",)
"""Cases with a second picture, of the deposit from above."""
LARGEST = {"barrier": {"largest_force": "force_on_barrier"}}
"""Figures that are the largest value of a measurement in the history, and the name of that measurement."""
EXPLAINED = {
    "largest_force": "largest horizontal force on the barrier, as the flow arrives",
    "t500_from_lift": "t500: time to 500 mm from the start of the lift",
    "at_rest_since": "time from which the material is at rest",
    "final_height": "height at the end",
    "final_spread": "width at the end",
}
DEPOSITS = "../theory.md#layers-that-come-to-rest"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--run", nargs="*", metavar="NAME", help="cases to run first; default: all")
    parser.add_argument("--fine", action="store_true", help="run their fine variants, too")
    chosen = parser.parse_args()
    laboratory = [name for name, path in shipped().items() if path.parent.name == LABORATORY]
    if chosen.run is not None:
        for name in chosen.run or laboratory:
            run(name, read_json(shipped()[name]))
            if chosen.fine:
                run(f"{name}{FINE}", fine(read_json(shipped()[name])))
    PAGES.mkdir(exist_ok=True)
    IMAGES.mkdir(exist_ok=True)
    for name in shipped():
        for variant in ("", FINE):
            if (RUNS / f"{name}{variant}" / "summary.json").exists():
                record(name, variant)
        if name in laboratory and (RUNS / name / "summary.json").exists():
            draw(name)
    done = [name for name in laboratory if name in recorded()]
    for name in done:
        (PAGES / f"{name}.md").write_text(page(name), encoding="utf-8")
    (PAGES / "index.md").write_text(gallery(done), encoding="utf-8")
    write_work()


def run(name: str, data: dict) -> None:
    RUNS.mkdir(parents=True, exist_ok=True)
    case = RUNS / f"{name}.json"
    case.write_text(json.dumps(data), encoding="utf-8")
    command = [sys.executable, "-m", "mpmkit", "run", case, "--threads", "1", "--quiet"]
    subprocess.run([*command, "--out", RUNS / name, "--overwrite"], check=True)


def recorded() -> dict[str, dict]:
    """What runs have found, by the name of the case, with the ending FINE for its fine variant."""
    return json.loads(RECORD.read_text(encoding="utf-8"))


def record(name: str, variant: str) -> None:
    """Take over from a summary what pages show."""
    summary = json.loads((RUNS / f"{name}{variant}" / "summary.json").read_text(encoding="utf-8"))
    for key, measured in LARGEST.get(name, {}).items():
        with xarray.open_dataset(RUNS / f"{name}{variant}" / "history.nc") as history:
            summary[key] = float(history[measured].max())
        summary["units"][key] = summary["units"][measured]
    units = {key: summary["units"][key] for key in reported(name)}
    found = {key: summary[key] for key in (*reported(name), *STATE)}
    work = round(summary["particle_steps_per_second"] * summary["wall_time"])
    every = recorded() | {name + variant: found | {"particle_steps": work, "units": units}}
    RECORD.write_text(json.dumps(dict(sorted(every.items())), indent=1) + "\n", encoding="utf-8")


def reported(name: str) -> dict[str, str]:
    """What a case reports: its measurements, and figures of the summary; each with its meaning."""
    data = read_json(shipped()[name])
    measured = {key: entry["description"] for key, entry in data.get("measurements", {}).items()}
    return measured | {key: EXPLAINED[key] for key in SHARED.get(name, [])}


def draw(name: str) -> None:
    """The picture of a run, unless it is there and younger than the run."""
    picture, summary = IMAGES / f"{name}.png", RUNS / name / "summary.json"
    if not picture.exists() or picture.stat().st_mtime < summary.stat().st_mtime:
        write_report(RUNS / name)
        picture.write_bytes((RunDirectory(RUNS / name).report / "outline.png").read_bytes())
        if name in FROM_ABOVE:
            draw_plan(RUNS / name, IMAGES / f"{name}_above.png")


def page(name: str) -> str:
    """The page of a case, from its file and its run."""
    data = read_json(shipped()[name])
    title, remark, left_out = (WORDS[name][key] for key in ("title", "remark", "left_out"))
    given, summary = parameters(data), recorded()[name]
    lines = [f"# {title}", "", data["description"], "", "```", f"mpmkit init {name} --set yield_stress=…"]
    lines += [f"mpmkit run {name}.json", "```", "", "## Apparatus and material", ""]
    lines += table(["parameter", "value", "meaning"], [apparatus(key, entry) for key, entry in given.items()])
    lines += ["", "## What the run gives", "", f"![{title}](../images/lab/{name}.png)", ""]
    if name in FROM_ABOVE:
        lines += [f"![{title}, from above](../images/lab/{name}_above.png)", ""]
    lines += table(
        ["reported", "value", "meaning"],
        [
            (f"`{key}`", shown(summary[key], summary["units"][key]), meaning)
            for key, meaning in reported(name).items()
        ],
    )
    lines += ["", f"{summary['particles']:,} particles, {summary['steps']:,} steps, to t = "
              f"{summary['simulated_time']:g} s; {state(summary)}.", ""]  # fmt: skip
    if name in FORMULAS:
        lines += ["## Held against", ""]
        head = ["closed form", "its value", "the run", "difference"]
        lines += table(head, list(held(name, given, summary)))
        lines.append("")
    if name + FINE in recorded():
        lines += [*finer(name, parameters(fine(data)), recorded()[name + FINE]), ""]
    lines += [remark, ""] if remark else []
    if any(formula.words == THIN for formula in FORMULAS.get(name, [])):
        lines += [
            f"[Layers that come to rest]({DEPOSITS}) explains why the second value is too large "
            "and the first is not.",
            "",
        ]
    lines += ["## What the model leaves out", ""]
    lines += [f"- {item}" for item in left_out]
    return "\n".join(lines) + "\n"


def title_of(name: str) -> str:
    return WORDS[name]["title"]


def apparatus(key: str, entry: Parameter) -> tuple[str, str, str]:
    return f"`{key}`", shown(entry.value, entry.unit), entry.description


def held(name: str, given: dict[str, Parameter], summary: dict):
    """A row for each closed form: its number, that of the run, and the difference."""
    values = {key: entry.value for key, entry in given.items()}
    for formula in FORMULAS[name]:
        said, found, unit = (
            formula.value(values),
            summary[formula.measured],
            summary["units"][formula.measured],
        )
        difference = f"{100 * (found / said - 1):+.1f} %" if said else "–"
        yield formula.words, shown(said, unit), shown(found, unit), difference


def finer(name: str, given: dict[str, Parameter], summary: dict) -> list[str]:
    """A paragraph on the run of the fine variant."""
    changed = [key for key, entry in read_json(shipped()[name])["parameters"].items() if "fine" in entry]
    variant = ", ".join(f"`{key}` {shown(given[key].value, given[key].unit)}" for key in changed)
    key = measured_first(name)
    found, coarse = (which[key] for which in (summary, recorded()[name]))
    lines = [
        f"The fine variant ({variant}; {summary['particles']:,} particles at the end, {summary['steps']:,} "
        f"steps) gives `{key}` {shown(found, summary['units'][key])}; the run above is "
        f"{100 * (coarse / found - 1):+.1f} % from it."
    ]
    if name in FORMULAS:
        *_, difference = next(held(name, given, summary))
        lines[0] += f" The difference of the fine variant to the first closed form is {difference}."
    return lines


def measured_first(name: str) -> str:
    """The number for which a test is done."""
    if name in FORMULAS:
        return FORMULAS[name][0].measured
    return next(iter(read_json(shipped()[name])["measurements"]))


def state(summary: dict) -> str:
    since = summary["at_rest_since"]
    return "the material is still moving at the end" if since is None else f"at rest since t = {since:.3g} s"


def shown(value: float | None, unit: str) -> str:
    if value is None:
        return "–"
    if unit == "m" and abs(value) < 2:
        return f"{1e3 * value:.4g} mm"
    if unit == "m/s" and abs(value) < 2:
        return f"{1e3 * value:.4g} mm/s"
    return f"{value:.4g}" + ("" if unit == "1" else f" {unit}")


def table(head: list[str], rows: list[tuple[str, ...]]) -> list[str]:
    return [f"| {' | '.join(cells)} |" for cells in [head, ["---"] * len(head), *rows]]


def gallery(done: list[str]) -> str:
    """The page that shows all pictures."""
    lines = [
        "# The laboratory",
        "",
        "Common laboratory tests, each with one command. `mpmkit cases` lists them with the time that each",
        "takes on this machine, `mpmkit init NAME` writes one with its parameters at the top, and",
        "`mpmkit run FILE` runs it. The runs on these pages are the coarse variants, as shipped. `--fine`",
        "writes the fine variant.",
        "",
    ]
    rows = []
    for name in done:
        summary, given = recorded()[name], parameters(read_json(shipped()[name]))
        measured = measured_first(name)
        found = f"{measured}: {shown(summary[measured], summary['units'][measured])}"
        first = next(held(name, given, summary), None) if name in FORMULAS else None
        rows.append(
            (f"[{title_of(name)}]({name}.md)", found, "–" if first is None else f"{first[1]} ({first[3]})")
        )
    lines += table(["test", "the run gives", "closed form (difference)"], rows)
    for name in done:
        lines += [
            "",
            f"## {title_of(name)}",
            "",
            f"[![{title_of(name)}](../images/lab/{name}.png)]({name}.md)",
        ]
    lines += ["", "```{toctree}", ":hidden:", "", *done, "```"]
    return "\n".join(lines) + "\n"


def write_work() -> None:
    """Steps and particle-steps of all shipped cases: of recorded runs, else from their first step."""
    with WORK.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["name", "variant", "dimensions", "steps", "particle_steps"])
        for name, path in shipped().items():
            data, case = read_json(path), load_case(path)
            steps, particle_steps = expected = first_step(case)
            if name in recorded():
                steps, particle_steps = work(name)
            rows.writerow([name, "coarse", case.space_.dim, steps, round(particle_steps)])
            if has_fine(data):
                finer = first_step(parse_case(fine(data)))
                row = [steps * finer[0] / expected[0], particle_steps * finer[1] / expected[1]]
                if name + FINE in recorded():
                    row = list(work(name + FINE))
                rows.writerow([name, "fine", case.space_.dim, *(round(value) for value in row)])


def work(name: str) -> tuple[int, int]:
    """Steps and particle-steps of a recorded run."""
    return recorded()[name]["steps"], recorded()[name]["particle_steps"]


def first_step(case) -> tuple[int, int]:
    """Steps and particle-steps of a run that goes on with its first step."""
    groups = [material_group(case, one.material, slice(0, 0)) for one in case.filled]
    fastest = max(
        [*map(case.speed_at_start, case.bodies)]
        + [case.source_speed(name, 0.0, case.end) for name in case.sources]
    )
    waves = [(group, group.wave_speed) for group in groups]
    step, _ = choose_step(case.scheme, limits(waves, case.grid.cell_size, fastest, case.scale.rate))
    steps = round(case.end / step)
    return steps, steps * expected_particles(case)


if __name__ == "__main__":
    main()
