"""The columns that the diagnostics of a case add to its history."""

from __future__ import annotations

import re

from ..contracts import Column, Diagnostic
from ..errors import PluginFault
from ..output.variables import Variable
from ..registry.blame import blaming_plugins
from ..spaces import Space
from .model import Case

NAME = re.compile(r"[a-z0-9_]+")


def columns_of(diagnostic: Diagnostic, space: Space) -> list[Column]:
    """The columns of a diagnostic.

    Raises:
        PluginFault: it is not a list of columns with unique names.
    """
    columns = diagnostic.columns(space)
    if not isinstance(columns, list | tuple) or not all(isinstance(column, Column) for column in columns):
        raise PluginFault(diagnostic, f"returned {columns!r} from columns; it must be a list of Column")
    for number, column in enumerate(columns):
        if not isinstance(column.name, str) or not NAME.fullmatch(column.name):
            rule = "it must be of lower-case letters, digits and '_'"
            raise PluginFault(diagnostic, f"has a column of the name {column.name!r}; {rule}")
        if column.name in [other.name for other in columns[:number]]:
            raise PluginFault(diagnostic, f"has two columns of the name '{column.name}'")
        if not isinstance(column.unit, str) or not isinstance(column.long_name, str):
            raise PluginFault(
                diagnostic, f"has a column '{column.name}' whose unit or long_name is not a text"
            )
    return list(columns)


def diagnostic_columns(case: Case) -> list[Variable]:
    """The columns of all diagnostics, each as ``<name of the diagnostic>.<name of the column>``.

    Raises:
        PluginStop: a diagnostic is at fault.
    """
    found = []
    for name, diagnostic in case.output.diagnostics.items():
        with blaming_plugins([("diagnostic", diagnostic)]):
            for column in columns_of(diagnostic, case.space_):
                found.append(Variable(f"{name}.{column.name}", column.unit, column.long_name))
    return found
