"""All commands, and what becomes of their errors."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress

import click

from ..errors import MpmkitError, OutputError
from ..version import __version__
from . import (
    bench,
    chart,
    compare,
    new_plugin,
    options,
    plan,
    plugins,
    report,
    rerun,
    run,
    schema,
    stability,
    study,
)


@click.group(context_settings={"help_option_names": ["-h", "--help"]}, invoke_without_command=True)
@click.version_option(__version__, prog_name="mpmkit")
@click.pass_context
def commands(context: click.Context) -> None:
    """Simulate the flow of yield-stress materials with the Material Point Method.

    Exit status: 0 done, 2 bad input, 3 stopped by a guard, 4 could not write, 130 interrupted.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


for module in (
    run,
    rerun,
    report,
    plan,
    compare,
    study,
    chart,
    stability,
    bench,
    plugins,
    new_plugin,
    schema,
):
    commands.add_command(module.command)
for command in (commands, *commands.commands.values()):
    command.params.append(options.no_plugins)


def execute(arguments: Sequence[str] | None) -> int:
    """Run a command line and return its exit status; an error is told in one sentence.

    Raises:
        KeyboardInterrupt: on Ctrl-C.
    """
    try:
        status = commands(arguments, prog_name="mpmkit", standalone_mode=False)
    except MpmkitError as error:
        _tell(str(error))
        return error.exit_status
    except click.UsageError as error:
        command = error.ctx.command_path if error.ctx is not None else "mpmkit"
        _tell(f"{error.format_message().rstrip('.')}; see {command} --help")
        return error.exit_code
    except click.Abort as abort:  # click's word for it
        raise KeyboardInterrupt(str(abort.__cause__ or "")) from None
    except OSError as error:
        if not _of_printing(error):
            raise
        _let_go_of_output()
        _tell(f"cannot write to the standard output: {error.strerror}")
        return OutputError.exit_status
    return status if isinstance(status, int) else 0  # click returns what a command exits with


def _of_printing(error: OSError) -> bool:
    return any(frame.f_code is click.echo.__code__ for frame, _ in traceback.walk_tb(error.__traceback__))


def _let_go_of_output() -> None:
    """Send what is still to be printed nowhere, or Python would fail of it once more when it ends."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _tell(sentence: str) -> None:
    click.echo(f"mpmkit: {' '.join(sentence.split())}", err=True)
