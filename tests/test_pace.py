"""The wall time that a run still needs: steps in which kernels are compiled do not count."""

import pytest

from mpmkit.running.pace import FEWEST, RECENT, Pace


def after(*intervals: tuple[float, float]) -> Pace:
    """The pace after intervals of wall time and simulated time, s."""
    pace, wall, time = Pace(), 0.0, 0.0
    pace.note(wall, time)
    for passed, done in intervals:
        wall, time = wall + passed, time + done
        pace.note(wall, time)
    return pace


def test_a_steady_run_needs_what_its_pace_says():
    assert after(*[(0.2, 0.01)] * 5).left(0.95) == pytest.approx(19.0)


def test_compiling_in_the_first_steps_does_not_change_the_estimate():
    """Two steps of 40 s among steps of 0.2 s: the mean would be 81 s in 0.05 s, 27 minutes a second."""
    pace = after((40.0, 0.001), (40.0, 0.001), *[(0.2, 0.01)] * 3)
    assert pace.left(1.0) == pytest.approx(20.0)


def test_there_is_no_estimate_before_some_intervals():
    assert not after(*[(0.2, 0.01)] * (FEWEST - 1)).known
    assert after(*[(0.2, 0.01)] * FEWEST).known


def test_the_estimate_follows_a_run_that_becomes_slower():
    assert after(*[(0.2, 0.01)] * 50, *[(0.4, 0.01)] * RECENT).left(1.0) == pytest.approx(40.0)
