"""The combinations of schemes and laws for a case."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

from ..case import parse_case
from ..case.model import Case
from ..errors import CaseError
from ..registry import installed
from ..rheology.refit import with_law

KINDS = ("shape", "order", "velocity", "volumetric", "law")
"""Kinds of plug-ins that can be combined."""


def combinations(data: dict[str, Any], chosen: dict[str, list[str]]) -> Iterator[tuple[dict[str, str], Case]]:
    """Names by kind and the case, for every combination.

    Splitting is switched off, so that the particles of two runs can be compared.

    Args:
        data: the content of a case file.
        chosen: names to combine, by kind; a kind that is left out stays as it is in the case.

    Raises:
        CaseError: a name is not registered, or the case is not valid with it.
    """
    for kind, names in chosen.items():
        known = installed().of_kind(kind)
        for name in names:
            if name not in known:
                raise CaseError(f"--{kind} {name}: it must be one of {', '.join(sorted(known))}")
    for combination in itertools.product(*chosen.values()):
        labels = dict(zip(chosen, combination, strict=True))
        made = {**data, "bodies": [dict(body) for body in data.get("bodies", [])]}
        for body in made["bodies"]:
            if "law" in labels and isinstance(body.get("material"), dict):
                body["material"], _ = with_law(body["material"], labels["law"], installed())
        overrides = [f"scheme.{kind}={name}" for kind, name in labels.items() if kind != "law"]
        title = ", ".join(labels.values())
        overrides += ["scheme.splitting=false", "scheme.refinement=none"]
        yield labels, parse_case(made, overrides, source=title or "the case")
