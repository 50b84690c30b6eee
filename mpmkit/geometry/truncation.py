"""Check that a mesh file is complete: STL and PLY files contain the size of their data."""

from __future__ import annotations

import io
import re
from dataclasses import dataclass

from .polygons import Unusable


@dataclass(frozen=True)
class PlyHead:
    """The header of a PLY file.

    Attributes:
        text: whether the numbers are text.
        elements: name, number and properties of each kind of element, in the order of the file.
    """

    text: bool
    elements: list[tuple[str, int, list[str]]]

    @property
    def plain(self) -> bool:
        """Whether meshio can read it: corners that begin with x, y, z, and faces with only indices."""
        if [name for name, _, _ in self.elements] != ["vertex", "face"]:
            return False
        corner, face = (properties for _, _, properties in self.elements)
        return [words.split()[-1] for words in corner[:3]] == ["x", "y", "z"] and len(face) == 1


def ply_head(path: str) -> PlyHead:
    """The head of a PLY file.

    Raises:
        Unusable: it is missing or truncated, or the file is text and has too few lines.
    """
    with open(path, "rb") as file:
        if file.readline().strip() != b"ply":
            raise Unusable("it does not begin with 'ply' as a PLY file does")
        text = False
        elements: list[tuple[str, int, list[str]]] = []
        while (words := file.readline(1 << 12).decode("latin-1").split()) != ["end_header"]:
            if not words:
                raise Unusable("it is truncated or damaged: 'end_header' is missing in its head")
            if words[0] == "format":
                text = words[1:2] == ["ascii"]
            elif words[0] == "element" and len(words) == 3 and words[2].isdecimal():
                elements.append((words[1], int(words[2]), []))
            elif words[0] == "property" and elements:
                elements[-1][2].append(" ".join(words[1:]))
        if text:
            rows, wanted = sum(1 for line in file if line.strip()), sum(count for _, count, _ in elements)
            if rows < wanted:
                raise Unusable(f"it is truncated: its head announces {wanted} lines, but it has {rows}")
    return PlyHead(text, elements)


def require_whole_stl(path: str) -> None:
    """A binary STL file has as many triangles as it says; one that is text ends with ``endsolid``.

    Raises:
        Unusable: it is truncated.
    """
    with open(path, "rb") as file:
        head = file.read(1024)
        size = file.seek(0, io.SEEK_END)
        file.seek(max(0, size - 1024))
        tail = file.read()
    if re.match(rb"\s*solid", head, re.IGNORECASE) and re.search(rb"facet", head, re.IGNORECASE):
        if not re.search(rb"end\s*solid", tail, re.IGNORECASE):
            raise Unusable("it is truncated: 'endsolid' is missing at its end")
        return
    count = int.from_bytes(head[80:84], "little")
    if size < 84 or size < 84 + 50 * count:
        raise Unusable(
            f"it is truncated or not an STL file: a binary one with {count} triangles has {84 + 50 * count} "
            f"bytes, but it has {size}"
        )
