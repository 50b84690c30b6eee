"""``mpmkit completion``."""

from __future__ import annotations

import click

from .command import with_examples
from .printing import echo

SHELLS = ("bash", "zsh", "fish")
VARIABLE = "_MPMKIT_COMPLETE"
"""Environment variable with which a shell asks click for completions; its name follows from the program's."""


@with_examples("completion", "mpmkit completion bash > mpmkit.bash")
@click.argument("shell", type=click.Choice(SHELLS))
@click.pass_context
def command(context: click.Context, shell: str) -> None:
    """Print the script by which SHELL completes commands, options and files when you press Tab.

    \b
    bash: mpmkit completion bash >> ~/.bashrc
    zsh:  mpmkit completion zsh >> ~/.zshrc
    fish: mpmkit completion fish > ~/.config/fish/completions/mpmkit.fish

    Then open a new terminal.
    """
    from click.shell_completion import get_completion_class

    completion = get_completion_class(shell)
    assert completion is not None
    echo(completion(context.find_root().command, {}, "mpmkit", VARIABLE).source())
