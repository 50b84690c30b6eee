"""The public names of a module, each with its docstring."""

from __future__ import annotations

import importlib
import inspect
import pydoc
import sys

from sphinx.pycode import ModuleAnalyzer


def page(module: str) -> str:
    """Directives for every name in ``__all__`` of a module."""
    names = importlib.import_module(module).__all__
    lines = [line for name in names for line in _directive(module, name)]
    return "\n".join(["```{eval-rst}", *lines, "```"])


def _directive(module: str, name: str) -> list[str]:
    thing = pydoc.locate(f"{module}.{name}")
    if inspect.ismodule(thing):
        return [f".. automodule:: {thing.__name__}", "   :members:", ""]
    if inspect.isclass(thing):
        return [f".. autoclass:: {module}.{name}", "   :members:", "   :exclude-members: model_config", ""]
    if inspect.isroutine(thing):
        return [f".. autofunction:: {module}.{name}", ""]
    return [f".. py:data:: {module}.{name}", "", *(f"   {line}" for line in _said_of(module, name)), ""]


def _said_of(module: str, name: str) -> list[str]:
    """The text below a constant, in the module of the package that defines it."""
    for inner in [inner for inner in sys.modules if inner.startswith(f"{module.split('.')[0]}.")]:
        if (lines := ModuleAnalyzer.for_module(inner).find_attr_docs().get(("", name))) is not None:
            return lines
    return []
