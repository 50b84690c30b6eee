"""All commands, and the treatment of their errors."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

import click

from ..errors import MpmkitError, OutputError
from . import (
    bench,
    cases,
    chart,
    compare,
    completion,
    doctor,
    fit,
    init,
    movie,
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
from .printing import results_alone

PIPE_CLOSED = 141
"""Exit status that a shell gives to a command ended by SIGPIPE."""


class PipeClosed(Exception):
    """The reader of the output has closed it, as ``| head`` does."""


class _Commands(click.Group):
    """A group that lets ``execute`` handle a closed pipe; click itself would end with status 1."""

    def make_context(self, *arguments: Any, **options: Any) -> click.Context:  # this prints the help
        with _closed_pipe():
            return super().make_context(*arguments, **options)

    def invoke(self, context: click.Context) -> Any:
        with _closed_pipe():
            return super().invoke(context)


@contextmanager
def _closed_pipe() -> Iterator[None]:
    try:
        yield
    except BrokenPipeError as error:
        if not _of_printing(error):
            raise
        raise PipeClosed from None


def _tell_version(context: click.Context, _: click.Parameter, asked: bool) -> None:
    if asked:
        # Imported here, because reading the metadata of the package takes a third of the start-up time.
        from ..version import __version__

        click.echo(f"mpmkit, version {__version__}")
        context.exit()


@click.group(
    cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]}, invoke_without_command=True
)
@click.option(
    "--version", is_flag=True, is_eager=True, expose_value=False, callback=_tell_version,
    help="Show the version and exit.",
)  # fmt: skip
@click.pass_context
def commands(context: click.Context) -> None:
    """Simulate the flow of yield-stress materials with the Material Point Method.

    Exit status: 0 done, 1 members of a study failed or a rerun differs, 2 bad input, 3 stopped by a guard,
    4 could not write, 130 interrupted.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


for module in (
    cases,
    init,
    run,
    rerun,
    report,
    movie,
    plan,
    compare,
    study,
    fit,
    chart,
    stability,
    bench,
    plugins,
    new_plugin,
    schema,
    doctor,
    completion,
):
    commands.add_command(module.command)
for command in commands.commands.values():
    assert command.callback is not None
    command.callback = results_alone()(command.callback)
for command in (commands, *commands.commands.values()):
    command.params.append(options.no_plugins)


def execute(arguments: Sequence[str] | None) -> int:
    """Run a command line and return its exit status; an error is printed as one sentence.

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
    except PipeClosed:
        _let_go_of_output()
        return PIPE_CLOSED
    except click.Abort as abort:  # the class that click raises for Ctrl-C
        raise KeyboardInterrupt(str(abort.__cause__ or "")) from None
    except OSError as error:  # such as a full disk
        if not _of_printing(error):
            raise
        _let_go_of_output()
        _tell(f"cannot write to the standard output: {error.strerror}")
        return OutputError.exit_status
    return status if isinstance(status, int) else 0  # click returns what a command exits with


def _of_printing(error: OSError) -> bool:
    return any(frame.f_code is click.echo.__code__ for frame, _ in traceback.walk_tb(error.__traceback__))


def _let_go_of_output() -> None:
    """Discard what is not printed yet; otherwise Python fails again when it ends."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            stream.flush()
            continue
        with suppress(OSError, ValueError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _tell(sentence: str) -> None:
    with suppress(OSError):  # its reader may be gone too
        click.echo(f"mpmkit: {' '.join(sentence.split())}", err=True)
