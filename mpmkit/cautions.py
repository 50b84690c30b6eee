"""What the plug-ins of a case know to fail where they are used as it does."""

from __future__ import annotations

from .case.model import Case
from .provenance import plugins_of


def cautions(case: Case) -> list[str]:
    """A sentence for each, those of several materials once."""
    return list(
        dict.fromkeys(sentence for _, plugin in plugins_of(case) for sentence in plugin.cautions(case))
    )
