"""Completion: the scripts, and what a real bash makes of one."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mpmkit.cli import main

BIN = Path(sys.executable).parent
ENVIRONMENT = os.environ | {"PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}"}


def script(shell, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["completion", shell])
    assert ended.value.code == 0
    return capsys.readouterr().out


@pytest.mark.parametrize(
    ("shell", "registers"),
    [("bash", "complete -o nosort -F"), ("zsh", "compdef"), ("fish", "complete --no-files --command mpmkit")],
)
def test_the_script_registers_the_program(shell, registers, capsys):
    text = script(shell, capsys)
    assert registers in text
    assert f"_MPMKIT_COMPLETE={shell}_complete" in text


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("mpmkit ru", ["run"]),
        ("mpmkit re", ["report", "rerun"]),
        ("mpmkit run --overw", ["--overwrite"]),
        ("mpmkit new-plugin honey --kind v", ["velocity", "volumetric"]),
        ("mpmkit completion ", ["bash", "zsh", "fish"]),
    ],
)
def test_bash_completes(typed, offered, capsys, tmp_path):
    (tmp_path / "mpmkit.bash").write_text(script("bash", capsys))
    words = " ".join(f"'{word}'" for word in typed.split(" "))
    code = f"source ./mpmkit.bash; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); "
    code += f"_mpmkit_completion {BIN / 'mpmkit'}; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    done = subprocess.run(
        ["bash", "-c", code], cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == offered


def test_an_unknown_shell_is_one_sentence(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["completion", "csh"])
    assert ended.value.code == 2
    assert "'csh' is not one of 'bash', 'zsh', 'fish'" in capsys.readouterr().err
