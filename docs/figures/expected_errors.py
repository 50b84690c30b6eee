"""Write mpmkit/plan/slump_errors.csv, the errors that ``plan`` tells of cheaper models, and slump_study.json,
the study's base case with what its models and laws change of it.

    mpmkit study cases/studies/accuracy_vs_cost.json && python docs/figures/expected_errors.py

A row a member: what it ran with, how it ended, and the largest departure of its spread from the reference, as
part of the reference's largest value.
"""

import csv
import json
from pathlib import Path

import numpy as np
import xarray
from common import DOCS, REFERENCE
from options import parser, require

from mpmkit.case import parse_case
from mpmkit.study.figures import members

OUT = DOCS.parent / "mpmkit/plan/slump_errors.csv"
STUDY = DOCS.parent / "cases/studies/accuracy_vs_cost.json"
SOUND = {"Mach 0.1": "mach 0.1", "c = 10": "factor 10", "c = 20": "factor 20"}


def reference() -> tuple[np.ndarray, np.ndarray]:
    with REFERENCE.open() as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return tuple(np.array([float(row[name]) for row in rows]) for name in ("time_s", "spread_diameter_m"))


def write_study() -> None:
    """The base case, the model of each space, and the two laws: what a case is compared with by ``plan``."""
    study = json.loads(STUDY.read_text(encoding="utf-8"))
    case = json.loads((STUDY.parent / study["case"]).read_text(encoding="utf-8"))
    case.pop("description")
    models, laws = study["vary"]["model"], study["vary"]["law"]
    exact = {"bodies.0.material.law": case["bodies"][0]["material"]["law"]}
    content = {
        "case": case,
        "models": {"axisymmetric": models["axisymmetric, 20 mm"], "3d": models["quarter, 20 mm"]},
        "laws": {"exact": exact | laws["exact"], "relaxed": laws["relaxed"]},
    }
    text = json.dumps(content, indent=2, ensure_ascii=False) + "\n"
    (OUT.parent / "slump_study.json").write_text(text, encoding="utf-8")


def main() -> None:
    arguments = parser()
    arguments.add_argument(
        "study", nargs="?", default=DOCS.parent / "runs/accuracy_vs_cost", type=Path, help="its directory"
    )
    study = arguments.parse_args().study
    require([study / "results.nc"])
    write_study()
    time, spread = reference()
    results = xarray.open_dataset(study / "results.nc")
    cases = {}
    for file in study.glob("members/*/member.json"):
        labels = json.loads(file.read_text())["labels"]
        cases[tuple(labels.values())] = parse_case(json.loads((file.parent / "case.json").read_text()))
    with OUT.open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["dim", "cells", "shape", "order", "volumetric", "law", "sound", "fate", "error"])
        for _, member in members(results):
            labels = [
                str(member[name].item()) for name in ("model", "shape", "order", "volumes", "law", "sound")
            ]
            case = cases[tuple(labels)]
            at = np.interp(member.time, time, spread)
            error = np.nanmax(np.abs(member.spread_diameter.values - at)) / spread.max()
            scheme, fate = case.scheme, str(member.fate.item())
            out.writerow([
                case.space_.dim, round(case.height / case.grid.cell_size), scheme.shape.name,
                scheme.order.name, scheme.volumetric.name, labels[4], SOUND[labels[5]], fate,
                f"{error:.4f}" if fate == "finished" else "",
            ])  # fmt: skip
    print(f"{OUT.name} and slump_study.json written")


if __name__ == "__main__":
    main()
