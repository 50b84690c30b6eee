"""The body shapes of a case: those of its bodies, and those that its walls are made of."""

from __future__ import annotations

from ..contracts import BodyShape, Plugin
from ..registry.audit.body_shapes import problem_of_shape
from ..registry.blame import blaming_plugins
from ..spaces import Space


def shapes_in(plugin: Plugin) -> dict[str, BodyShape]:
    """The parameters of a plug-in, such as a surface, that are body shapes, by their names."""
    values = ((name, getattr(plugin, name)) for name in type(plugin).model_fields)
    return {name: value for name, value in values if isinstance(value, BodyShape)}


def check_shape(where: str, shape: BodyShape, space: Space) -> None:
    """Raise ValueError with one sentence if a space cannot hold a shape.

    Raises:
        PluginStop: the shape is at fault.
    """
    with blaming_plugins([("body_shape", shape)]):
        problem = problem_of_shape(shape, space)
    if problem is not None:
        raise ValueError(f"{where}: {problem}")
