"""The command line. Each command is one small file; ``main`` gives errors their sentence and exit status."""

from __future__ import annotations

import sys

import click

from .. import __version__
from ..errors import MpmkitError

INTERRUPTED = 130


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="mpmkit")
def commands() -> None:
    """Simulate the flow of yield-stress materials with the Material Point Method."""


def main() -> None:
    """Entry point of ``mpmkit`` and ``python -m mpmkit``.

    Exit status: 0 done, 2 bad input, 3 stopped by a guard, 4 could not write, 130 interrupted.
    """
    from . import plan, plugins, run, schema

    for module in (run, plan, plugins, schema):
        commands.add_command(module.command)
    try:
        commands(standalone_mode=False)
    except MpmkitError as error:
        _tell(str(error))
        sys.exit(error.exit_status)
    except click.exceptions.Exit as stop:
        sys.exit(stop.exit_code)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except (KeyboardInterrupt, click.Abort):
        _tell("interrupted; what was recorded is kept")
        sys.exit(INTERRUPTED)
    except BrokenPipeError:  # the reader of our output, such as head, has gone
        sys.stderr.close()
        sys.exit(0)


def _tell(sentence: str) -> None:
    click.echo(f"mpmkit: {sentence}", err=True)
