"""The help of every command ends with examples, and each of them runs as it stands."""

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mpmkit.cli import main
from mpmkit.cli.commands import commands

ROOT = Path(__file__).parents[1]
QUICK = {"completion", "new-plugin", "schema"}
"""Commands that take no more than a moment."""


def examples(name, capsys):
    """The lines below "Examples:" in the help of a command."""
    with pytest.raises(SystemExit):
        main([name, "--help"])
    lines = capsys.readouterr().out.splitlines()
    return [line.strip() for line in lines[lines.index("Examples:") + 1 :]]


@pytest.mark.parametrize("name", commands.commands)
def test_every_help_has_an_example_of_its_command_that_can_be_parsed(name, capsys):
    shown = examples(name, capsys)
    assert any(line.startswith(f"mpmkit {name}") for line in shown)
    for line in shown:
        program, of, *arguments = shlex.split(line.partition(" > ")[0])
        assert program == "mpmkit"
        commands.commands[of].make_context(of, arguments).close()


@pytest.mark.parametrize(
    "name",
    [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in commands.commands],
)
def test_every_example_runs(name, capsys, tmp_path):
    shutil.copytree(ROOT / "cases", tmp_path / "cases")
    # The command that belongs to this Python comes first.
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    for line in examples(name, capsys):
        done = subprocess.run(
            ["bash", "-c", line],
            cwd=tmp_path,
            env=os.environ | {"PATH": path},
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, f"{line}\n{done.stderr}"
        assert "Traceback" not in done.stderr
