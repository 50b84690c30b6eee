"""The grid of a case: cells, domain and faces."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, PrivateAttr

from ..contracts import quantity
from .base import Model
from .faces import Face


class Grid(Model):
    """The background grid: cubic cells on a box whose faces carry the boundary conditions."""

    cell_size: float = quantity("m", "side of a cell", gt=0)
    domain: dict[str, Annotated[list[float], Field(min_length=2, max_length=2)]] = quantity(
        "m",
        "lower and upper end of the domain along each axis of the space; at an open face an end is moved out "
        "to a whole number of cells",
    )
    faces: dict[str, Face] = Field(
        default={}, description="condition on each face, such as z_min; default: every face is open"
    )

    _extensions: list[str] = PrivateAttr(default_factory=list)

    @property
    def extensions(self) -> tuple[str, ...]:
        """Sentences on the axes along which the domain was extended to whole cells; see ``whole_cells``."""
        return tuple(self._extensions)

    def note_extension(self, sentence: str) -> None:
        """Keep a sentence, for the log of the run."""
        self._extensions.append(sentence)
