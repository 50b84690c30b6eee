"""The options that ``study``, ``compare`` and ``fit`` have in common."""

from __future__ import annotations

from pathlib import Path

import click
import pytest

from mpmkit.cli import compare, fit, study
from mpmkit.cli.many_runs import ManyRuns

COMMON = ("out", "overwrite", "workers", "threads", "scheduler", "quiet")


@pytest.mark.parametrize("command", [study.command, compare.command, fit.command], ids=lambda c: c.name)
def test_commands_that_make_many_runs_have_the_same_options(command):
    options = {p.name: p for p in command.params if isinstance(p, click.Option)}
    line = "FILE --out a/b --overwrite --workers 3 --threads 2 --scheduler tcp://x:1 --quiet"
    varied = ["--vary", "until=1,2"] if "vary" in options else []
    given = command.make_context(command.name, [*line.split(), *varied]).params
    assert {name: given[name] for name in COMMON} == {
        "out": "a/b",
        "overwrite": True,
        "workers": 3,
        "threads": 2,
        "scheduler": "tcp://x:1",
        "quiet": True,
    }


@pytest.mark.parametrize("command", [study.command, compare.command, fit.command], ids=lambda c: c.name)
def test_the_help_names_the_default_directory_and_what_the_threads_are_of(command):
    helps = {p.name: p.help for p in command.params if isinstance(p, click.Option)}
    assert "default: runs/" in helps["out"]
    assert helps["threads"].startswith("Threads of each ")
    assert "cores" in helps["workers"]


def test_a_directory_that_was_given_replaces_the_default():
    how = {"overwrite": False, "workers": None, "threads": None, "scheduler": None, "quiet": False}
    assert ManyRuns(out=None, **how).directory("orders") == Path("runs/orders")
    assert ManyRuns(out="elsewhere", **how).directory("orders") == Path("elsewhere")
