"""The summary of a run: keys, values, units, and the state at the end in words."""

from __future__ import annotations

import pytest
from histories import small_history

from mpmkit.output import History, summarise
from mpmkit.output.summary import state_at_end


class TestSummary:
    def summary(self, history: History, **changes) -> dict:
        given = {"particles": 10, "particle_steps": 200, "steps": 20, "wall_time": 4.0}
        given |= {"stopped_because": "finished", "plugins": {}}
        given |= {"t500": 0.15, "at_rest_since": None, "spread_rate": 0.3}
        return summarise(history.dataset(), **{**given, **changes})

    def test_keys_and_values(self):
        summary = self.summary(small_history())
        keys = "t500 t500_from_lift final_spread final_slump final_height final_spread_rate at_rest_since "
        keys += (
            "simulated_time particles steps wall_time particle_steps_per_second stopped_because ended_by "
            "plugins units"
        )
        assert list(summary) == keys.split()
        assert summary["t500"] == 0.15
        assert summary["at_rest_since"] is None
        assert summary["final_spread"] == 0.6
        assert summary["final_spread_rate"] == 0.3
        assert summary["simulated_time"] == pytest.approx(0.2)
        assert summary["final_height"] is None  # not a column of this history
        assert summary["particle_steps_per_second"] == 50.0

    def test_every_number_has_a_unit(self):
        summary = self.summary(small_history())
        numbers = summary.keys() - {"stopped_because", "ended_by", "plugins", "units"}
        assert summary["units"].keys() == numbers
        assert summary["units"]["t500"] == summary["units"]["at_rest_since"] == "s"
        assert summary["units"]["final_spread"] == "m"

    def test_what_a_guard_refused_is_not_summarised(self):
        """If a particle was thrown out in the last row, there is no final shape and no rest."""
        thrown_out = self.summary(small_history(), stopped_because="particle-outside", at_rest_since=0.1)
        assert thrown_out["at_rest_since"] is thrown_out["final_spread"] is None
        assert thrown_out["final_spread_rate"] is None
        assert thrown_out["simulated_time"] == pytest.approx(0.2)
        assert state_at_end(thrown_out) is None
        assert self.summary(small_history(), stopped_because="interrupted")["final_spread"] == 0.6

    def test_of_a_run_that_never_started(self):
        summary = self.summary(small_history(()), wall_time=0.0, t500=None)
        assert summary["t500"] is summary["final_spread"] is summary["particle_steps_per_second"] is None

    def test_the_state_at_the_end_in_words(self):
        words = {(1.234, 0.0): "at rest since t = 1.23 s", (None, 0.4583): "still spreading, 458 mm/s"}
        words |= {(None, None): "still moving", (None, -0.2): "still moving"}
        for (since, rate), sentence in words.items():
            summary = self.summary(small_history(), at_rest_since=since, spread_rate=rate)
            assert state_at_end(summary) == sentence
