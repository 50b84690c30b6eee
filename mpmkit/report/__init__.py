"""Page and pictures of a run. They need only its directory and can be made again at any time."""

from __future__ import annotations

from pathlib import Path

from ..output import RunDirectory
from ..output.atomic import cannot_write, replacing
from ..output.run_directory import PICTURES

__all__ = ["draw_pictures", "write_report"]


def write_report(run_directory: Path) -> list[Path]:
    """Draw the pictures of a run into its ``report/``, and write its page there.

    Returns:
        The files written: PNG files, and last the page.

    Raises:
        CaseError: where the directory does not hold a run.
        OutputError: where a file cannot be written.
    """
    from .page import write_page

    return [*draw_pictures(run_directory), write_page(run_directory)]


def draw_pictures(run_directory: Path) -> list[Path]:
    """Draw the pictures of a run into its ``report/``; what the run did not record is left out.

    Returns:
        The PNG files written.

    Raises:
        CaseError: where the directory does not hold a run.
        OutputError: where a picture cannot be written.
    """
    from . import energies, outline, spread_and_height, wall_forces  # matplotlib is loaded only to draw
    from .run_results import read_results
    from .style import DPI, figure_style

    results = read_results(Path(run_directory))
    report = RunDirectory(run_directory).report
    try:
        report.mkdir(exist_ok=True)
    except OSError as error:
        raise cannot_write(report, error) from error
    written = []
    pictures = (outline, spread_and_height, energies, wall_forces)
    for name, picture in zip(PICTURES, pictures, strict=True):
        with figure_style():
            figure = picture.draw(results)
            if figure is None:
                continue
            path = report / f"{name}.png"
            with replacing(path) as partial:
                figure.savefig(partial, format="png", dpi=DPI)
        written.append(path)
    return written
