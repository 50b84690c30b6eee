"""Write down which compiled functions some cases need, in ``mpmkit/running/needed_kernels.json``.

A first run has these compiled side by side. Run it after kernels have changed:

    python benchmarks/needed_kernels.py
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mpmkit.case import load_case
from mpmkit.kernels.code_cache import KeptCode
from mpmkit.kernels.needs import Need, Unnamed, need_of
from mpmkit.running.ahead import traits
from mpmkit.running.runner import run

ROOT = Path(__file__).parents[1]
RECORD = ROOT / "mpmkit" / "running" / "needed_kernels.json"
CASES = {
    "slump": 0.1,
    "slump_quarter": 0.02,
    "slump_lifted": 0.05,
    "film": 0.1,
}
"""Cases of ``cases/``, and how long each runs, s."""


@contextmanager
def noting() -> Iterator[list[Need]]:
    """What is asked for in this process, in order; of a warm process these are the functions called from
    Python, since what they call is a part of their code."""
    asked: list[Need] = []
    load = KeptCode.load_overload

    def noted(self: KeptCode, sig, target_context):
        try:
            need = need_of(self._function, sig)
            if need not in asked:
                asked.append(need)
        except Unnamed as unnamed:
            print(f"left out: {unnamed}", file=sys.stderr)
        return load(self, sig, target_context)

    KeptCode.load_overload = noted
    try:
        yield asked
    finally:
        KeptCode.load_overload = load


def needed_by(name: str, until: float) -> dict:
    """What a case needs up to its first step and a row of its history, and what it needs later."""
    case = load_case(ROOT / "cases" / f"{name}.json", [f"until={until}"])
    early: list[int] = []

    with noting() as asked:
        from mpmkit.running import execution

        first_step = execution._first_step

        def stepped(*arguments) -> None:
            first_step(*arguments)
            early.append(len(asked))

        execution._first_step = stepped
        run(case)
    as_text = [need.as_dict() for need in asked]
    return {"traits": sorted(traits(case)), "first": as_text[: early[0]], "later": as_text[early[0] :]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--case", choices=CASES, help="print what this case needs, and write nothing")
    parser.add_argument("--until", type=float, help="how long it runs, s; default: that of the record")
    chosen = parser.parse_args()
    if chosen.case:
        print(json.dumps(needed_by(chosen.case, chosen.until or CASES[chosen.case])))
        return
    functions: list[dict] = []
    cases = []
    for name in CASES:
        command = [sys.executable, __file__, "--case", name]
        for _ in range(2):  # the first run compiles what is missing
            said = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
        found = json.loads(said.stdout.splitlines()[-1])
        for part in ("first", "later"):
            functions += [need for need in found[part] if need not in functions]
            found[part] = [functions.index(need) for need in found[part]]
        cases.append({"case": name, **found})
        write(functions, cases)


def write(functions: list[dict], cases: list[dict]) -> None:
    """Write the record, an entry a line."""
    lines = ",\n".join(f"  {json.dumps(need)}" for need in functions)
    rows = ",\n".join(f"  {json.dumps(case)}" for case in cases)
    RECORD.write_text(f'{{"functions": [\n{lines}\n],\n"cases": [\n{rows}\n]}}\n', encoding="utf-8")


if __name__ == "__main__":
    main()
