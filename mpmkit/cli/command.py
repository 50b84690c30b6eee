"""A command whose help ends with examples that can be copied and run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import click


class Command(click.Command):
    """A click command with examples.

    Args:
        examples: command lines, to be run one after the other from a folder that has ``cases/``.
    """

    def __init__(self, *arguments: Any, examples: Sequence[str], **settings: Any) -> None:
        super().__init__(*arguments, **settings)
        self.examples = tuple(examples)

    def get_short_help_str(self, limit: int = 0) -> str:
        """The whole first sentence; click would cut it off."""
        return " ".join((self.help or "").split("\n\n")[0].split()).rstrip(".")

    def format_epilog(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        super().format_epilog(context, formatter)
        with formatter.section("Examples"):
            for example in self.examples:
                formatter.write(f"{'':{formatter.current_indent}}{example}\n")  # not wrapped: it is copied


def with_examples(name: str, *examples: str) -> Callable[[Callable], Command]:
    """Decorator that makes a function the command ``mpmkit NAME``, with examples in its help."""
    return click.command(name, cls=Command, examples=examples)
