"""The command line. Each command is one small file; ``main`` gives errors their sentence and exit status."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import click

from .. import __version__
from ..errors import MpmkitError

INTERRUPTED = 130


@click.group(context_settings={"help_option_names": ["-h", "--help"]}, invoke_without_command=True)
@click.version_option(__version__, prog_name="mpmkit")
@click.pass_context
def commands(context: click.Context) -> None:
    """Simulate the flow of yield-stress materials with the Material Point Method.

    Exit status: 0 done, 2 bad input, 3 stopped by a guard, 4 could not write, 130 interrupted.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of ``mpmkit`` and ``python -m mpmkit``; ends the process with the exit status.

    Args:
        arguments: those of the process unless given.
    """
    from . import plan, plugins, run, schema

    for module in (run, plan, plugins, schema):
        commands.add_command(module.command)
    try:
        commands(arguments, prog_name="mpmkit", standalone_mode=False)
    except MpmkitError as error:
        _tell(str(error))
        sys.exit(error.exit_status)
    except click.exceptions.Exit as stop:
        sys.exit(stop.exit_code)
    except click.UsageError as error:
        command = error.ctx.command_path if error.ctx is not None else "mpmkit"
        _tell(f"{error.format_message().rstrip('.')}; see {command} --help")
        sys.exit(error.exit_code)
    except (KeyboardInterrupt, click.Abort):
        _tell("interrupted")
        sys.exit(INTERRUPTED)
    except BrokenPipeError:  # the reader of our output, such as head, has gone
        sys.stderr.close()
        sys.exit(0)
    sys.exit(0)


def _tell(sentence: str) -> None:
    click.echo(f"mpmkit: {' '.join(sentence.split())}", err=True)
