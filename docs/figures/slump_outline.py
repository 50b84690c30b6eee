"""Draw docs/images/slump_outline.png: the outline of the README's slump, as its report draws it.

    mpmkit run cases/slump.json
    python docs/figures/slump_outline.py [--run DIR]

The run takes a minute or two, the figure a second.
"""

from pathlib import Path

from options import ROOT, parser, require
from PIL import Image


def main() -> None:
    arguments = parser()
    arguments.add_argument("--run", default=ROOT / "runs/slump", type=Path, help="directory of the run")
    drawn = arguments.parse_args().run / "report/outline.png"
    require([drawn])
    Image.open(drawn).save(ROOT / "docs/images/slump_outline.png", optimize=True)


if __name__ == "__main__":
    main()
