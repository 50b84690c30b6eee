"""``mpmkit cases``: no description is cut off, on a terminal and elsewhere."""

from __future__ import annotations

import os

import pytest
from click.testing import CliRunner

from mpmkit.case.load import read_json
from mpmkit.case.shipped import shipped
from mpmkit.cli import cases


def listing() -> str:
    result = CliRunner().invoke(cases.command, catch_exceptions=False)
    assert result.exit_code == 0
    return result.output


def first_words() -> list[str]:
    """The beginning of each description, to the first full stop."""
    return [read_json(path)["description"].split(". ")[0].rstrip(".") for path in shipped().values()]


def test_another_program_gets_a_line_for_each_case():
    lines = listing().splitlines()
    for said in first_words():
        assert any(said in line for line in lines)


@pytest.mark.parametrize("wide", [60, 100])
def test_a_terminal_gets_whole_descriptions_in_lines_that_fit(monkeypatch, wide):
    monkeypatch.setattr("mpmkit.cli.cases._is_terminal", lambda: True)
    monkeypatch.setattr("shutil.get_terminal_size", lambda: os.terminal_size((wide, 24)))
    text = listing()
    table = text[: text.index("time: expected time")]
    assert max(map(len, table.splitlines())) <= wide
    words = " ".join(text.split())
    assert all(said in words for said in first_words())
