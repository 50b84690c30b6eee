"""Draw docs/images/accuracy_vs_cost.png: error of the spread against CPU time, and Pareto's front.

    mpmkit study cases/studies/accuracy_vs_cost.json
    python docs/figures/accuracy_vs_cost.py

The study takes ten minutes or more of two cores, the figure a few seconds.
Prints the front as the page has it.
"""

import subprocess
import sys

from common import REFERENCE
from options import ROOT, parser, require
from PIL import Image

STUDY = ROOT / "runs/accuracy_vs_cost"


def main() -> None:
    parser().parse_args()
    require([STUDY / "results.nc"])
    chart = [sys.executable, "-m", "mpmkit", "chart", str(STUDY), "--cost", "cpu_seconds"]
    subprocess.run([*chart, "--reference", str(REFERENCE)], check=True)
    Image.open(STUDY / "chart.png").save(ROOT / "docs/images/accuracy_vs_cost.png", optimize=True)


if __name__ == "__main__":
    main()
