"""The commands with their options, from the help of the command line."""

from __future__ import annotations

import click

WIDTH = 100


def page() -> str:
    """A section for each command, with what its ``--help`` prints."""
    from mpmkit.cli.commands import commands

    context = click.Context(commands, info_name="mpmkit", max_content_width=WIDTH, terminal_width=WIDTH)
    return "\n".join(_sections(commands, context))


def _sections(group: click.Group, context: click.Context) -> list[str]:
    found = []
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        if command is None or command.hidden:
            continue
        inner = click.Context(
            command, info_name=name, parent=context, max_content_width=WIDTH, terminal_width=WIDTH
        )
        found.append(f"## {inner.command_path}\n\n```text\n{command.get_help(inner)}\n```\n")
        if isinstance(command, click.Group):
            found += _sections(command, inner)
    return found
