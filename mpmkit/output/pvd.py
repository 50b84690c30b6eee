"""PVD: the list of the files of a series with their times, for ParaView."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from ..errors import CaseError
from .atomic import replacing


class Entry(NamedTuple):
    """A file of a series at a time. Files of one time are parts of one picture, and may have names."""

    time: float
    """s"""
    file: str
    """path relative to the folder of the list"""
    part: int = 0
    name: str = ""


def write_pvd(path: Path, entries: Iterable[Entry]) -> None:
    """Write a list.

    Raises:
        OutputError: where it cannot be written.
    """
    root = ET.Element("VTKFile", type="Collection", version="0.1")
    collection = ET.SubElement(root, "Collection")
    for time, file, part, name in entries:
        # repr keeps the exact value
        named = {"name": name} if name else {}
        ET.SubElement(
            collection,
            "DataSet",
            {"timestep": repr(time), "group": "", "part": str(part), "file": file} | named,
        )
    ET.indent(root)
    with replacing(path) as partial:
        ET.ElementTree(root).write(partial, encoding="utf-8", xml_declaration=True)


def read_pvd(path: Path) -> list[Entry]:
    """The entries of a list with existing files, in order of time; empty if there is no list.

    Raises:
        CaseError: where the list is not one.
    """
    if not path.is_file():
        return []
    try:
        listed = [
            Entry(float(of["timestep"]), of["file"], int(of.get("part", 0)), of.get("name", ""))
            for of in (element.attrib for element in ET.parse(path).getroot().iter("DataSet"))
        ]
    except (ET.ParseError, KeyError, ValueError) as error:
        raise CaseError(f"'{path}' is not a list of frames: {error}") from error
    return sorted(entry for entry in listed if (path.parent / entry.file).is_file())
