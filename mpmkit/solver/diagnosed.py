"""The values that the diagnostics of a case measure in a scene."""

from __future__ import annotations

from collections.abc import Mapping

from ..case.diagnostics import columns_of
from ..errors import PluginFault
from ..registry.audit import require_number
from .observation import Observation
from .view import SceneView


def diagnosed(scene: SceneView) -> dict[str, float]:
    """The columns of all diagnostics at the present step.

    Raises:
        PluginFault: a diagnostic returned an undeclared column, or a value that is not a number.
    """
    found: dict[str, float] = {}
    observed = Observation(scene)
    for name, diagnostic in scene.case.output.diagnostics.items():
        columns = [column.name for column in columns_of(diagnostic, scene.case.space_)]
        measured = diagnostic.measure(observed)
        if not isinstance(measured, Mapping) or set(measured) != set(columns):
            what = sorted(map(str, measured)) if isinstance(measured, Mapping) else measured
            must = f"it must be a number for each of {', '.join(columns)}"
            raise PluginFault(diagnostic, f"returned {what!r} from measure; {must}")
        for column in columns:
            found[f"{name}.{column}"] = require_number(diagnostic, column, measured[column])
    return found
