"""The page of a run: one file that a browser shows without a network, made from the run's directory alone."""

from __future__ import annotations

from pathlib import Path

from ...output import RunDirectory
from ...output.atomic import cannot_write, replacing
from ...version import __version__
from . import balance, flow_curves, headline, histories, measured, numerics, player, repeat, wall_forces
from .assembled import assembled
from .section import Section
from .source import Source, read_source

__all__ = ["MOST_BYTES", "page_of", "write_page"]

MOST_BYTES = 3_000_000
"""Largest size of a page."""
BEFORE = (headline,)
BEHIND = (histories, measured, flow_curves, balance, wall_forces, numerics, repeat)
"""Sections before and after the player. The player gets the rest of the allowed size. To add a section, write
a module and add it here."""


def page_of(
    directory: Path,
    live: bool = False,
    *,
    title: str | None = None,
    above: str | None = None,
    most: int = MOST_BYTES,
) -> str:
    """The page of a run as HTML; the run may still be in progress.

    Args:
        directory: of the run; its history must have a row.
        live: whether the scripts of the page may ask the server that it came from for newer data.
        title: of the page; default: the name of the case.
        above: address of the page of the study that the run belongs to, relative to this page.
        most: largest size of the page, bytes.

    Raises:
        CaseError: where the directory does not hold a run.
    """
    source = read_source(Path(directory))
    before, behind = _sections(source, BEFORE), _sections(source, BEHIND)
    results = source.results
    made_by = f"Made by mpmkit {__version__} from the directory of the run. It needs no network."

    def page(flow: Section | None) -> str:
        sections = [*before, *([] if flow is None else [flow]), *behind]
        said = results.case.get("description", "")
        return assembled(title or results.title, said, sections, made_by, live, above)

    room = most - len(page(None).encode()) - 20_000
    return page(player.section(source, room))


def _sections(source: Source, modules: tuple) -> list[Section]:
    found = [module.section(source) for module in modules]
    return [section for section in found if section is not None]


def write_page(directory: Path) -> Path:
    """Write the page of a run to ``report/index.html``.

    Raises:
        CaseError: where the directory does not hold a run.
        OutputError: where it cannot be written.
    """
    path, text = RunDirectory(directory).page, page_of(directory)
    try:
        path.parent.mkdir(exist_ok=True)
    except OSError as error:
        raise cannot_write(path.parent, error) from error
    with replacing(path) as partial:
        partial.write_text(text, encoding="utf-8")
    return path
