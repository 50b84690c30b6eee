"""Draw docs/images/gallery/*.png: the shape of the material in a run of each shipped case.

    python docs/figures/gallery.py [--only CASE]

docs/gallery.json says which values of a case are changed for its picture, so that all runs together take a
few minutes.
"""

import json
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from options import ROOT, parser
from PIL import Image

WIDEST = 1200
"""Pixels."""


def main() -> None:
    arguments = parser()
    arguments.add_argument("--only", metavar="CASE", help="name of the one case to draw")
    only = arguments.parse_args().only
    for name, entry in json.loads((ROOT / "docs/gallery.json").read_text(encoding="utf-8")).items():
        if "picture" not in entry and only in (None, name):
            print(f"running cases/{name}.json")
            draw(name, entry["set"])


def draw(name: str, overrides: list[str]) -> None:
    target = ROOT / f"docs/images/gallery/{name}.png"
    target.parent.mkdir(exist_ok=True)
    with TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "mpmkit", "run", f"cases/{name}.json", "--quiet", "--out", folder]
        for override in overrides:
            command += ["--set", override]
        subprocess.run([*command, "--overwrite"], cwd=ROOT, check=True)
        picture = Image.open(Path(folder) / "report/outline.png")
        picture.thumbnail((WIDEST, WIDEST))
        picture.convert("P", palette=Image.Palette.ADAPTIVE, colors=128).save(target, optimize=True)


if __name__ == "__main__":
    main()
