"""``mpmkit movie``."""

from __future__ import annotations

from pathlib import Path

import click

from .command import with_examples
from .paths import PATH, refuse_existing
from .printing import echo

CHOICES = ("speed", "shear-rate", "yielded", "pressure")


@with_examples(
    "movie",
    "mpmkit run cases/slump_fast.json --until 0.5 --set output.frame_interval=0.05 --out runs/filmed",
    "mpmkit movie runs/filmed",
    "mpmkit movie runs/filmed --colour-by yielded --fps 5 --out yielded.gif",
)
@click.argument("directory", type=PATH)
@click.option(
    "--fps",
    type=click.FloatRange(min=0.1, max=50),
    default=10.0,
    show_default=True,
    help="Pictures per second; each frame of the run is one picture.",
)
@click.option(
    "--colour-by",
    "--color-by",
    type=click.Choice(CHOICES),
    default="speed",
    show_default=True,
    help="What the colours show.",
)
@click.option(
    "--out",
    type=PATH,
    metavar="FILE",
    help="The movie, FILE.gif or FILE.mp4; default: report/movie.gif of the run. MP4 needs: pip install "
    "imageio-ffmpeg.",
)
@click.option("--overwrite", is_flag=True, help="Replace a file that --out names.")
def command(directory: str, fps: float, colour_by: str, out: str | None, overwrite: bool) -> None:
    """Write a movie of the run in DIRECTORY from its frames, as GIF or MP4.

    A run has 20 frames by default; a shorter output.frame_interval in its case makes the movie smoother.
    """
    from ..errors import CaseError, MpmkitError, reason
    from ..output import RunDirectory
    from ..report.movie import make_movie

    run = Path(directory)
    if out is None:  # like the pictures of the report, report/movie.gif is always replaced
        path = RunDirectory(run).movie
        if run.is_dir():
            path.parent.mkdir(exist_ok=True)
    else:
        path = Path(out)
        refuse_existing(path, overwrite)
    try:
        echo(str(make_movie(run, path, fps, colour_by)))
    except MpmkitError:
        raise
    except Exception as error:  # a frame is damaged
        raise CaseError(f"the movie of '{directory}' cannot be drawn: {reason(error)}") from None
