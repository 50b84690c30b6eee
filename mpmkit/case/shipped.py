"""The cases that ship with mpmkit: the folder ``cases`` of a checkout, which a wheel holds as well."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from ..errors import CaseError
from .allowed import shown
from .synonyms import nearest

LABORATORY = "lab"
"""The folder in it of apparatus of the laboratory."""


@cache
def shipped() -> dict[str, Path]:
    """Their files by name: first the apparatus of the laboratory, then the others.

    Raises:
        CaseError: they are missing, for example in an incomplete installation.
    """
    package = Path(__file__).parents[1]
    for folder in (package / "cases", package.parent / "cases"):
        laboratory = sorted((folder / LABORATORY).glob("*.json"))
        if laboratory:
            return {path.stem: path for path in [*laboratory, *sorted(folder.glob("*.json"))]}
    raise CaseError(f"the cases that ship are not in {package / 'cases'}: install mpmkit again")


def shipped_case(name: str) -> Path:
    """The file of a shipped case.

    Raises:
        CaseError: none has this name.
    """
    found = shipped()
    if name not in found:
        near = nearest(name, list(found))
        likely = [near] if near is not None else [one for one in found if name and name.lower() in one]
        names = " or ".join(f"'{one}'" for one in likely)
        meant = f" did you mean {names}?" if likely else ""
        raise CaseError(f"there is no shipped case {shown(name)};{meant} mpmkit cases lists them")
    return found[name]
